/* A state at another spacing: the same rock, with the scene's own detail where it is untouched and what edits did where they did it; and it
 * goes on as the rock that always had that spacing. */
#include "model_help.h"

#include <math.h>

#include "model/resample.h"
#include "surface.h"

/* A pillar on a hard slab, where talus gathers at its foot; plants on top. At frame 3 a part is painted, a part carved out, and a lintel
 * added. */
static const char rock[] =
    "hoodoo: 1\n"
    "name: rock\n"
    "frames: 1-100\n"
    "clock: {years_per_frame: 1000}\n"
    "domain: {size_m: [32, 24, 32], spacing_m: %g, particles: %s}\n"
    "scene:\n"
    "  union:\n"
    "    - box: {min_m: [0, 0, 0], max_m: [32, 24, 4], inert: true}\n"
    "    - cylinder: {from_m: [12, 12, 0], to_m: [12, 12, 28], radius_m: 8}\n"
    "paint: [{shape: {box: {min_m: [0, 0, 24], max_m: [32, 24, 32]}}, vegetation: 0.6}]\n"
    "strata:\n"
    "  - {to_m: 12, weak_m_per_kyr: 0.5, strong_m_per_kyr: 0.05, interlock_MPa: 0.2}\n"
    "  - {weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.01, interlock_MPa: 0.2}\n"
    "noise: {amplitude: 0.4, scale_m: 6}\n"
    "wind: {speed_m_s: 12, deflation: {strength_MPa: 1}}\n"
    "deposition: {viability: 0.5}\n"
    "skin: {exposed: true}\n"
    "%s";
static const char edits[] =
    "edits:\n"
    "  - frame: 3\n"
    "    carve: {sphere: {center_m: [12, 5, 12], radius_m: 3}}\n"
    "    add: [{shape: {box: {min_m: [12, 9, 20], max_m: [26, 15, 26]}}, layer: 0}]\n"
    "    paint: [{shape: {box: {min_m: [0, 0, 4], max_m: [32, 24, 8]}}, erodibility: 3}]\n";

/* The job of a text, without a model yet. */
static struct sim load(const char *text)
{
    char path[] = "/tmp/hoodoo-job.XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0 && write(file, text, strlen(text)) == (ssize_t)strlen(text));
    assert_int_equal(close(file), 0);
    struct sim s = {0};
    assert_ok(job_load(path, NULL, 0, &s.job));
    unlink(path);
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &s.gpu));
    return s;
}

static struct sim start(double spacing, const char *particles, const char *more)
{
    char text[4096];
    snprintf(text, sizeof text, rock, spacing, particles, more);
    return load(text);
}

static void run(struct sim *s, int frames)
{
    if (!s->model)
        assert_ok(model_create(s->gpu, s->job, NULL, &s->model));
    for (int f = 0; f < frames; f++)
        assert_ok(model_step(s->model));
}

static struct sim after(double spacing, const char *particles, const char *more, int frames)
{
    struct sim s = start(spacing, particles, more);
    run(&s, frames);
    return s;
}

/* Makes the model of `to` from the state of `s`. */
static void move(struct sim *s, struct sim *to)
{
    struct checkpoint c;
    double was;
    assert_ok(model_save(s->model, &c));
    assert_ok(model_resample(to->job, &c, &was));
    assert_true(was == s->job->domain.spacing_m);
    assert_ok(model_create(to->gpu, to->job, &c, &to->model));
    checkpoint_free(&c);
}

/* The same state at another spacing. */
static struct sim at_spacing(struct sim *s, double spacing, const char *particles, const char *more)
{
    struct sim to = start(spacing, particles, more);
    move(s, &to);
    return to;
}

/* The shape of a frame is a surface drawn at its own spacing, so that a block of 16 voxels a side is not quite the same at another one even if
 * nothing has happened: runs that had those spacings from the start overlap by 0.97 (1 and 0.5 m) and 0.96 (1 and 0.25 m) here. */

/* Volume of what both surfaces enclose over that of what either does, by points 1/4 m apart. */
static double overlap(const struct frame *a, const struct frame *b)
{
    const struct surface s = surface_of(a), t = surface_of(b);
    long both = 0, either = 0;
    for (double z = 0.125; z < 32; z += 0.25)
        for (double y = 0.125; y < 24; y += 0.25)
            for (double x = 0.125; x < 32; x += 0.25) {
                const bool in_s = surface_at(&s, (const double[]){x, y, z}) < 0,
                           in_t = surface_at(&t, (const double[]){x, y, z}) < 0;
                both += in_s && in_t;
                either += in_s || in_t;
            }
    return (double)both / (double)either;
}

static void the_same_rock(void **state)
{
    (void)state;
    struct sim coarse = after(1, "needed", edits, 8);
    struct frame was = sim_output(&coarse);
    static const struct {
        double spacing, overlap;
    } to[] = {{0.5, 0.97}, {0.25, 0.95}, {2, 0.88}};
    for (size_t i = 0; i < sizeof to / sizeof *to; i++) {
        struct sim s = at_spacing(&coarse, to[i].spacing, "needed", edits);
        struct frame is = sim_output(&s);
        const double same = overlap(&was, &is), volume = is.volume_m3 / was.volume_m3 - 1;
        print_message(
            "# 1 m to %g m: overlap %.4f, volume %+.3f %%, %llu rock and %llu deposits for %llu and %llu\n",
            to[i].spacing, same, 100 * volume, (unsigned long long)is.ledger.rock,
            (unsigned long long)is.ledger.deposit, (unsigned long long)was.ledger.rock,
            (unsigned long long)was.ledger.deposit);
        assert_true(same >= to[i].overlap);
        assert_true(fabs(volume) < 0.005);
        assert_true(is.number == was.number && is.years == was.years &&
                    is.start_volume_m3 == was.start_volume_m3);
        frame_free(&is);
        sim_end(&s);
    }
    frame_free(&was);
    sim_end(&coarse);
}

static int by_id(const void *a, const void *b)
{
    const uint32_t *i = a, *j = b;
    return i[0] < j[0] ? -1 : i[0] > j[0];
}

/* The particles' numbers in the order of their ids; free with free(). */
static uint32_t *order_of(const struct rock *of)
{
    uint32_t(*order)[2] = malloc(of->n * sizeof *order), *number = malloc(of->n * sizeof *number);
    assert_true(order && number);
    for (size_t p = 0; p < of->n; p++) {
        order[p][0] = of->id[p];
        order[p][1] = (uint32_t)p;
    }
    qsort(order, of->n, sizeof *order, by_id);
    for (size_t p = 0; p < of->n; p++)
        number[p] = order[p][1];
    free(order);
    return number;
}

/* Rock on which nothing has worked yet is the same as if it had started at the other spacing: every particle with its values. */
static void untouched_rock_is_the_scene(void **state)
{
    (void)state;
    for (int to = 0; to < 2; to++) {
        const double spacing = (const double[]){0.5, 2}[to];
        struct sim coarse = after(1, "needed", edits, 0), fine = after(spacing, "all", edits, 0),
                   moved = at_spacing(&coarse, spacing, "all", edits);
        struct frame want = sim_output(&fine), got = sim_output(&moved);
        const struct rock *a = &want.rock, *b = &got.rock;
        uint32_t *of_a = order_of(a), *of_b = order_of(b);
        size_t same = 0, i = 0, k = 0;
        for (; i < a->n && k < b->n;) {
            const uint32_t p = of_a[i], q = of_b[k];
            if (a->id[p] != b->id[q]) {
                *(a->id[p] < b->id[q] ? &i : &k) += 1;
                continue;
            }
            assert_memory_equal(a->P + 4 * p, b->P + 4 * q, 16);
            assert_true(a->layer[p] == b->layer[q] && a->phase[p] == b->phase[q]);
            same += fabsf(a->viability[p] - b->viability[q]) < 0.02f;
            i++;
            k++;
        }
        print_message("# at %g m: %zu particles at the start, %zu resampled, %zu the same\n", spacing, a->n,
                      b->n, same);
        /* The mean of eight voxels is more exact than the 64 probes of a large one. */
        const double most = spacing > 1 ? 0.95 : 0.997;
        assert_true((double)same > most * (double)a->n && (double)same > most * (double)b->n);
        free(of_a);
        free(of_b);
        frame_free(&want);
        frame_free(&got);
        sim_end(&coarse);
        sim_end(&fine);
        sim_end(&moved);
    }
}

/* What edits painted, added and carved out stays where it was. */
static void edits_are_kept(void **state)
{
    (void)state;
    struct sim coarse = after(1, "needed", edits, 4), plain = after(0.5, "needed", "", 0),
               s = at_spacing(&coarse, 0.5, "needed", edits);
    struct frame is = sim_output(&s), scene = sim_output(&plain);
    float *first = calloc(scene.ledger.start, sizeof *first);
    size_t painted = 0, kept = 0, lintel = 0, carved = 0;
    assert_non_null(first);
    for (size_t p = 0; p < scene.rock.n; p++)
        first[scene.rock.id[p]] = scene.rock.rate_factor[p];
    for (size_t p = 0; p < is.rock.n; p++) {
        const float *x = is.rock.P + 4 * p;
        const bool own = is.rock.id[p] < scene.ledger.start;
        if (is.rock.phase[p] != 0)
            continue;
        if (own && first[is.rock.id[p]] > 0 && x[2] > 5 && x[2] < 7) {
            painted++;
            kept += fabsf(is.rock.rate_factor[p] / first[is.rock.id[p]] / 3 - 1) < 1e-4f;
        }
        lintel += !own && x[0] > 22 && x[2] > 21 && x[2] < 25 && is.rock.layer[p] == 0;
        carved += hypotf(hypotf(x[0] - 12, x[1] - 5), x[2] - 12) < 2;
    }
    print_message("# %zu of %zu painted, %zu in the lintel, %zu where rock was carved out\n", kept, painted,
                  lintel, carved);
    assert_true(painted > 500 && kept == painted && lintel > 100 && carved == 0);
    free(first);
    frame_free(&is);
    frame_free(&scene);
    sim_end(&coarse);
    sim_end(&plain);
    sim_end(&s);
}

/* The rock that wind has taken in a frame. */
static double taken(struct sim *s)
{
    double m3 = 0;
    assert_ok(model_step(s->model));
    struct frame frame = sim_output(s);
    for (size_t i = 0; i < frame.n_changes; i++)
        if (strcmp(frame.change[i].process, "deflation") == 0 ||
            strcmp(frame.change[i].process, "abrasion") == 0)
            m3 -= frame.change[i].m3;
    frame_free(&frame);
    return m3;
}

/* What goes on at the smaller spacing is the rock that always had it. */
static void it_goes_on(void **state)
{
    (void)state;
    struct sim coarse = after(1, "needed", edits, 4), fine = after(0.5, "needed", edits, 4),
               s = at_spacing(&coarse, 0.5, "needed", edits);
    for (int f = 0; f < 3; f++) {
        const double always = taken(&fine), now = taken(&s);
        print_message("# frame %d: wind takes %.1f m3, %.1f m3 where the spacing was always 0.5 m\n", f + 1,
                      now, always);
        assert_true(fabs(now / always - 1) < 0.1);
    }
    struct frame a = sim_output(&fine), b = sim_output(&s);
    const double same = overlap(&a, &b), volume = b.volume_m3 / a.volume_m3 - 1;
    print_message("# overlap %.4f, volume %+.2f %%\n", same, 100 * volume);
    assert_true(same > 0.97 && fabs(volume) < 0.005);
    frame_free(&a);
    frame_free(&b);
    sim_end(&coarse);
    sim_end(&fine);
    sim_end(&s);
}

/* The share of the deposits that move in the next frame. */
static double deposits_that_move(struct sim *s)
{
    struct frame a = sim_output(s);
    assert_ok(model_step(s->model));
    struct frame b = sim_output(s);
    uint32_t *of_a = order_of(&a.rock), *of_b = order_of(&b.rock);
    size_t there = 0, moved = 0;
    for (size_t i = 0, k = 0; i < a.rock.n && k < b.rock.n;) {
        const uint32_t p = of_a[i], q = of_b[k];
        if (a.rock.id[p] != b.rock.id[q]) {
            *(a.rock.id[p] < b.rock.id[q] ? &i : &k) += 1;
            continue;
        }
        if (a.rock.phase[p] == 1) {
            there++;
            moved += memcmp(a.rock.P + 4 * p, b.rock.P + 4 * q, 16) != 0;
        }
        i++;
        k++;
    }
    print_message("# %zu of %zu deposits moved in the next frame\n", moved, there);
    assert_true(there > 300);
    free(of_a);
    free(of_b);
    frame_free(&a);
    frame_free(&b);
    return (double)moved / (double)there;
}

/* Talus settles once: heaps of a few large voxels are not at the angle of repose to within small ones. Then it lies still. */
static void heaps_settle_once(void **state)
{
    (void)state;
    struct sim coarse = after(1, "needed", "", 8), s = at_spacing(&coarse, 0.5, "needed", "");
    assert_true(deposits_that_move(&s) < 0.2);
    assert_true(deposits_that_move(&s) < 0.03);
    sim_end(&coarse);
    sim_end(&s);
}

static const char goblin[] = "hoodoo: 1\n"
                             "name: goblin\n"
                             "model: goblins\n"
                             "frames: 1-100\n"
                             "clock: {years_per_frame: 1000}\n"
                             "domain: {size_m: [12, 12, 16], spacing_m: %g}\n"
                             "scene: {cylinder: {from_m: [6, 6, 0], to_m: [6, 6, 14], radius_m: 4.3}}\n"
                             "strata:\n"
                             "  - {to_m: 6, weak_m_per_kyr: 0.1, bubble: {radius_m: 1.5}}\n"
                             "  - {weak_m_per_kyr: 0.05, bubble: {radius_m: 1.5}}\n"
                             "noise: {amplitude: 0.3, scale_m: 3}\n";

/* Goblins: voxels are divided like rock; those on which nothing has worked are the scene's, and what goes on is the goblin that always had
 * the spacing. */
static void goblins_too(void **state)
{
    char text[2][2048];
    (void)state;
    snprintf(text[0], sizeof text[0], goblin, 0.5);
    snprintf(text[1], sizeof text[1], goblin, 0.25);
    for (int frames = 0; frames <= 8; frames += 8) {
        struct sim coarse = load(text[0]), fine = load(text[1]), s = load(text[1]);
        run(&coarse, frames);
        run(&fine, frames);
        move(&coarse, &s);
        struct frame was = sim_output(&coarse), is = sim_output(&s), want = sim_output(&fine);
        const double volume = is.volume_m3 / was.volume_m3 - 1, same = overlap(&is, &was),
                     always = overlap(&is, &want), runs = overlap(&was, &want);
        print_message(
            "# goblin after %d frames: %.1f m3 at 0.5 m, %.1f resampled at 0.25 m, overlap %.4f; with the run at "
            "0.25 m %.4f, the runs with each other %.4f\n",
            frames, was.volume_m3, is.volume_m3, same, always, runs);
        assert_true(fabs(volume) < 0.005 && same > 0.95 && always > (frames ? runs - 0.005 : 0.9999));
        frame_free(&was);
        frame_free(&is);
        frame_free(&want);
        run(&fine, 4);
        run(&s, 4);
        is = sim_output(&s);
        want = sim_output(&fine);
        print_message("# four frames later %.1f m3, %.1f m3 where it always was\n", is.volume_m3,
                      want.volume_m3);
        assert_true(fabs(is.volume_m3 / want.volume_m3 - 1) < 0.02);
        frame_free(&is);
        frame_free(&want);
        sim_end(&coarse);
        sim_end(&fine);
        sim_end(&s);
    }
}

static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    struct sim coarse = after(1, "needed", "", 1);
    struct checkpoint c;
    double was;
    assert_ok(model_save(coarse.model, &c));
    static const struct {
        double spacing;
        const char *more, *says;
    } wrong[] = {{0.7, "", "any whole ratio up to 8"},
                 {0.1, "", "any whole ratio up to 8"},
                 {0.5, "model: goblins\n", "belongs to another model"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct sim to = start(wrong[i].spacing, "needed", wrong[i].more);
        assert_int_equal(model_resample(to.job, &c, &was), E_CHECKPOINT);
        assert_non_null(strstr(status_message(), wrong[i].says));
        gpu_destroy(&to.gpu);
        job_destroy(&to.job);
    }
    checkpoint_free(&c);
    sim_end(&coarse);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_rock),
        cmocka_unit_test(untouched_rock_is_the_scene),
        cmocka_unit_test(edits_are_kept),
        cmocka_unit_test(it_goes_on),
        cmocka_unit_test(goblins_too),
        cmocka_unit_test(heaps_settle_once),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
