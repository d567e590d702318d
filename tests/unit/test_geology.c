/* The structure of rock: where beds and joints lie, what a voxel has of them, and that neither the domain nor the spacing decides. */
#include "scene_help.h"

#include "geology/attitude.h"
#include "geology/concretions.h"
#include "geology/structure.h"

/* A job in a box of rock, with more of its keys. */
static struct job *job_of(double size, double h, const char *more)
{
    struct job *job = NULL;
    char text[2000];
    snprintf(
        text, sizeof text,
        "{name: a, frames: 1, domain: {size_m: [%g, %g, %g], spacing_m: %g}, scene: {box: {min_m: [0, 0, "
        "0], max_m: [%g, %g, %g]}}, %s}",
        size, size, size, h, size, size, size, more);
    char *path = write_text("job.yaml", text);
    const status st = job_load(path, NULL, 0, &job);
    if (st != OK)
        fail_msg("%s", status_message());
    return job;
}

static double height_at(const struct job *job, double x, double y, double z)
{
    return attitude_height(job, (const double[]){x, y, z}, NULL);
}

/* ---- attitude */

static void beds_are_level_unless_the_job_says_otherwise(void **state)
{
    (void)state;
    struct job *job = job_of(40, 1, "strata_from: [{thickness_m: 2}]");
    double gradient[3];
    assert_true(attitude_is_level(job));
    assert_true(attitude_height(job, (const double[]){3, 4, 7.123456789}, gradient) == 7.123456789);
    assert_true(gradient[0] == 0 && gradient[1] == 0 && gradient[2] == 1);
    job_destroy(&job);
}

static void beds_dip_towards_their_azimuth(void **state)
{
    (void)state;
    struct job *job = job_of(
        40, 1,
        "attitude: {dip_deg: 30, dip_azimuth_deg: 90, pivot_m: [20, 20, 10]}, strata: [{to_m: 10}, {}]");
    const double down = tan(M_PI / 6);
    assert_close(height_at(job, 20, 20, 10), 10, 1e-12);
    assert_close(height_at(job, 3, 20, 10), 10, 1e-12);
    /* the bed through the pivot sinks towards +y, and what lies at one level is the higher in the pile the farther on */
    assert_close(height_at(job, 20, 30, 10 - 10 * down), 10, 1e-12);
    assert_true(height_at(job, 20, 30, 10) > 14.9);
    assert_int_equal(attitude_layer(job, (const double[]){20, 30, 10 - 10 * down + 0.01}), 1);
    assert_int_equal(attitude_layer(job, (const double[]){20, 30, 10 - 10 * down - 0.01}), 0);
    job_destroy(&job);
}

static void folds_have_their_crests_where_they_should(void **state)
{
    (void)state;
    struct job *job =
        job_of(40, 1,
               "attitude: {pivot_m: [20, 20, 0], dip_deg: 10, folds: [{wavelength_m: 24, amplitude_m: 3, "
               "axis_deg: 0, phase_deg: 90}]}");
    const double level = cos(M_PI / 18);
    /* across y: a crest at the pivot, a trough half a wavelength on; beds there lie 3 m higher, and lower */
    assert_close(height_at(job, 20, 20, 8), 8 * level - 3, 1e-12);
    assert_close(height_at(job, 20, 32, 8), 8 * level + 3, 1e-12);
    for (int i = 0; i < 50; i++) {
        const double x[3] = {3 + 0.6 * i, 31 - 0.3 * i, 5 + 0.2 * i};
        double gradient[3];
        attitude_height(job, x, gradient);
        for (int a = 0; a < 3; a++) {
            double low[3] = {x[0], x[1], x[2]}, high[3] = {x[0], x[1], x[2]};
            low[a] -= 1e-5;
            high[a] += 1e-5;
            const double slope = (attitude_height(job, high, NULL) - attitude_height(job, low, NULL)) / 2e-5;
            assert_true(fabs(slope - gradient[a]) < 1e-6);
        }
    }
    job_destroy(&job);
}

static void faults_let_the_rock_above_them_down(void **state)
{
    (void)state;
    /* along +y through x = 20, dipping to the right of that, towards +x */
    struct job *job =
        job_of(40, 1,
               "attitude: {faults: [{point_m: [20, 20, 20], strike_deg: 90, dip_deg: 60, throw_m: 5, "
               "breccia_m: 2, breccia: 5}]}");
    assert_close(height_at(job, 5, 20, 12), 12, 1e-12);
    assert_close(height_at(job, 35, 20, 12), 17, 1e-12);
    /* the plane itself: at height 10 it is 10 / tan 60 farther towards +x */
    const double at = 20 + 10 / tan(M_PI / 3);
    assert_close(height_at(job, at - 0.01, 20, 10), 10, 1e-9);
    assert_close(height_at(job, at + 0.01, 20, 10), 15, 1e-9);
    /* breccia: within a metre of the plane, and half of a cube of 4 m in its middle */
    assert_close(attitude_breccia(job, (const double[]){at, 20, 10}, 1), 5, 1e-9);
    assert_close(attitude_breccia(job, (const double[]){at, 20, 10}, 4), pow((1 + pow(5, 8)) / 2, 0.125),
                 1e-9);
    assert_close(attitude_breccia(job, (const double[]){at + 4, 20, 10}, 1), 1, 1e-9);
    job_destroy(&job);
}

static void beds_below_an_unconformity_lie_as_they_lay(void **state)
{
    (void)state;
    struct job *job = job_of(
        40, 1,
        "attitude: {pivot_m: [20, 20, 0], unconformities: [{at_m: 12, dip_deg: 20, dip_azimuth_deg: 0, "
        "eroded_m: 5}]}, strata: [{to_m: 4}, {to_m: 12}, {}]");
    const double along = tan(M_PI / 9);
    assert_close(height_at(job, 33, 7, 12.5), 12.5, 1e-12);
    /* right below it, at the pivot, 5 m of the older pile are gone; its beds sink towards +x */
    assert_close(height_at(job, 20, 20, 12), 12, 1e-12);
    assert_close(height_at(job, 20, 20, 11.999999999), 7, 1e-6);
    assert_close(height_at(job, 26, 3, 11 - 6 * along), height_at(job, 20, 3, 11), 1e-9);
    /* at the surface the oldest show where they rose, and no bed is from above it */
    assert_int_equal(attitude_layer(job, (const double[]){5, 20, 11.9}), 0);
    assert_int_equal(attitude_layer(job, (const double[]){22, 20, 11.9}), 1);
    assert_int_equal(attitude_layer(job, (const double[]){39.9, 20, 11.9}), 1);
    job_destroy(&job);
}

/* ---- beds */

static struct structure structure_of(const struct job *job)
{
    struct structure s;
    if (structure_create(job, &s) != OK)
        fail_msg("%s", status_message());
    return s;
}

static void beds_are_as_thick_and_as_hard_as_they_should(void **state)
{
    (void)state;
    struct job *job = job_of(1000, 10,
                             "strata_from: [{thickness_m: 0.1, thickness_spread: 0.5, hardness_spread: 0.6, "
                             "correlation: 0.7, rhythm_m: 3, rhythm: 0.4}]");
    struct structure s = structure_of(job);
    const struct beds *b = &s.beds;
    double t = 0, tt = 0, k = 0, kk = 0, tk = 0, n = (double)b->n;
    for (size_t i = 0; i < b->n; i++) {
        const double a = log(b->edge[i + 1] - b->edge[i]), c = log(b->hardness[i]);
        t += a / n;
        k += c / n;
        tt += a * a / n;
        kk += c * c / n;
        tk += a * c / n;
    }
    const double spread = sqrt(tt - t * t), hardness = sqrt(kk - k * k),
                 relation = (tk - t * k) / (spread * hardness);
    const double mean = (b->edge[b->n] - b->edge[0]) / n, all = b->sum[b->n] / (b->edge[b->n] - b->edge[0]);
    print_message(
        "# %zu beds, %.4f m in the mean (0.1), log thickness +- %.3f (0.5), log hardness +- %.3f (0.6), "
        "correlation %.3f (0.7), mean hardness %.4f (1)\n",
        b->n, mean, spread, hardness, relation, all);
    assert_close(mean, 0.1, 0.03);
    assert_close(spread, 0.5, 0.03);
    assert_close(hardness, 0.6, 0.03);
    assert_close(relation, 0.7, 0.03);
    assert_close(all, 1, 0.03);
    structure_destroy(&s);
    job_destroy(&job);
}

static void a_measured_section_is_laid_as_it_is(void **state)
{
    (void)state;
    struct job *job = job_of(40, 1, "strata_from: [{from_m: 10, column: [[2, 3], [0.5, 0.5], [4, 1]]}]");
    struct structure s = structure_of(job);
    static const double at[] = {9, 11, 12.25, 14, 30}, hardness[] = {1, 3, 0.5, 1, 1};
    for (size_t i = 0; i < 5; i++)
        assert_close(structure_at(&s, (const double[]){20, 20, at[i]}, 0.4).rate, 1 / hardness[i], 1e-9);
    structure_destroy(&s);
    job_destroy(&job);
}

/* How long a front takes down through all beds, by voxels of any size, is what it takes through each of them. */
static void time_across_beds_is_the_same_at_any_spacing(void **state)
{
    (void)state;
    const char *const beds =
        "attitude: {dip_deg: 25, dip_azimuth_deg: 40}, strata_from: [{from_m: -3, to_m: 30, "
        "thickness_m: 0.07, hardness_spread: 0.8, parting_m: 0.01, markers: [{at_m: 12, "
        "thickness_m: 0.3, hardness: 20}]}]";
    double time[4];
    for (int r = 0; r < 4; r++) {
        const double h = 2 / pow(2, r);
        struct job *job = job_of(40, h, beds);
        struct structure s = structure_of(job);
        double up[3];
        attitude_up(job, up);
        time[r] = 0;
        for (double d = -12 + h / 2; d < 12; d += h) {
            const double x[3] = {20 + d * up[0], 20 + d * up[1], 20 + d * up[2]};
            time[r] += h / structure_at(&s, x, h).rate;
        }
        assert_close(time[r], time[0], 1e-9);
        structure_destroy(&s);
        job_destroy(&job);
    }
    print_message("# 24 m across 340 beds take as long as %.3f m of their stratum, at 2, 1, 0.5 and 0.25 m\n",
                  time[0]);
    assert_true(time[0] > 25); /* the marker alone is 6 m more */
}

static void soft_beds_lead_along_them(void **state)
{
    (void)state;
    struct job *job =
        job_of(40, 1,
               "strata_from: [{from_m: 0, to_m: 10, thickness_m: 4, hardness_spread: 0, markers: [{at_m: 5, "
               "thickness_m: 0.1, hardness: 0.25}]}]");
    struct structure s = structure_of(job);
    const struct structure_rock one = structure_at(&s, (const double[]){20, 20, 5}, 1),
                                other = structure_at(&s, (const double[]){20, 20, 8}, 1);
    assert_close(one.rate, 1 / (0.9 + 0.1 * 0.25), 1e-9);
    assert_close(one.rate * one.along, pow(0.9 + 0.1 * pow(4, 8), 1.0 / 8), 1e-9);
    assert_close(other.rate, 1, 1e-9);
    assert_close(other.along, 1, 1e-9);
    structure_destroy(&s);
    job_destroy(&job);
}

static void laminae_dip_as_they_should(void **state)
{
    (void)state;
    struct job *job = job_of(
        40, 0.05,
        "strata_from: [{from_m: 0, hardness_spread: 0, cross: {set_m: 5, foreset_deg: 30, azimuth_deg: "
        "180, azimuth_spread_deg: 0, lamina_m: 1, spread: 0.5}}]");
    struct structure s = structure_of(job);
    int same = 0, other = 0;
    for (int i = 0; i < 200; i++) {
        const double x[3] = {10 + 0.1 * i, 20, 7.5}, along = 0.8;
        const double down[3] = {x[0] - along * cos(M_PI / 6), x[1], x[2] - along * sin(M_PI / 6)};
        const double level[3] = {x[0] - along, x[1], x[2]};
        same += structure_at(&s, x, 0.05).rate == structure_at(&s, down, 0.05).rate;
        other += structure_at(&s, x, 0.05).rate == structure_at(&s, level, 0.05).rate;
    }
    print_message("# down the foresets rates are the same at %d of 200 places, on the level at %d\n", same,
                  other);
    assert_true(same > 185 && other < 130);
    structure_destroy(&s);
    job_destroy(&job);
}

/* ---- joints */

static void joints_are_as_far_apart_as_they_should(void **state)
{
    (void)state;
    struct job *job =
        job_of(1000, 10, "joints: [{strike_deg: 90, spacing_m: 2, spread: 0.3, persistence: 1}]");
    struct structure s = structure_of(job);
    const struct joint_plan *set = &s.joints.set[0];
    double sum = 0, square = 0;
    for (size_t i = 1; i < set->n; i++) {
        const double gap = log(set->joint[i].at - set->joint[i - 1].at);
        sum += gap / (double)(set->n - 1);
        square += gap * gap / (double)(set->n - 1);
    }
    const double mean = (set->joint[set->n - 1].at - set->joint[0].at) / (double)(set->n - 1),
                 spread = sqrt(square - sum * sum);
    print_message("# %zu joints, %.3f m apart (2), log +- %.3f (0.3)\n", set->n, mean, spread);
    assert_close(mean, 2, 0.05);
    assert_close(spread, 0.3, 0.08);
    /* Along a line across them each is passed once. */
    int passed = 0;
    for (int i = 0; i < 100000; i++)
        passed += joints_between(&s.joints, (const double[]){0.01 * i, 3, 3},
                                 (const double[]){0.01 * (i + 1), 3, 3});
    int there = 0;
    for (size_t i = 0; i < set->n; i++)
        there += set->joint[i].at > 0 && set->joint[i].at < 1000;
    assert_int_equal(passed, there);
    structure_destroy(&s);
    job_destroy(&job);
}

/* How joints speed a front up that runs along them, in a piece of rock in all, does not depend on the voxels it is cut into. */
static void joints_lead_alike_at_any_spacing(void **state)
{
    (void)state;
    static const char *const sets[] = {
        "joints: [{strike_deg: 90, spacing_m: 6, weakened_m: 0.2, rate: 9}]",
        "joints: [{strike_deg: 90, spacing_m: 6, weakened_m: 3, rate: 9, persistence: 0.5, length_m: 8}]"};
    for (size_t c = 0; c < 2; c++) {
        double more[3];
        for (int r = 0; r < 3; r++) {
            const double h = 2 / pow(2, r);
            const int n = (int)(40 / h);
            struct job *job = job_of(40, h, sets[c]);
            struct structure s = structure_of(job);
            more[r] = 0;
            for (int i = 0; i < n * n * n; i++) {
                const double x[3] = {(i % n + 0.5) * h, (i / n % n + 0.5) * h, (i / n / n + 0.5) * h};
                more[r] += pow(structure_at(&s, x, h).rate, 8) / (n * n * n);
            }
            more[r] = pow(more[r], 0.125);
            structure_destroy(&s);
            job_destroy(&job);
        }
        print_message("# joints lead at %.3f, %.3f and %.3f times the common rate, at 2, 1 and 0.5 m\n",
                      more[0], more[1], more[2]);
        assert_true(more[0] > 4);
        assert_close(more[1], more[0], 0.02);
        assert_close(more[2], more[1], 0.02);
    }
}

/* ---- both */

/* ---- concretions */

/* As many and as large as they should be, and as much of the rock whatever voxels it is cut into. */
static void concretions_are_as_many_as_they_should(void **state)
{
    (void)state;
    enum { MOST = 20000 };
    static double e[MOST][4];
    struct job *job =
        job_of(40, 1,
               "attitude: {dip_deg: 30}, concretions: [{per_m3: 0.05, radius_m: 0.7, spread: 0.3, "
               "flatten: 2, hardness: 5}]");
    const size_t n = concretions_in(job, 0, (const double[]){0, 0, 0}, (const double[]){40, 40, 40}, e, MOST);
    double sum = 0, square = 0, volume = 0;
    for (size_t i = 0; i < n; i++) {
        const double z = log(e[i][3] / 0.7);
        sum += z / (double)n;
        square += z * z / (double)n;
        volume += 4 * M_PI / 3 * pow(e[i][3], 3) / 2 / 64000;
    }
    print_message("# %zu concretions (3200), log radius %.3f +- %.3f (0, 0.27), %.3f of the rock\n", n, sum,
                  sqrt(square), volume);
    assert_true(fabs((double)n / 3200 - 1) < 0.05);
    assert_true(fabs(sum) < 0.02 && fabs(sqrt(square) - 0.27) < 0.02); /* cut off at two of 0.3 */
    double share_at[3];
    for (int r = 0; r < 3; r++) {
        const double h = 2 / pow(2, r);
        const int cells = (int)(20 / h);
        double share = 0;
        for (int i = 0; i < cells * cells * cells; i++) {
            const double x[3] = {10 + (i % cells + 0.5) * h, 10 + (i / cells % cells + 0.5) * h,
                                 10 + (i / cells / cells + 0.5) * h};
            share += (concretions_hardness(job, x, x[2], h) - 1) / 4 / pow(cells, 3);
        }
        share_at[r] = share;
        print_message("# %g m: %.4f of the rock\n", h, share);
        assert_true(fabs(share / share_at[0] - 1) < 0.05 && fabs(share / volume - 1) < 0.2);
    }
    job_destroy(&job);
}

static void the_domain_decides_nothing(void **state)
{
    (void)state;
    const char *const text = "attitude: {dip_deg: 20, pivot_m: [5, 5, 5], faults: [{point_m: [9, 9, 9], "
                             "throw_m: 3, breccia_m: 1}]}, "
                             "strata_from: [{thickness_m: 0.4, cross: {set_m: 3, trough_m: 9}}], joints: "
                             "[{spacing_m: 4, jitter_deg: 6, "
                             "persistence: 0.6}, {strike_deg: 70, dip_deg: 75, spacing_m: 3}]";
    struct job *small = job_of(16, 0.5, text), *large = job_of(64, 0.5, text);
    struct structure a = structure_of(small), b = structure_of(large);
    uint32_t random = 3;
    for (int i = 0; i < 3000; i++) {
        double x[3];
        for (int c = 0; c < 3; c++)
            x[c] = next_random(&random) % 16000 * 1e-3;
        const struct structure_rock p = structure_at(&a, x, 0.5), q = structure_at(&b, x, 0.5);
        assert_close(p.rate, q.rate, 1e-9);
        assert_close(p.along, q.along, 1e-9);
        const double y[3] = {x[0] + 0.5, x[1], x[2]};
        assert_int_equal(joints_between(&a.joints, x, y), joints_between(&b.joints, x, y));
    }
    structure_destroy(&a);
    structure_destroy(&b);
    job_destroy(&small);
    job_destroy(&large);
}

/* Particles and voxels have what structure says, of their voxel. */
static void rock_has_its_structure(void **state)
{
    (void)state;
    struct job *job =
        job_of(16, 1,
               "attitude: {dip_deg: 20}, strata: [{to_m: 7}, {to_m: 9}, {}], strata_from: [{}], joints: "
               "[{spacing_m: 4, interlock: 0.5}]");
    struct structure s = structure_of(job);
    struct rock rock;
    enum { N = 16 * 16 * 16 };
    static float share[N], factor[N];
    int layers[3] = {0}, weaker = 0;
    assert_int_equal(scene_sample(job, &rock), OK);
    assert_int_equal(scene_grid(job, false, share, factor), OK);
    assert_int_equal(rock.n, N);
    for (size_t i = 0; i < rock.n; i++) {
        const double middle[3] = {(double)(i % 16) + 0.5, (double)(i / 16 % 16) + 0.5,
                                  (double)(i / 256) + 0.5};
        const double x[3] = {(double)rock.P[4 * i], (double)rock.P[4 * i + 1], (double)rock.P[4 * i + 2]};
        const struct structure_rock built = structure_at(&s, middle, 1);
        assert_true(rock.rate_factor[i] == (float)built.rate && factor[i] == (float)built.rate);
        assert_true(rock.interlock_factor[i] == (float)built.interlock);
        assert_int_equal(rock.layer[i], attitude_layer(job, x));
        layers[rock.layer[i]]++;
        weaker += built.interlock < 1;
    }
    assert_true(layers[0] > 500 && layers[1] > 200 && layers[2] > 500 && weaker > 500);
    rock_free(&rock);
    structure_destroy(&s);
    job_destroy(&job);
}

/* Jobs of before these keys keep their hash, and with it their frames. */
static void what_says_nothing_leaves_the_hash(void **state)
{
    (void)state;
    static const char *const text[] = {
        "seed: 1",
        "attitude: {dip_deg: 0, folds: []}, strata_from: [], joints: [], concretions: []",
        "attitude: {dip_deg: 1}",
        "strata_from: [{}]",
        "joints: [{}]",
        "concretions: [{}]"};
    uint64_t hash[6];
    for (size_t i = 0; i < 6; i++) {
        struct job *job = job_of(8, 1, text[i]);
        assert_int_equal(job_hash(job, &hash[i]), OK);
        job_destroy(&job);
        for (size_t k = 0; k < i; k++)
            assert_true((hash[i] == hash[k]) == (i == 1));
    }
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *word, *other;
    } wrong[] = {
        {"strata_from: [{from_m: 5, to_m: 4}]", "strata_from.0.to_m", "not above from_m"},
        {"strata_from: [{to_m: 5}, {from_m: 4}]", "strata_from.1.from_m", "within the beds before"},
        {"strata_from: [{markers: [{at_m: 1, thickness_m: 2}, {at_m: 2}]}]", "strata_from.0.markers.1.at_m",
         "within the marker below"},
        {"attitude: {unconformities: [{at_m: 3}, {at_m: 2}]}", "attitude.unconformities.1.at_m", "not above"},
        {"joints: [{from_m: 1, to_m: 1}]", "joints.0.to_m", "not above from_m"},
        {"concretions: [{from_m: 2, to_m: 1}]", "concretions.0.to_m", "not above from_m"},
        {"edits: [{frame: 1, set: {attitude.dip_deg: 3}}]", "attitude", "edit"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct job *job = NULL;
        char text[600];
        snprintf(
            text, sizeof text,
            "{name: a, frames: 1, domain: {size_m: [8, 8, 8], spacing_m: 1}, scene: {box: {min_m: [0, 0, 0], "
            "max_m: [8, 8, 8]}}, %s}",
            wrong[i].text);
        assert_failed(job_load(write_text("job.yaml", text), NULL, 0, &job), E_USAGE, wrong[i].word,
                      wrong[i].other);
    }
    struct job *job = job_of(8, 1, "strata_from: [{from_m: -1e5, thickness_m: 0.001}]");
    struct structure s;
    assert_failed(structure_create(job, &s), E_USAGE, "strata_from", "thickness_m");
    job_destroy(&job);
    job = job_of(8, 1, "concretions: [{per_m3: 1000, radius_m: 1}]");
    assert_failed(structure_create(job, &s), E_USAGE, "concretions.0", "per_m3");
    job_destroy(&job);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(beds_are_level_unless_the_job_says_otherwise),
        cmocka_unit_test(beds_dip_towards_their_azimuth),
        cmocka_unit_test(folds_have_their_crests_where_they_should),
        cmocka_unit_test(faults_let_the_rock_above_them_down),
        cmocka_unit_test(beds_below_an_unconformity_lie_as_they_lay),
        cmocka_unit_test(a_measured_section_is_laid_as_it_is),
        cmocka_unit_test(beds_are_as_thick_and_as_hard_as_they_should),
        cmocka_unit_test(time_across_beds_is_the_same_at_any_spacing),
        cmocka_unit_test(soft_beds_lead_along_them),
        cmocka_unit_test(laminae_dip_as_they_should),
        cmocka_unit_test(joints_are_as_far_apart_as_they_should),
        cmocka_unit_test(joints_lead_alike_at_any_spacing),
        cmocka_unit_test(concretions_are_as_many_as_they_should),
        cmocka_unit_test(the_domain_decides_nothing),
        cmocka_unit_test(rock_has_its_structure),
        cmocka_unit_test(what_says_nothing_leaves_the_hash),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
