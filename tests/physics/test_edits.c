/* Edits while a rock erodes (Arenite fig. 10): what is added erodes from then on, what is carved is gone, what is set
 * holds in exactly its frame, and the ledger knows of all of it. */
#include "model_help.h"

#include <math.h>
#include <string.h>

static const char head[] = "name: cube\nframes: 1001-1008\nclock: {years_per_frame: 1500}\nseed: 3\n"
                           "domain: {size_m: [14, 14, 16], spacing_m: 0.5}\n"
                           "scene: {box: {min_m: [2, 2, 0], max_m: [12, 12, 8]}}\n"
                           "strata:\n"
                           "  - {to_m: 4, weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.02, interlock_MPa: 0.2}\n"
                           "  - {weak_m_per_kyr: 0.05, strong_m_per_kyr: 0.01, interlock_MPa: 0.2}\n"
                           "noise: {amplitude: 0.3, scale_m: 4}\n";

enum { FIRST = 1001, FRAMES = 8, H3 = 8 /* particles in a cubic metre */ };

struct run {
    struct frame frame[FRAMES];
};

static void check_ledger(const struct frame *f)
{
    const struct ledger *l = &f->ledger;
    assert_true(l->start == l->rock + l->deposit + l->fallen + l->left);
    assert_true(l->rock + l->deposit == f->rock.n);
}

static struct run erode(const char *edits)
{
    struct run out;
    char text[4000];
    snprintf(text, sizeof text, "%s%s", head, edits);
    struct sim s = sim_begin(text);
    for (int i = 0; i < FRAMES; i++) {
        if (i)
            assert_ok(model_step(s.model));
        out.frame[i] = sim_output(&s);
        check_ledger(&out.frame[i]);
    }
    sim_end(&s);
    return out;
}

static void run_free(struct run *r)
{
    for (int i = 0; i < FRAMES; i++)
        frame_free(&r->frame[i]);
}

static bool same(const struct frame *a, const struct frame *b)
{
    bool equal = a->rock.n == b->rock.n && a->years == b->years;
    for (int f = 0; f < ROCK_FIELDS && equal; f++)
        if (a->rock.field[f] || b->rock.field[f]) /* some are in some jobs alone */
            equal = a->rock.field[f] && b->rock.field[f] &&
                    memcmp(a->rock.field[f], b->rock.field[f],
                           a->rock.n * rock_field_size((enum rock_field)f)) == 0;
    return equal;
}

/* m3 of particles with these ids. */
static double volume(const struct frame *f, uint32_t from, uint32_t to)
{
    double sum = 0;
    for (size_t i = 0; i < f->rock.n; i++)
        if (f->rock.id[i] >= from && f->rock.id[i] < to)
            sum += (double)f->rock.viability[i] / H3;
    return sum;
}

static struct run plain;

static int erode_plainly(void **state)
{
    (void)state;
    plain = erode("");
    return 0;
}

static int free_plain(void **state)
{
    (void)state;
    run_free(&plain);
    return 0;
}

static void two_cylinders_on_top_erode_from_then_on(void **state)
{
    (void)state;
    struct run r = erode(
        "edits:\n"
        "  - frame: 1004\n"
        "    add:\n"
        "      - {shape: {cylinder: {from_m: [5, 5, 6], to_m: [5, 5, 13], radius_m: 1.8}}}\n"
        "      - {shape: {cylinder: {from_m: [9, 9, 6], to_m: [9, 9, 12], radius_m: 1.6}}, layer: 0}\n");
    uint32_t old = (uint32_t)plain.frame[0].ledger.start;
    for (int i = 0; i < 3; i++)
        assert_true(same(&r.frame[i], &plain.frame[i]));
    const struct frame *f = &r.frame[3];
    uint32_t added = (uint32_t)f->ledger.start - old;
    /* Above a top that has sunk to about 7.7 m by then; one frame of erosion is taken off it. */
    double whole = M_PI * (1.8 * 1.8 * (13 - 7.7) + 1.6 * 1.6 * (12 - 7.7)),
           before = volume(f, old, old + added);
    print_message("# %u particles added; %.1f m3 of %.1f are left after the first frame:", added, before,
                  whole);
    assert_true(before > 0.7 * whole && before < whole);
    assert_true(f->start_volume_m3 > plain.frame[0].start_volume_m3 + 0.9 * whole);
    bool weak = false, high = false;
    for (size_t i = 0; i < f->rock.n; i++)
        if (f->rock.id[i] >= old && f->rock.P[4 * i + 2] > 9) {
            weak |= f->rock.P[4 * i] > 7 && f->rock.layer[i] == 0;
            high |= f->rock.P[4 * i] < 7 && f->rock.layer[i] == 1;
        }
    assert_true(weak && high);
    for (int i = 4; i < FRAMES; i++) {
        double now = volume(&r.frame[i], old, old + added);
        assert_true(now < before);
        assert_int_equal(r.frame[i].ledger.start, old + added);
        before = now;
        print_message(" %.1f", now);
    }
    print_message("\n");
    run_free(&r);
}

static void what_is_carved_has_left(void **state)
{
    (void)state;
    struct run r = erode("edits: [{frame: 1005, carve: {sphere: {center_m: [7, 7, 8], radius_m: 3}}}]\n");
    for (int i = 0; i < 4; i++)
        assert_true(same(&r.frame[i], &plain.frame[i]));
    const struct frame *f = &r.frame[4], *p = &plain.frame[4];
    assert_int_equal(f->ledger.start, p->ledger.start);
    double gone = p->volume_m3 - f->volume_m3;
    print_message("# %.1f m3 carved and eroded around the hole\n", gone);
    assert_true(gone > 0.75 * 2.0 / 3 * M_PI * 27 && gone < 1.3 * 2.0 / 3 * M_PI * 27);
    assert_true(f->ledger.left >= p->ledger.left + 300);
    for (size_t i = 0; i < f->rock.n; i++) {
        const float *P = f->rock.P + 4 * i;
        assert_true(hypot(hypot((double)P[0] - 7, (double)P[1] - 7), (double)P[2] - 8) > 2.4);
    }
    run_free(&r);
}

static void parameters_change_in_exactly_their_frame(void **state)
{
    (void)state;
    struct run set = erode("edits: [{frame: 1005, set: {wind.speed_m_s: 20, clock.years_per_frame: 750}}]\n");
    struct run curve = erode("wind: {speed_m_s: {1001: 10, 1005: 20, ease: step}}\n");
    for (int i = 0; i < 4; i++)
        assert_true(same(&set.frame[i], &plain.frame[i]));
    assert_true(!same(&set.frame[4], &plain.frame[4]));
    for (int i = 0; i < FRAMES; i++)
        assert_true(set.frame[i].years == 1500.0 * (i < 4 ? i : 3) + 750.0 * (i < 4 ? 0 : i - 3));
    /* Half the years of the other's wind: about half of what that takes in its frame. */
    double by_set = set.frame[3].volume_m3 - set.frame[4].volume_m3,
           by_curve = curve.frame[3].volume_m3 - curve.frame[4].volume_m3,
           by_none = plain.frame[3].volume_m3 - plain.frame[4].volume_m3;
    print_message(
        "# frame 1005 takes %.2f m3; %.2f with the wind as a curve, in twice the years; %.2f unedited\n",
        by_set, by_curve, by_none);
    assert_true(fabs(2 * by_set / by_curve - 1) < 0.1 && by_curve > 1.2 * by_none);
    run_free(&set);
    run_free(&curve);
}

static void strata_and_density_can_be_set(void **state)
{
    (void)state;
    struct run r =
        erode("edits:\n"
              "  - {frame: 1003, set: {strata.0.weak_m_per_kyr: 0, strata.1.weak_m_per_kyr: 0,\n"
              "                        strata.0.strong_m_per_kyr: 0, strata.1.strong_m_per_kyr: 0}}\n"
              "  - {frame: 1005, set: {rock.density_kg_m3: 4600}}\n");
    assert_true(same(&r.frame[1], &plain.frame[1]));
    for (int i = 2; i < FRAMES; i++)
        assert_true(r.frame[i].volume_m3 == r.frame[1].volume_m3);
    double ratio = r.frame[4].max_stress_Pa / r.frame[3].max_stress_Pa;
    print_message("# nothing erodes any more; twice the weight, %.4f times the stress\n", ratio);
    assert_true(fabs(ratio - 2) < 0.04);
    run_free(&r);
}

static void edits_of_the_first_frame_are_in_it(void **state)
{
    (void)state;
    struct run r =
        erode("edits: [{frame: 1001, add: [{shape: {box: {min_m: [5, 5, 8], max_m: [9, 9, 10]}}}],\n"
              "         carve: {box: {min_m: [0, 0, 4], max_m: [4, 14, 8]}},\n"
              "         paint: [{shape: {plane: {point_m: [0, 0, 3], normal: [0, 0, 1]}}, inert: true}]}]\n");
    const struct frame *f = &r.frame[0];
    assert_int_equal(f->ledger.start, (800 + 32) * H3);
    assert_int_equal(f->ledger.left, 2 * 10 * 4 * H3);
    assert_int_equal(f->rock.n, f->ledger.start - f->ledger.left);
    assert_true(fabs(f->volume_m3 - 752) < 1e-3 && fabs(f->start_volume_m3 - 752) < 1e-3);
    double inert = 0;
    for (size_t i = 0; i < r.frame[FRAMES - 1].rock.n; i++)
        if (r.frame[FRAMES - 1].rock.P[4 * i + 2] <= 3)
            inert += (double)r.frame[FRAMES - 1].rock.viability[i] / H3;
    assert_true(fabs(inert - 300) < 1e-3);
    run_free(&r);
}

/* Not connected to the ground: it falls in the frame it is added in, and the ledger says so. */
static void what_floats_falls(void **state)
{
    (void)state;
    struct run r =
        erode("edits: [{frame: 1003, add: [{shape: {sphere: {center_m: [7, 7, 13], radius_m: 2}}}]}]\n");
    const struct frame *f = &r.frame[2];
    uint64_t added = f->ledger.start - plain.frame[2].ledger.start;
    assert_true(added > 200 && f->ledger.fallen >= added);
    assert_int_equal(f->ledger.rock, plain.frame[2].ledger.rock);
    run_free(&r);
}

static void a_rock_can_be_carved_away_and_begun_anew(void **state)
{
    (void)state;
    struct run r =
        erode("edits:\n"
              "  - {frame: 1003, carve: {box: {min_m: [0, 0, 0], max_m: [14, 14, 16]}}}\n"
              "  - {frame: 1006, add: [{shape: {box: {min_m: [4, 4, 0], max_m: [10, 10, 6]}}}]}\n");
    for (int i = 2; i < 5; i++)
        assert_true(r.frame[i].rock.n == 0 && r.frame[i].volume_m3 == 0);
    assert_true(r.frame[5].volume_m3 > 180 && r.frame[5].volume_m3 < 216);
    assert_true(r.frame[7].volume_m3 < r.frame[6].volume_m3);
    for (size_t i = 0; i < r.frame[5].rock.n; i++)
        assert_true(r.frame[5].rock.id[i] >= plain.frame[0].ledger.start);
    run_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_cylinders_on_top_erode_from_then_on),
        cmocka_unit_test(what_is_carved_has_left),
        cmocka_unit_test(parameters_change_in_exactly_their_frame),
        cmocka_unit_test(strata_and_density_can_be_set),
        cmocka_unit_test(edits_of_the_first_frame_are_in_it),
        cmocka_unit_test(what_floats_falls),
        cmocka_unit_test(a_rock_can_be_carved_away_and_begun_anew),
    };
    return cmocka_run_group_tests(tests, erode_plainly, free_plain);
}
