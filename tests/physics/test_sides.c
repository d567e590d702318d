/* The domain's sides: behind a wall the rock goes on as its own mirror image, for every process and model. */
#include "model_help.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "model/arenite.h"
#include "surface.h"
#include "water_help.h"

static struct sim begin(const char *format, ...)
{
    char text[4096];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return sim_begin(text);
}

/* ---- half of a scene, and the whole of it */

enum { ACROSS = 24, DEEP = 12, HIGH = 12, HALF = ACROSS / 2 };

/* What a frame says of the low half's voxels. */
struct half {
    double left[HIGH][DEEP][HALF], stress[HIGH][DEEP][HALF], volume;
};

static void half_of(const struct frame *frame, struct half *out)
{
    *out = (struct half){0};
    for (size_t i = 0; i < frame->rock.n; i++) {
        int v[3];
        for (size_t a = 0; a < 3; a++)
            v[a] = (int)floor((double)frame->rock.P[4 * i + a]);
        out->volume += (double)frame->rock.viability[i];
        if (v[0] >= HALF)
            continue;
        out->left[v[2]][v[1]][v[0]] = (double)frame->rock.viability[i];
        out->stress[v[2]][v[1]][v[0]] = frame->rock.stress ? (double)frame->rock.stress[i] : 0;
    }
}

/* Largest differences between two; that of stress as a share of the largest there is. */
static void compare(const struct half *a, const struct half *b, double *left, double *stress)
{
    double most = 0;
    *left = *stress = 0;
    for (int z = 0; z < HIGH; z++)
        for (int y = 0; y < DEEP; y++)
            for (int x = 0; x < HALF; x++) {
                *left = fmax(*left, fabs(a->left[z][y][x] - b->left[z][y][x]));
                *stress = fmax(*stress, fabs(a->stress[z][y][x] - b->stress[z][y][x]));
                most = fmax(most, fabs(a->stress[z][y][x]));
            }
    *stress /= most > 0 ? most : 1;
}

/* A thick arch across the domain's middle, in a wind along it. */
static const char ARCH[] = "hoodoo: 1\nname: half\nmodel: %s\nframes: 1-100\nclock: {years_per_frame: 500}\n"
                           "domain: {size_m: [%d, 12, 12], spacing_m: 1, sides: {x_max: %s}}\n"
                           "scene:\n"
                           "  difference:\n"
                           "    - box: {min_m: [3, 2, 0], max_m: [21, 10, 11]}\n"
                           "    - box: {min_m: [8, -1, -1], max_m: [16, 13, 5]}\n"
                           "rock: {interlock_band: 0.5}\n"
                           "strata: [{weak_m_per_kyr: 0.8, strong_m_per_kyr: 0.01, interlock_MPa: 0.25, "
                           "bubble: {radius_m: 3}}]\n"
                           "stress: {tolerance: 1e-5}\n"
                           "wind: {direction: [0, 1, 0.1], abrasion: 0.5}\n";

/* The same state with the low half's particles mirrored in the high half, so that the two are exactly alike. */
static void make_symmetric(struct sim *s)
{
    struct checkpoint saved = {0};
    static float place[HIGH][DEEP][ACROSS][3];
    assert_ok(model_save(s->model, &saved));
    const struct checkpoint_section *P = checkpoint_find(&saved, "P", 4);
    assert_non_null(P);
    float *x = P->data;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < P->n / 4; i++) {
            float *p = x + 4 * i;
            int v[3] = {(int)p[0], (int)p[1], (int)p[2]};
            if (pass == 0) {
                memcpy(place[v[2]][v[1]][v[0]], p, 12);
            } else if (v[0] >= HALF) {
                memcpy(p, place[v[2]][v[1]][ACROSS - 1 - v[0]], 12);
                p[0] = (float)ACROSS - p[0];
            }
        }
    model_destroy(&s->model);
    assert_ok(model_create(s->gpu, s->job, &saved, &s->model));
    checkpoint_free(&saved);
}

static void half_is_half(const char *model, double left_off, double stress_off)
{
    static struct half whole, half;
    struct sim a = begin(ARCH, model, ACROSS, "open"), b = begin(ARCH, model, HALF, "wall");
    double left, stress, start = 0;
    const bool particles = strcmp(model, "arenite") == 0;
    if (particles)
        make_symmetric(&a);
    for (int f = 0; f < 6; f++) {
        struct frame was = sim_output(&a), is = sim_output(&b);
        half_of(&was, &whole);
        half_of(&is, &half);
        compare(&whole, &half, &left, &stress);
        start = f ? start : whole.volume;
        print_message("# %s, frame %d: %.4f m3 and twice %.4f; largest difference of a voxel %.2g, of its "
                      "stress %.2g\n",
                      model, f, whole.volume, half.volume, left, stress);
        assert_true(left <= left_off);
        assert_true(!particles || stress <= stress_off);
        assert_true(fabs(whole.volume / (2 * half.volume) - 1) <= left_off);
        frame_free(&was);
        frame_free(&is);
        assert_ok(model_step(a.model));
        assert_ok(model_step(b.model));
    }
    assert_true(whole.volume < 0.9 * start);
    sim_end(&a);
    sim_end(&b);
}

static void half_an_arch_is_half_the_arch(void **state)
{
    (void)state;
    half_is_half("arenite", 2e-3, 1e-2);
}

static void half_a_goblin_is_half_the_goblin(void **state)
{
    (void)state;
    half_is_half("goblins", 0, 0);
}

/* ---- a plateau that goes on */

static const char PLATEAU[] =
    "hoodoo: 1\nname: plateau\nframes: 1-100\nclock: {years_per_frame: 500}\n"
    "domain: {size_m: [16, 16, 10], spacing_m: 1, sides: {x_min: %s, x_max: %s, y_min: "
    "%s, y_max: %s}}\n"
    "scene: {box: {min_m: [-1, -1, -1], max_m: [17, 17, 6]}}\n"
    "strata: [{weak_m_per_kyr: 0.5, strong_m_per_kyr: 0.5}]\n"
    "wind: {direction: [1, 0.3, -0.5], abrasion: 0.5}\n%s";

static struct sim plateau(const char *side, const char *more)
{
    return begin(PLATEAU, side, side, side, side, more);
}

/* Mean height of the columns at the sides, or of those two or more away from them. */
static double height(const struct frame *frame, bool sides)
{
    double sum = 0;
    for (size_t i = 0; i < frame->rock.n; i++) {
        int x = (int)frame->rock.P[4 * i], y = (int)frame->rock.P[4 * i + 1];
        bool at = x == 0 || x == 15 || y == 0 || y == 15, near = x <= 1 || x >= 14 || y <= 1 || y >= 14;
        sum += (sides ? at : !near) ? (double)frame->rock.viability[i] : 0;
    }
    return sum / (sides ? 60 : 12 * 12);
}

static void a_plateau_lowers_as_one(void **state)
{
    struct sim s = plateau("wall", "");
    (void)state;
    for (int f = 0; f < 4; f++)
        assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    size_t faces = 0, weathered = 0;
    double upright[2] = {0}, bare_at[2] = {0};
    for (size_t i = 0; i < frame.rock.n; i++) {
        const float *n = frame.rock.N + 4 * i;
        bool bare = n[0] != 0 || n[1] != 0 || n[2] != 0, deep = (double)frame.rock.P[4 * i + 2] < 4;
        faces += deep && bare;
        weathered += deep && (double)frame.rock.viability[i] < 1;
        int x = (int)frame.rock.P[4 * i], y = (int)frame.rock.P[4 * i + 1];
        bool side = x == 0 || x == 15 || y == 0 || y == 15;
        upright[side] += bare ? (double)n[2] : 0;
        bare_at[side] += bare;
    }
    double at = height(&frame, true), far = height(&frame, false);
    const struct surface surface = surface_of(&frame);
    const double down[3] = {0, 0, 1};
    double edge = surface_reach(&surface, (const double[]){0.5, 0.5, 2.5}, down),
           middle = surface_reach(&surface, (const double[]){8, 8, 2.5}, down),
           end = surface_reach(&surface, (const double[]){8, 8, 2.5}, (const double[]){-1, 0, 0});
    print_message(
        "# 6 m of rock are %.3f m at the walls, %.3f m away from them; the surface is %.3f and %.3f m high, "
        "and cut "
        "off at x = %.3f m; normals' mean z is %.3f and %.3f; %zu faces and %zu weathered particles below\n",
        at, far, 2.5 + edge, 2.5 + middle, 8 - end, upright[1] / bare_at[1], upright[0] / bare_at[0], faces,
        weathered);
    assert_int_equal(faces, 0);
    assert_int_equal(weathered, 0);
    assert_true(far > 4.5 && far < 5.2);
    assert_true(fabs(at / far - 1) < 0.01);
    assert_true(fabs(edge - middle) < 0.15);
    assert_true(fabs(8 - end) < 0.02);
    assert_true(fabs(upright[1] / bare_at[1] - upright[0] / bare_at[0]) < 0.03);
    frame_free(&frame);
    sim_end(&s);
    /* Open sides are faces, and retreat. */
    s = plateau("open", "");
    for (int f = 0; f < 4; f++)
        assert_ok(model_step(s.model));
    frame = sim_output(&s);
    assert_true(height(&frame, true) < 0.8 * far);
    frame_free(&frame);
    sim_end(&s);
}

/* Of a plateau between walls each cell of the stress grid carries what is above it, and nothing pulls sideways. */
static void a_plateau_is_pressed_from_all_sides(void **state)
{
    struct sim s = plateau("wall", "stress: {tolerance: 1e-5}\n");
    const double weight = 2300 * 9.81, lambda = 12, mu = 15;
    double worst = 0;
    (void)state;
    struct frame frame = sim_output(&s);
    for (size_t i = 0; i < frame.rock.n; i++) {
        /* Uniaxial strain: sigma_x = sigma_z lambda / (lambda + 2 mu). */
        double down = weight * (6 - (double)frame.rock.P[4 * i + 2]),
               expected = down * (1 + 2 * lambda / (lambda + 2 * mu));
        worst = fmax(worst, fabs((double)frame.rock.stress[i] - expected));
    }
    worst /= weight * 6 * (1 + 2 * lambda / (lambda + 2 * mu));
    print_message("# a plateau between walls has the stress of a half-space to within %.2g of its largest\n",
                  worst);
    assert_true(worst < 0.02);
    frame_free(&frame);
    sim_end(&s);
}

static void what_erodes_stays_between_walls(void **state)
{
    static const char *const side[] = {"wall", "open"};
    uint64_t left[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct sim s = plateau(side[k], "deposition: {viability: 1, fines: 0, bulking: 1}\npaint:\n  - "
                                        "{shape: {box: {min_m: [-1, -1, -1], max_m: [17, 17, "
                                        "5]}}, inert: true}\n");
        for (int f = 0; f < 4; f++)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        left[k] = frame.ledger.left;
        print_message("# %s: of %llu particles %llu are rock, %llu deposit, %llu left\n", side[k],
                      (unsigned long long)frame.ledger.start, (unsigned long long)frame.ledger.rock,
                      (unsigned long long)frame.ledger.deposit, (unsigned long long)frame.ledger.left);
        assert_true(k == 1 || frame.ledger.deposit > 0);
        frame_free(&frame);
        sim_end(&s);
    }
    assert_int_equal(left[0], 0);
    assert_true(left[1] > 0);
}

/* ---- water */

static float slope(const struct scene *s, int i, int j, int k)
{
    double top = 3 + 0.25 * (s->n[0] - 1 - i) + 0.3 * unit(s->seed, (uint32_t)(j * 100 + i));
    return (float)fmin(fmax(top - k, 0), 1);
}

static void water_leaves_by_open_sides_alone(void **state)
{
    double rain = 1;
    struct job job;
    struct gpu *gpu = open_gpu();
    (void)state;
    job_of_rain(&job, &rain);
    for (uint32_t seed = 1; seed <= 8; seed++) {
        /* The last has no side that is open. */
        const bool shut = seed == 8;
        const struct scene scene = {{22, 16, 14}, seed};
        struct bed bed = bed_of(gpu, &scene, 1, slope);
        const struct water_routing how = {.seed = seed, .frame = 1};
        struct water w = {0};
        uint64_t out[4] = {0}, stored = 0;
        job.domain.sides = (struct job_sides){.x_min = SIDE_X_MIN_WALL,
                                              .x_max = shut ? SIDE_X_MAX_WALL : SIDE_X_MAX_OPEN,
                                              .y_min = SIDE_Y_MIN_WALL,
                                              .y_max = SIDE_Y_MAX_WALL};
        bed.p.walls = job_walls(&job);
        assert_ok(water_create(gpu, &job, bed.n, bed.h, 1, &w));
        assert_ok(water_route(gpu, bed.work, &w, &how, &bed.p));
        assert_ok(water_discharge(gpu, bed.work, &w, &job, 1, &bed.p));
        const uint64_t fallen = 22 * 16 * (uint64_t)w.rain_units;
        uint32_t *cell = calloc(w.n_nodes + 1, 4), *sum = calloc(w.n_nodes + 1, 4),
                 *final = calloc(w.n_nodes + 2, 4);
        assert_ok(gpu_download(gpu, w.node[WATER_CELL], 0, cell, w.n_nodes));
        assert_ok(gpu_download(gpu, w.node[WATER_RAIN], 0, sum, w.n_nodes));
        assert_ok(gpu_download(gpu, w.node[WATER_FINAL], 0, final, w.n_nodes));
        for (size_t i = 0; i < w.n_nodes; i++) {
            int x = (int)cell[i] % w.cells[0], y = (int)cell[i] / w.cells[0] % w.cells[1];
            int side = x == 0 ? 0 : x == w.cells[0] - 1 ? 1 : y == 0 ? 2 : 3;
            if (final[i] == w.n_nodes)
                out[side] += sum[i];
            else if (final[i] == i)
                stored += sum[i];
        }
        print_message("# seed %u: %llu units of rain, of which %llu, %llu, %llu and %llu leave at the four "
                      "sides, %llu stay\n",
                      (unsigned)seed, (unsigned long long)fallen, (unsigned long long)out[0],
                      (unsigned long long)out[1], (unsigned long long)out[2], (unsigned long long)out[3],
                      (unsigned long long)stored);
        assert_int_equal(out[0] + out[2] + out[3], 0);
        assert_int_equal(out[1], shut ? 0 : fallen);
        assert_int_equal(out[1] + stored, fallen);
        free(cell);
        free(sum);
        free(final);
        water_destroy(gpu, &w);
        bed_free(&bed);
    }
    gpu_destroy(&gpu);
}

/* ---- rock that moves */

static void grains_stay_between_walls(void **state)
{
    static const char *const side[] = {"wall", "open"};
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct sim s = begin("hoodoo: 1\nname: grains\nframes: 1-100\nclock: {seconds_per_frame: 0.0416667}\n"
                             "domain: {size_m: [10, 6, 8], spacing_m: 1, sides: {x_min: %s, x_max: %s, "
                             "y_min: %s, y_max: %s}}\n"
                             "scene: {union: [box: {min_m: [0, 0, 2], max_m: [4, 6, 8]}, box: {min_m: [9, 0, "
                             "0], max_m: [10, 6, 1]}]}\n"
                             "collapse: {strength_MPa: 0, wave_m_s: 60}\n",
                             side[k], side[k], side[k], side[k]);
        double farthest = 0;
        for (int f = 0; f < 30; f++)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        for (size_t i = 0; i < frame.rock.n; i++)
            farthest = fmax(farthest, frame.rock.id[i] >= 6 ? (double)frame.rock.P[4 * i] : 0);
        print_message("# a column of grains, sides %s: %llu of %llu left, the farthest is at x = %.1f m\n",
                      side[k], (unsigned long long)frame.ledger.left, (unsigned long long)frame.ledger.start,
                      farthest);
        assert_true((frame.ledger.left == 0) == (k == 0));
        frame_free(&frame);
        sim_end(&s);
    }
}

/* What is not there yet is refused by name. */
static void air_that_flows_knows_no_walls(void **state)
{
    static const char *const sets[] = {"wind.flow.solver=sph"};
    struct job *job = NULL;
    FILE *f = fopen("plateau.yaml", "w");
    (void)state;
    assert_non_null(f);
    fprintf(f, PLATEAU, "open", "open", "wall", "open", "");
    assert_int_equal(fclose(f), 0);
    assert_int_equal(job_load("plateau.yaml", sets, 1, &job), E_USAGE);
    print_message("# %s\n", status_message());
    assert_non_null(strstr(status_message(), "wind.flow.solver"));
    assert_non_null(strstr(status_message(), "domain.sides.y_min"));
    assert_null(job);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_an_arch_is_half_the_arch),
        cmocka_unit_test(half_a_goblin_is_half_the_goblin),
        cmocka_unit_test(a_plateau_lowers_as_one),
        cmocka_unit_test(a_plateau_is_pressed_from_all_sides),
        cmocka_unit_test(what_erodes_stays_between_walls),
        cmocka_unit_test(water_leaves_by_open_sides_alone),
        cmocka_unit_test(grains_stay_between_walls),
        cmocka_unit_test(air_that_flows_knows_no_walls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
