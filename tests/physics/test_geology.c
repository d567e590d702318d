/* What the structure of rock makes of it, with no shape typed for it: fins and columns between joints, a scarp and a dip slope of tilted
 * beds, blocks that joints bound; each at two spacings or seeds, and gone where its coupling is switched off. Thin beds retreat alike. */
#include "effort.h"
#include "geology/attitude.h"
#include "geology/concretions.h"
#include "geology/structure.h"
#include "physics/beds.h"

#include <string.h>

/* ---- a plateau that weathers from above */

enum { WIDE = 24, HIGH = 12 }; /* m */

/* `more`: of its keys, after those of the rock. */
static struct sim plateau(double h, int seed, int frames, const char *more)
{
    char text[2048];
    snprintf(
        text, sizeof text,
        "hoodoo: 1\nname: plateau\nframes: 1-%d\nseed: %d\nclock: {years_per_frame: 2400}\n"
        "domain: {size_m: [%d, %d, %d], spacing_m: %g, sides: {x_min: wall, x_max: wall, y_min: wall, y_max: "
        "wall}}\n"
        "rock: {gravity_m_s2: 0}\nstrata: [{weak_m_per_kyr: 0.1}]\n"
        "scene: {box: {min_m: [-1, -1, 0], max_m: [99, 99, %d]}}\n%s",
        frames + 1, seed, WIDE, WIDE, HIGH + 2, h, HIGH, more);
    return sim_begin(text);
}

static void weather(struct sim *s, int frames)
{
    for (int f = 0; f < frames; f++)
        assert_ok(model_step(s->model));
}

/* What is left of the columns at a height, a square metre each; 0 to 1. */
struct section {
    double share[WIDE][WIDE]; /* by y, x */
};

static struct section cut(struct sim *s, double low, double high)
{
    struct section out = {{{0}}};
    struct frame frame = sim_output(s);
    const double h = s->job->domain.spacing_m;
    for (size_t i = 0; i < frame.rock.n; i++) {
        const float *P = &frame.rock.P[4 * i];
        if ((double)P[2] >= low && (double)P[2] < high)
            out.share[(int)P[1]][(int)P[0]] += (double)frame.rock.viability[i] * h * h * h / (high - low);
    }
    frame_free(&frame);
    return out;
}

/* Slots across y: where less than half of the rock is left in the mean over the first metres of x. Their middles, m. */
static size_t slots(const struct section *c, int wide, double middle[WIDE])
{
    size_t n = 0;
    int from = -1;
    for (int y = 0; y <= WIDE; y++) {
        double mean = y == WIDE ? 1 : 0;
        for (int x = 0; y < WIDE && x < wide; x++)
            mean += c->share[y][x] / wide;
        if (mean < 0.5 && from < 0)
            from = y;
        if (mean >= 0.5 && from >= 0) {
            middle[n++] = (from + y) / 2.0;
            from = -1;
        }
    }
    return n;
}

/* Parts of the section that are at least `least` square metres. */
static int parts(const struct section *c, int least)
{
    static int stack[WIDE * WIDE];
    char seen[WIDE][WIDE] = {{0}};
    int n = 0;
    for (int i = 0; i < WIDE * WIDE; i++) {
        int top = 0, size = 0;
        if (seen[i / WIDE][i % WIDE] || c->share[i / WIDE][i % WIDE] < 0.5)
            continue;
        stack[top++] = i;
        seen[i / WIDE][i % WIDE] = 1;
        while (top > 0) {
            const int at = stack[--top], y = at / WIDE, x = at % WIDE;
            const int next[4][2] = {{y, x - 1}, {y, x + 1}, {y - 1, x}, {y + 1, x}};
            size++;
            for (int k = 0; k < 4; k++) {
                const int v = next[k][0], u = next[k][1];
                if (u < 0 || v < 0 || u >= WIDE || v >= WIDE || seen[v][u] || c->share[v][u] < 0.5)
                    continue;
                seen[v][u] = 1;
                stack[top++] = v * WIDE + u;
            }
        }
        n += size >= least;
    }
    return n;
}

/* ---- fins and columns */

/* Joints of a set along x, by y: how many there are in the domain, not just at its edge, and how far apart they are. */
static size_t joints_of(const struct sim *s, double middle[WIDE])
{
    struct structure rock;
    size_t n = 0;
    assert_ok(structure_create(s->job, &rock));
    const struct joint_plan *set = &rock.joints.set[0];
    for (size_t i = set->n; i-- > 0;)
        if (-set->joint[i].at > 1 && -set->joint[i].at < WIDE - 1)
            middle[n++] = -set->joint[i].at;
    structure_destroy(&rock);
    return n;
}

static double apart(const double *middle, size_t n)
{
    assert_true(n >= 2);
    return (middle[n - 1] - middle[0]) / (double)(n - 1);
}

/* With more effort at two spacings for both seeds. */
static void fins_stand_as_far_apart_as_joints(void **state)
{
    (void)state;
    for (int seed = 1; seed <= 2; seed++)
        for (int r = 0; r < (seed == 1 || effort() > 1 ? 2 : 1); r++) {
            struct sim s = plateau(r ? 0.5 : 1, seed, 5,
                                   "wind: {abrasion: 0}\n"
                                   "joints: [{spacing_m: 5, spread: 0.15, weakened_m: 0.6, rate: 8}]\n");
            double middle[WIDE], joint[WIDE], off = 0;
            weather(&s, 5);
            const struct section c = cut(&s, 5, 8);
            const size_t n = slots(&c, WIDE, middle), there = joints_of(&s, joint);
            for (size_t i = 0; i < n && n == there; i++)
                off = fmax(off, fabs(middle[i] - joint[i]));
            print_message("# seed %d, %g m: %zu fins between slots %.2f m apart; joints are %.2f m apart, "
                          "and off by %.2f m at "
                          "most\n",
                          seed, s.job->domain.spacing_m, n + 1, apart(middle, n), apart(joint, there), off);
            assert_int_equal(n, there);
            assert_true(fabs(apart(middle, n) / apart(joint, there) - 1) < 0.15);
            assert_true(off <= 1);
            sim_end(&s);
        }
}

/* At two spacings with more effort. */
static void columns_stand_between_two_sets(void **state)
{
    (void)state;
    for (int seed = 1; seed <= 2; seed++) {
        int columns[2];
        for (int r = 0; r < (effort() > 1 ? 2 : 1); r++) {
            struct sim s =
                plateau(r ? 0.5 : 1, seed, 5,
                        "wind: {abrasion: 0}\n"
                        "joints: [{strike_deg: 20, spacing_m: 7, jitter_deg: 3, weakened_m: 0.6, rate: 8}, "
                        "{strike_deg: 105, spacing_m: 7, jitter_deg: 3, weakened_m: 0.6, rate: 8}]\n");
            weather(&s, 5);
            const struct section c = cut(&s, 5, 8);
            columns[r] = parts(&c, 4);
            print_message("# seed %d, %g m: %d columns of 4 m2 and more\n", seed, s.job->domain.spacing_m,
                          columns[r]);
            sim_end(&s);
            assert_true(columns[r] >= 5);
            assert_true(fabs((double)columns[r] / columns[0] - 1) <= 0.15);
        }
    }
}

/* ---- concretions */

/* Knobs stand on the ground where concretions reach above it, and nowhere else; as the ground goes down they come off. */
static void concretions_stand_out_and_come_off(void **state)
{
    (void)state;
    const double level = 10.6;
    for (int r = 0; r < 3; r++) {
        char text[256];
        static double e[4000][4];
        const double hard = r == 2 ? 1 : 20;
        snprintf(
            text, sizeof text,
            "wind: {abrasion: 0}\nconcretions: [{per_m3: 0.015, radius_m: 1.2, spread: 0.1, hardness: %g}]\n",
            hard);
        struct sim s = plateau(r == 1 ? 0.5 : 1, 1, 18, text);
        size_t there = 0, stand = 0, bare = 0, elsewhere = 0;
        weather(&s, 8); /* down to 10.1 m */
        const struct section c = cut(&s, level - 0.5, level + 0.5);
        const size_t n = concretions_in(s.job, 0, (const double[]){-3, -3, 8},
                                        (const double[]){WIDE + 3, WIDE + 3, 13}, e, 4000);
        for (size_t i = 0; i < n; i++) {
            const bool in = fabs(e[i][2] - level) < 0.6 && fabs(e[i][0] - WIDE / 2) < WIDE / 2 - 1 &&
                            fabs(e[i][1] - WIDE / 2) < WIDE / 2 - 1;
            there += in;
            stand += in && c.share[(int)e[i][1]][(int)e[i][0]] > 0.5;
        }
        for (int y = 1; y < WIDE - 1; y++)
            for (int x = 1; x < WIDE - 1; x++) {
                double from = 1e9;
                for (size_t i = 0; i < n; i++)
                    from = fmin(from, hypot(x + 0.5 - e[i][0], y + 0.5 - e[i][1]));
                bare += from > 3;
                elsewhere += from > 3 && c.share[y][x] > 0.3;
            }
        struct frame frame = sim_output(&s);
        const uint64_t before = frame.ledger.fallen;
        frame_free(&frame);
        weather(&s, 10); /* 2.4 m more */
        frame = sim_output(&s);
        const double fallen = (double)(frame.ledger.fallen - before) * pow(s.job->domain.spacing_m, 3);
        print_message(
            "# %g m, %g times as hard: of %zu concretions %zu stand out, and of %zu m2 elsewhere %zu; then "
            "%.0f m3 come off\n",
            s.job->domain.spacing_m, hard, there, stand, bare, elsewhere, fallen);
        frame_free(&frame);
        sim_end(&s);
        assert_true(there >= 6 && bare > 30 && elsewhere == 0);
        assert_true(r == 2 ? stand == 0 : (double)stand > 0.85 * (double)there);
        assert_true(r == 2 ? fallen == 0 : fallen > 2);
    }
}

/* ---- what joints act on */

enum { LEDGE = 14, LOW = 4 }; /* m: where an overhang begins, and how high it is */

struct done {
    double wind, water; /* m3 taken */
    double fallen;      /* m3, before anything weathers */
    double pressure;    /* near joints against far from them, likewise */
    size_t slots;       /* behind the overhang */
};

/* At the foot, behind the overhang. */
static double pressure_near(const struct sim *s, const struct frame *frame)
{
    double joint[WIDE], sum[2] = {0}, n[2] = {0};
    const size_t there = joints_of(s, joint);
    for (size_t i = 0; i < frame->rock.n; i++) {
        const float *P = &frame->rock.P[4 * i];
        double from = 1e9;
        for (size_t k = 0; k < there; k++)
            from = fmin(from, fabs((double)P[1] - joint[k]));
        if ((double)P[0] < LEDGE - 4 && P[2] > 1 && P[2] < 4 && (from < 0.7 || from > 2)) {
            sum[from > 2] += (double)frame->rock.stress[i];
            n[from > 2]++;
        }
    }
    return sum[0] / n[0] / (sum[1] / n[1]);
}

/* A plateau whose side overhangs, in wind and rain. Joints along x have this rate and stiffness; with others across they part blocks, or
 * not. */
static struct done plateau_with(double rate, double stiffness, bool blocks)
{
    char text[2048];
    struct done out = {0};
    double middle[WIDE];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: ledge\nframes: 1-5\nclock: {years_per_frame: 1500}\n"
             "domain: {size_m: [%d, %d, %d], spacing_m: 1, sides: {x_min: wall, y_min: wall, y_max: wall}}\n"
             "strata: [{weak_m_per_kyr: 0.1}]\nwind: {abrasion: 0}\n"
             "rain: {m_per_yr: 1, threshold_Pa: 0, erosion: 2}\n"
             "scene: {difference: [{box: {min_m: [-1, -1, 0], max_m: [%d, 99, %d]}}, {box: {min_m: [%d, -1, "
             "-1], max_m: "
             "[99, 99, %d]}}]}\n"
             "joints: [{spacing_m: 6, weakened_m: 1, rate: %g, stiffness: %g, blocks: %s}, {strike_deg: 90, "
             "spacing_m: 4, rate: 1, stiffness: 1, blocks: %s}]\n",
             WIDE, WIDE, HIGH + 2, WIDE - 2, HIGH, LEDGE, LOW, rate, stiffness, blocks ? "true" : "false",
             blocks ? "true" : "false");
    struct sim s = sim_begin(text);
    for (int f = 0; f < 5; f++) {
        if (f > 0)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        if (f == 0)
            out.pressure = pressure_near(&s, &frame);
        if (f == 0)
            out.fallen = WIDE * (HIGH * (WIDE - 2) - LOW * (WIDE - 2 - LEDGE)) - frame.volume_m3;
        for (size_t i = 0; i < frame.n_changes; i++) {
            const struct frame_change *change = &frame.change[i];
            out.wind -= strcmp(change->process, "deflation") == 0 ? change->m3 : 0;
            out.water -= strcmp(change->process, "water") == 0 ? change->m3 : 0;
        }
        frame_free(&frame);
    }
    const struct section c = cut(&s, 8, 10);
    out.slots = slots(&c, LEDGE - 2, middle);
    sim_end(&s);
    print_message(
        "# joints that weather %g times faster, %g as stiff%s: at first %.0f m3 fall, and they carry %.2f of "
        "what the rest does; wind takes %.0f m3, water %.0f m3; %zu slots\n",
        rate, stiffness, blocks ? ", parting blocks" : "", out.fallen, out.pressure, out.wind, out.water,
        out.slots);
    return out;
}

static void joints_move_wind_water_blocks_and_stress(void **state)
{
    (void)state;
    const struct done none = plateau_with(1, 1, false), all = plateau_with(8, 0.1, true),
                      held = plateau_with(8, 0.1, false), sound = plateau_with(1, 1, true);
    assert_true(fabs(none.fallen) < 1 && none.slots == 0);
    assert_true(all.fallen > 500 && all.slots >= 2);
    assert_true(fabs(held.fallen) < 1 && held.slots == all.slots);
    assert_true(sound.fallen == all.fallen && sound.slots == 0);
    assert_true(held.wind > 1.2 * none.wind && held.water > 1.2 * none.water);
    assert_true(all.wind > 1.2 * sound.wind && all.water > 1.2 * sound.water);
    assert_true(all.pressure < 0.85 && fabs(sound.pressure - 1) < 0.03);
}

/* MPa: the pressure T near the foot of a block under its weight, in the rock that its joints weaken and in that far from them. */
static void pressure_at_foot(double stiffness, double *joint, double *far)
{
    char text[1024];
    struct structure rock;
    double sum[2] = {0}, n[2] = {0};
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: block\nframes: 1\n"
             "domain: {size_m: [48, 4, 32], spacing_m: 1, sides: {x_min: wall, x_max: wall, y_min: wall, "
             "y_max: wall}}\n"
             "scene: {box: {min_m: [-1, -1, 0], max_m: [49, 9, 30]}}\nstress: {tolerance: 1e-4}\n"
             "joints: [{strike_deg: 90, spacing_m: 16, spread: 0, weakened_m: 4, rate: 1, blocks: false, "
             "stiffness: %g}]\n",
             stiffness);
    struct sim s = sim_begin(text);
    struct frame frame = sim_output(&s);
    assert_ok(structure_create(s.job, &rock));
    for (size_t i = 0; i < frame.rock.n; i++) {
        const float *P = &frame.rock.P[4 * i];
        double from = 1e9;
        for (size_t k = 0; k < rock.joints.set[0].n; k++)
            from = fmin(from, fabs((double)P[0] - rock.joints.set[0].joint[k].at));
        const int which = from < 1.5 ? 0 : from > 5 ? 1 : 2;
        if (which < 2 && P[2] > 2 && P[2] < 8) {
            sum[which] += 1e-6 * (double)frame.rock.stress[i];
            n[which]++;
        }
    }
    *joint = sum[0] / n[0];
    *far = sum[1] / n[1];
    print_message("# joints as stiff as %g of the rock: %.3f MPa in them, %.3f MPa far from them\n",
                  stiffness, *joint, *far);
    structure_destroy(&rock);
    frame_free(&frame);
    sim_end(&s);
}

static void soft_joints_hand_their_load_on(void **state)
{
    double joint, far;
    (void)state;
    pressure_at_foot(1, &joint, &far);
    assert_true(fabs(joint / far - 1) < 0.01);
    pressure_at_foot(0.1, &joint, &far);
    assert_true(joint < 0.6 * far);
}

/* ---- tilted beds */

/* m: where the highest rock is, over a strip along x. */
static void profile(struct sim *s, double top[64])
{
    struct frame frame = sim_output(s);
    for (int x = 0; x < 64; x++)
        top[x] = 0;
    for (size_t i = 0; i < frame.rock.n; i++) {
        const float *P = &frame.rock.P[4 * i];
        if ((double)frame.rock.viability[i] > 0.5)
            top[(int)P[0]] = fmax(top[(int)P[0]], (double)P[2] + 0.5);
    }
    frame_free(&frame);
}

/* A hard bed between soft ones, in a block that weathers from above and from both ends. Degrees: how steeply its top falls
 * towards +x, and the slope of its end at -x. */
static void cuesta(double dip, double h, double *back, double *scarp)
{
    char text[2048];
    double top[64], n = 0, sx = 0, sz = 0, xx = 0, xz = 0;
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: cuesta\nframes: 1-13\nclock: {years_per_frame: 10000}\n"
             "domain: {size_m: [64, 4, 30], spacing_m: %g, sides: {y_min: wall, y_max: wall}}\n"
             "rock: {gravity_m_s2: 0}\nwind: {abrasion: 0}\n"
             "scene: {box: {min_m: [4, -1, 0], max_m: [60, 9, 24]}}\n"
             "strata: [{to_m: 2, weak_m_per_kyr: 0}, {to_m: 11, weak_m_per_kyr: 0.1}, {to_m: 14, "
             "weak_m_per_kyr: 0.004}, {weak_m_per_kyr: 0.1}]\n"
             "attitude: {dip_deg: %g, pivot_m: [32, 2, 12]}\n",
             h, dip);
    struct sim s = sim_begin(text);
    weather(&s, 12);
    profile(&s, top);
    sim_end(&s);
    for (int x = 24; x < 44; x++) {
        n++;
        sx += x;
        sz += top[x];
        xx += x * x;
        xz += x * top[x];
    }
    *back = -atan((n * xz - sx * sz) / (n * xx - sx * sx)) * 180 / M_PI;
    *scarp = 0;
    for (int x = 1; x < 32; x++)
        *scarp = fmax(*scarp, atan2(top[x + 1] - top[x - 1], 2) * 180 / M_PI);
    print_message(
        "# beds that dip by %g degrees, at %g m: the back falls by %.1f degrees, the scarp by %.0f\n", dip, h,
        *back, *scarp);
}

static void tilted_beds_make_a_cuesta(void **state)
{
    double back, scarp;
    (void)state;
    for (int r = 0; r < (effort() > 1 ? 2 : 1); r++) {
        cuesta(12, r ? 0.5 : 1, &back, &scarp);
        assert_true(fabs(back - 12) < 1.5 && scarp > 60);
    }
    cuesta(0, 1, &back, &scarp);
    assert_true(fabs(back) < 1);
}

/* Goblins know the strata of voxels where beds are not level: a soft one that dips goes, and the one below it stays. */
static void goblins_weather_by_tilted_strata(void **state)
{
    (void)state;
    struct sim s = sim_begin(
        "hoodoo: 1\nname: goblin\nmodel: goblins\nframes: 1-9\nclock: {years_per_frame: 1000}\n"
        "domain: {size_m: [10, 9, 12], spacing_m: 0.5}\ngoblins: {threshold: 0, skin_m: 0.5}\n"
        "scene: {box: {min_m: [1, 1, 0], max_m: [9, 8, 10]}}\n"
        "attitude: {dip_deg: 30, dip_azimuth_deg: 60, pivot_m: [5, 4.5, 5]}\n"
        "strata: [{to_m: 5, weak_m_per_kyr: 0.001, bubble: {radius_m: 0.5}}, {weak_m_per_kyr: 2, bubble: "
        "{radius_m: 1}}]\n");
    int voxels[2][2] = {{0}};
    for (int end = 0; end < 2; end++) {
        for (int f = 0; end && f < 8; f++)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        for (size_t i = 0; i < frame.rock.n; i++) {
            const float *P = &frame.rock.P[4 * i];
            const double x[3] = {(double)P[0], (double)P[1], (double)P[2]};
            assert_int_equal(frame.rock.layer[i], attitude_layer(s.job, x));
            voxels[end][frame.rock.layer[i]]++;
        }
        frame_free(&frame);
    }
    sim_end(&s);
    print_message("# goblins: of %d hard and %d soft voxels, %d and %d are left\n", voxels[0][0],
                  voxels[0][1], voxels[1][0], voxels[1][1]);
    assert_true(voxels[0][1] > 500 && voxels[1][1] == 0);
    assert_true(voxels[1][0] > 0.99 * voxels[0][0]);
}

/* ---- thin beds */

static void thin_beds_retreat_alike(void **state)
{
    static const double spacing[] = {2, 1};
    (void)state;
    compare_retreats(0.1, 30, spacing, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fins_stand_as_far_apart_as_joints),
        cmocka_unit_test(columns_stand_between_two_sets),
        cmocka_unit_test(concretions_stand_out_and_come_off),
        cmocka_unit_test(joints_move_wind_water_blocks_and_stress),
        cmocka_unit_test(soft_joints_hand_their_load_on),
        cmocka_unit_test(tilted_beds_make_a_cuesta),
        cmocka_unit_test(goblins_weather_by_tilted_strata),
        cmocka_unit_test(thin_beds_retreat_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
