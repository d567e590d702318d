/* States of the models under whatever hashes: the first byte chooses a model, then each 14 bytes change an item of a section of a real state.
 * The model refuses it, sees that its numbers diverge, or makes the next frame. */
#include "fuzz/fuzz.h"

#include "base/log.h"
#include "lib/small_jobs.h"
#include "model/model.h"

enum { MODELS = 4, MOST = 6, CHANGE = 14 };

static struct gpu *gpu;
static struct job *job[MODELS];
static struct checkpoint state[MODELS];

static void must(status st)
{
    if (st == OK)
        return;
    fprintf(stderr, "%s\n", status_message());
    abort();
}

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    const char *const text[MODELS] = {arenite, shot, goblins, arches};
    (void)argc;
    (void)argv;
    log_silence(true);
    setenv("HOODOO_CACHE", fuzz_folder(), 1);
    must(gpu_create(&(struct gpu_options){.device = "cpu"}, &gpu));
    for (int i = 0; i < MODELS; i++) {
        struct model *m = NULL;
        must(job_load(fuzz_file("n.yaml", text[i], strlen(text[i])), NULL, 0, &job[i]));
        must(model_create(gpu, job[i], NULL, &m));
        must(model_step(m));
        must(model_step(m));
        must(model_save(m, &state[i]));
        model_destroy(&m);
    }
    return 0;
}

static void change(struct checkpoint_section *s, const uint8_t *c)
{
    static const float number[] = {-1, 0, 1, 1e-38F, 1e6F, 1e30F, 0.5F, -1e-3F};
    uint32_t i;
    uint64_t value;
    memcpy(&i, c + 2, sizeof i);
    memcpy(&value, c + 6, sizeof value);
    if (s->n == 0)
        return;
    i %= (uint32_t)s->n;
    uint32_t *word = (uint32_t *)s->data + i;
    uint64_t *wide = (uint64_t *)s->data + i;
    const uint64_t other = value % s->n;
    switch (c[1] % 6) {
    case 0:
        s->item == 4 ? (void)(*word = (uint32_t)value) : (void)(*wide = value);
        break;
    case 1:
        s->item == 4 ? (void)(*word += (uint32_t)(int8_t)value) : (void)(*wide += (uint64_t)(int8_t)value);
        break;
    case 2:
        s->item == 4 ? (void)memcpy(word, &number[value % 8], 4)
                     : (void)memcpy(wide, &(double){(double)number[value % 8]}, 8);
        break;
    case 3: /* the same as another item */
        memcpy((char *)s->data + i * s->item, (const char *)s->data + other * s->item, s->item);
        break;
    case 4: /* fewer items */
        s->n = other;
        break;
    default: /* all from here on */
        for (size_t k = i; k < s->n; k++)
            memcpy((char *)s->data + k * s->item, (const char *)s->data + i * s->item, s->item);
    }
}

static status go_on(const struct job *j, const struct checkpoint *c)
{
    status st = OK;
    struct model *m = NULL;
    struct frame frame = {0};
    TRY(model_create(gpu, j, c, &m));
    TRY(model_step(m));
    TRY(model_output(m, &frame));
done:
    frame_free(&frame);
    model_destroy(&m);
    return st;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    struct checkpoint_section *saved;
    if (n < 1 + CHANGE)
        return 0;
    struct checkpoint *c = &state[bytes[0] % MODELS];
    if (!(saved = calloc(c->n_sections, sizeof *saved)))
        abort();
    for (size_t i = 0; i < c->n_sections; i++) {
        saved[i] = c->section[i];
        c->section[i].data = malloc(saved[i].n * saved[i].item + 1);
        if (!c->section[i].data)
            abort();
        memcpy(c->section[i].data, saved[i].data, saved[i].n * saved[i].item);
    }
    for (size_t at = 1, k = 0; k < MOST && at + CHANGE <= n; at += CHANGE, k++)
        change(&c->section[bytes[at] % c->n_sections], bytes + at);
    const status st = go_on(job[bytes[0] % MODELS], c);
    fuzz_refused(st);
    if (st != OK && st != E_CHECKPOINT && st != E_NUMERIC) {
        fprintf(stderr, "status %d: %s\n", (int)st, status_message());
        abort();
    }
    for (size_t i = 0; i < c->n_sections; i++) {
        free(c->section[i].data);
        c->section[i] = saved[i];
    }
    free(saved);
    return 0;
}
