/* Checkpoints with correct hashes and a wrong state: whatever a section contains, the model refuses it, detects diverging numbers, or continues;
 * it never crashes. The sections are those of small runs with all processes on. */
#include "check.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "checkpoint/checkpoint.h"
#include "lib/small_jobs.h"
#include "model/model.h"

static struct gpu *gpu;
static int states; /* that were tried */

static int begin(void **state)
{
    (void)state;
    return gpu_create(&(struct gpu_options){.device = "auto"}, &gpu) != OK;
}

static int end(void **state)
{
    (void)state;
    gpu_destroy(&gpu);
    return 0;
}

static struct job *job_of(const char *text)
{
    char path[] = "/tmp/hoodoo-job.XXXXXX";
    struct job *job = NULL;
    int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), strlen(text));
    assert_int_equal(close(file), 0);
    assert_ok(job_load(path, NULL, 0, &job));
    unlink(path);
    return job;
}

/* The state after two frames. */
static struct checkpoint state_of(const struct job *job)
{
    struct model *m = NULL;
    struct checkpoint c;
    assert_ok(model_create(gpu, job, NULL, &m));
    assert_ok(model_step(m));
    assert_ok(model_step(m));
    assert_ok(model_save(m, &c));
    model_destroy(&m);
    return c;
}

/* Continues from this state to the next frame and the contents of its files. */
static status go_on(const struct job *job, const struct checkpoint *c)
{
    status st = OK;
    states++;
    struct model *m = NULL;
    struct frame frame;
    TRY(model_create(gpu, job, c, &m));
    TRY(model_step(m));
    TRY(model_output(m, &frame));
    frame_free(&frame);
done:
    model_destroy(&m);
    return st;
}

static struct checkpoint_section *section(struct checkpoint *c, const char *name)
{
    for (size_t i = 0; i < c->n_sections; i++)
        if (strcmp(c->section[i].name, name) == 0)
            return &c->section[i];
    print_error("there is no section '%s'\n", name);
    assert_true(false);
    return NULL;
}

/* Expects E_CHECKPOINT and a message that names the section. */
static void assert_refused(const struct job *job, const struct checkpoint *c, const char *name)
{
    status st = go_on(job, c);
    if (st == OK || st != E_CHECKPOINT || !strstr(status_message(), name)) {
        print_error("section '%s': status %d: %s\n", name, st, st == OK ? "" : status_message());
        assert_true(false);
    }
}

/* ---- invalid contents of each section */

/* Sections in which every word is possible; whether refused or not, they must do no harm. */
static bool any_word(const char *name)
{
    return strcmp(name, "air") == 0 || strcmp(name, "change") == 0 || strcmp(name, "air id") == 0 ||
           strcmp(name, "mpm joint") == 0;
}

static uint32_t next_random(uint32_t *x)
{
    *x ^= *x << 13;
    *x ^= *x >> 17;
    *x ^= *x << 5;
    return *x;
}

/* Sets item i to values that are always invalid: NaN (which is also the largest word), infinity, the largest number. */
static void put_extreme(struct checkpoint_section *s, size_t i, int kind)
{
    static const uint32_t word[3] = {UINT32_MAX, 0x7f800000, 0x7f7fffff};
    static const uint64_t wide[3] = {UINT64_MAX, UINT64_C(0x7ff0000000000000), UINT64_C(0x7fefffffffffffff)};
    if (s->item == 4)
        ((uint32_t *)s->data)[i] = word[kind];
    else
        ((uint64_t *)s->data)[i] = wide[kind];
}

/* Sets item i to plausible values: one more, one less, negative, zero; as words and as numbers. */
static void put_other(struct checkpoint_section *s, size_t i, int kind)
{
    static const float number[] = {-1, 0, 1, FLT_TRUE_MIN, 1e6F};
    if (kind < 2 && s->item == 4)
        ((uint32_t *)s->data)[i] += kind == 0 ? 1 : UINT32_MAX;
    else if (kind < 2)
        ((uint64_t *)s->data)[i] += kind == 0 ? 1 : UINT64_MAX;
    else if (s->item == 4)
        ((float *)s->data)[i] = number[kind - 2];
    else
        ((double *)s->data)[i] = (double)number[kind - 2];
}

static void every_section(const char *text)
{
    struct job *job = job_of(text);
    struct checkpoint c = state_of(job);
    uint32_t random = 7;
    size_t refused = 0, tried = 0;
    assert_ok(go_on(job, &c));
    for (size_t k = 0; k < c.n_sections; k++) {
        struct checkpoint_section *s = &c.section[k];
        assert_true(s->item == 4 || s->item == 8);
        assert_true(s->n > 0);
        char *copy = malloc(s->n * s->item);
        assert_non_null(copy);
        memcpy(copy, s->data, s->n * s->item);
        for (int kind = 0; kind < 3; kind++) {
            size_t i = kind == 0 ? 0 : kind == 1 ? s->n - 1 : next_random(&random) % s->n;
            put_extreme(s, i, kind);
            if (!any_word(s->name))
                assert_refused(job, &c, s->name);
            else
                assert_true(go_on(job, &c) != E_MEMORY);
            memcpy(s->data, copy, s->n * s->item);
        }
        for (int kind = (int)(k % 4); kind < 7; kind += 4) { /* a sample of two items */
            put_other(s, next_random(&random) % s->n, kind);
            status st = go_on(job, &c);
            if (st != OK && st != E_CHECKPOINT && st != E_NUMERIC) {
                print_error("section '%s', change %d: status %d: %s\n", s->name, kind, st, status_message());
                assert_true(false);
            }
            refused += st != OK;
            tried++;
            memcpy(s->data, copy, s->n * s->item);
        }
        /* Removes one item. */
        s->n--;
        assert_int_equal(go_on(job, &c), E_CHECKPOINT);
        s->n++;
        free(copy);
    }
    print_message("# %zu sections: %zu of %zu small changes were refused\n", c.n_sections, refused, tried);
    checkpoint_free(&c);
    job_destroy(&job);
}

static void arenite_sections(void **state)
{
    (void)state;
    every_section(arenite);
}

static void shot_sections(void **state)
{
    (void)state;
    every_section(shot);
}

static void goblin_sections(void **state)
{
    (void)state;
    every_section(goblins);
}

static void arches_sections(void **state)
{
    (void)state;
    every_section(arches);
}

/* ---- valid sections that contradict each other */

static void goblin_ledger(void **state)
{
    (void)state;
    struct job *job = job_of(goblins);
    struct checkpoint c = state_of(job);
    struct ledger *ledger = section(&c, "ledger")->data, was = *ledger;
    for (uint64_t rock = 0; rock <= 10; rock += 10) {
        *ledger = (struct ledger){.start = was.start, .rock = rock, .fallen = was.start - rock};
        assert_refused(job, &c, "ledger");
    }
    *ledger = was;
    ledger->rock += 1000000;
    ledger->start += 1000000;
    assert_refused(job, &c, "ledger");
    checkpoint_free(&c);
    job_destroy(&job);
}

static void arches_ledger(void **state)
{
    (void)state;
    struct job *job = job_of(arches);
    struct checkpoint c = state_of(job);
    struct ledger *ledger = section(&c, "ledger")->data;
    ledger->rock--;
    ledger->left++;
    assert_refused(job, &c, "ledger");
    checkpoint_free(&c);
    job_destroy(&job);
}

static void ids(void **state)
{
    (void)state;
    struct job *job = job_of(shot);
    struct checkpoint c = state_of(job);
    uint32_t *id = section(&c, "id")->data, *point = section(&c, "mpm id")->data;
    size_t n = section(&c, "id")->n;
    uint32_t was = id[n / 2];
    id[n / 2] = id[0];
    assert_refused(job, &c, "id");
    id[n / 2] = (uint32_t)((struct ledger *)section(&c, "ledger")->data)->start;
    assert_refused(job, &c, "id");
    id[n / 2] = was;
    point[0] = point[1];
    assert_refused(job, &c, "mpm id");
    checkpoint_free(&c);
    job_destroy(&job);
}

/* In a shot: all points at once. */
static void all_points(void **state)
{
    (void)state;
    struct job *job = job_of(shot);
    struct checkpoint c = state_of(job);
    static const struct {
        const char *name;
        float value;
    } change[] = {{"mpm place", NAN}, {"mpm share", 0}, {"P", NAN}};
    for (size_t k = 0; k < sizeof change / sizeof *change; k++) {
        struct checkpoint_section *s = section(&c, change[k].name);
        char *copy = malloc(s->n * s->item);
        assert_non_null(copy);
        memcpy(copy, s->data, s->n * s->item);
        for (size_t i = 0; i < s->n; i++)
            ((float *)s->data)[i] = change[k].value;
        assert_refused(job, &c, change[k].name);
        memcpy(s->data, copy, s->n * s->item);
        free(copy);
    }
    uint32_t *piece = section(&c, "mpm piece")->data, *joint = section(&c, "mpm joint")->data, was = piece[0];
    piece[0] = 0;
    assert_refused(job, &c, "mpm piece");
    piece[0] = 100000;
    assert_refused(job, &c, "mpm piece");
    piece[0] = was;
    joint[0] = 0x7ffffffe;
    assert_refused(job, &c, "mpm joint");
    assert_true(strstr(status_message(), "2147483646") != NULL);
    checkpoint_free(&c);
    job_destroy(&job);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(goblin_ledger),
        cmocka_unit_test(arches_ledger),
        cmocka_unit_test(ids),
        cmocka_unit_test(all_points),
        cmocka_unit_test(goblin_sections),
        cmocka_unit_test(arches_sections),
        cmocka_unit_test(arenite_sections),
        cmocka_unit_test(shot_sections),
    };
    const int failed = cmocka_run_group_tests(tests, begin, end);
    print_message(
        "# fault | states under right hashes, of all models, with items that cannot be, contradict each other or are merely other | %d | "
        "exit code 7 with section and item, 8, or a frame; never a crash | %d |\n",
        states, failed);
    return failed;
}
