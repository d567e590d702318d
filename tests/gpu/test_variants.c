/* A small job of years, and one of seconds in which rock breaks and falls, in every kernel variant, and with buffers beyond
 * what a device binds: the same state and the same pictures as in the variant that the device gets by itself, bit for bit. Which
 * that is, or how large a job is, may not change the rock. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "effort.h"
#include "gpu/kernel_source.h"
#include "model/model.h"

enum { STEPS = 2, JOBS = 2 };

static const char *const paths[JOBS] = {"tests/restart/twelve.yaml", "tests/gpu/falling.yaml"};

/* What a run leaves, in the order it was made. */
struct trace {
    size_t n, capacity;
    char *bytes;
};

static struct trace expected;
static struct job *jobs[JOBS];

static void add(struct trace *t, const void *bytes, size_t n)
{
    if (t->n + n > t->capacity) {
        t->capacity = 2 * (t->n + n);
        t->bytes = realloc(t->bytes, t->capacity);
        assert_non_null(t->bytes);
    }
    memcpy(t->bytes + t->n, bytes, n);
    t->n += n;
}

static void add_state(struct trace *t, struct model *m)
{
    struct checkpoint c;
    assert_ok(model_save(m, &c));
    for (size_t i = 0; i < c.n_sections; i++)
        add(t, c.section[i].data, c.section[i].n * c.section[i].item);
    checkpoint_free(&c);
}

static void add_frame(struct trace *t, struct model *m)
{
    struct frame f;
    assert_ok(model_output(m, &f));
    assert_true(f.rock.n > 1000);
    assert_int_equal(f.n_images, 1);
    for (int i = 0; i < ROCK_FIELDS; i++)
        if (f.rock.field[i])
            add(t, f.rock.field[i], f.rock.n * rock_field_size((enum rock_field)i));
    for (size_t i = 0; i < f.grids.n_grids; i++) {
        const struct frame_grid *g = &f.grids.grid[i];
        add(t, g->value, f.grids.bricks.count * BRICK_SAMPLES * (g->components == 3 ? 3 : 1) * sizeof(float));
    }
    const struct aov_image *image = &f.image[0];
    for (size_t i = 0; i < image->n_channels; i++) {
        const struct aov_channel *channel = &image->channel[i];
        add(t, channel->value ? (const void *)channel->value : channel->id,
            (size_t)image->width * (size_t)image->height * 4);
    }
    frame_free(&f);
}

static void run_job(const struct gpu_options *options, const struct job *job, struct trace *t)
{
    struct gpu *gpu = NULL;
    struct model *m = NULL;
    assert_ok(gpu_create(options, &gpu));
    assert_ok(model_create(gpu, job, NULL, &m));
    add_frame(t, m);
    size_t at = t->n, size = 0;
    for (int i = 0; i < STEPS; i++) {
        add_state(t, m);
        size = i == 0 ? t->n - at : size;
        assert_ok(model_step(m));
        add_frame(t, m);
    }
    const size_t last = t->n;
    add_state(t, m);
    /* The rock changes: this is not the comparison of nothing with nothing. */
    assert_true(t->n - last != size || memcmp(t->bytes + at, t->bytes + last, size) != 0);
    assert_int_equal(model_frame(m), job->frames.first + STEPS);
    model_destroy(&m);
    gpu_destroy(&gpu);
}

static void run(const struct gpu_options *options, struct trace *t)
{
    for (int i = 0; i < JOBS; i++)
        run_job(options, jobs[i], t);
}

static void same_bits(void **state)
{
    struct trace t = {0};
    run(*state, &t);
    assert_int_equal(t.n, expected.n);
    for (size_t i = 0; i < t.n; i++)
        if (t.bytes[i] != expected.bytes[i]) {
            print_error("byte %zu of %zu differs\n", i, t.n);
            _fail(__FILE__, __LINE__);
        }
    free(t.bytes);
}

static int begin(void **state)
{
    (void)state;
    const char *top = getenv("HOODOO_TOP");
    char path[4096];
    for (int i = 0; i < JOBS; i++) {
        snprintf(path, sizeof path, "%s/%s", top ? top : ".", paths[i]);
        assert_ok(job_load(path, NULL, 0, &jobs[i]));
    }
    run(&(struct gpu_options){.device = "auto"}, &expected);
    return 0;
}

static int end(void **state)
{
    (void)state;
    free(expected.bytes);
    for (int i = 0; i < JOBS; i++)
        job_destroy(&jobs[i]);
    return 0;
}

int main(void)
{
    static struct gpu_options texel = {.device = "auto", .variant = VARIANT_TEXEL + 1};
    static struct gpu_options wide = {.device = "auto", .variant = VARIANT_WIDE + 1, .unconditional = true};
    static struct gpu_options staged = {
        .device = "auto", .variant = VARIANT_STORAGE + 1, .staged = true}; /* as on a GPU */
    static struct gpu_options nothing_fits = {.device = "auto", .range_limit = 1};
    static struct gpu_options some_fit = {.device = "auto", .range_limit = 20000};
#define WITH(options)                                                                                        \
    {                                                                                                        \
        "same_bits (" #options ")", same_bits, NULL, NULL, &options                                          \
    }
    const struct CMUnitTest tests[] = {
        WITH(texel), WITH(staged), WITH(wide), WITH(nothing_fits), WITH(some_fit),
    };
    if (effort() < 1)
        cmocka_set_test_filter("*some_fit*"); /* which has some of the others' */
    return cmocka_run_group_tests_name("variants", tests, begin, end);
}
