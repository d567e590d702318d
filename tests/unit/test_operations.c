/* The tools that make terrain: what each takes and leaves, how far it reaches, and how little memory large
 * terrain takes. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/random.h"
#include "effort.h"
#include "stacks/operations.h"
#include "stacks/stabilise.h"

static const struct material table[] = {{"air", 90, 0, {0}},
                                        {"bedrock", 90, 1, {0}},
                                        {"sand", 32, 1, {0}},
                                        {"rock", 42, 1, {0}},
                                        {"water", 0, 0, {0}}};
enum { N_TABLE = 5 };

/* Smooth and wavy: what noise is for here. */
static double waves(const void *user, double scale, double flatten, const double x[3])
{
    (void)user;
    return 1.2 * sin(5 * x[0] / scale) * sin(4.3 * x[1] / scale + 1) * sin(4.7 * flatten * x[2] / scale + 2);
}

static struct job_operation tool(int which, double (*points)[4], size_t n)
{
    static char none[] = "";
    struct job_operation op = {.tool = which,
                               .frames = {1, 1, 1},
                               .points_m = points,
                               .n_points_m = n,
                               .travel = true,
                               .strength = 1,
                               .delta = 0.5,
                               .thickness_m = 1,
                               .rocks = 0.5,
                               .depth = DEPTH_DEEP,
                               .scale_m = 5,
                               .flatten = 1};
    op.material = none;
    return op;
}

static void apply(struct stacks *s, const struct job_operation *op, int frame, int lo[2], int hi[2])
{
    struct tools tools = {table, N_TABLE, s->cell, waves, NULL};
    assert_ok(operation_apply(s, &tools, op, "arches.operations.0", frame, lo, hi));
}

struct put {
    uint32_t lo, hi, material;
};

static status put_one(void *user, int i, int j, struct column *c)
{
    const struct put *p = user;
    (void)i, (void)j;
    return column_set(c, p->lo, p->hi, p->material);
}

static void put(struct stacks *s, int i0, int j0, int i1, int j1, double lo, double hi, uint32_t material)
{
    struct put p = {stacks_quanta(s, lo), stacks_quanta(s, hi), material};
    assert_ok(stacks_edit(s, (const int[]){i0, j0}, (const int[]){i1, j1}, put_one, &p));
}

static struct stacks block(int nx, int ny, double height, double top)
{
    struct stacks s;
    assert_ok(stacks_create((const int[]){nx, ny}, 1, height, &s));
    put(&s, 0, 0, nx - 1, ny - 1, 0, top, MATERIAL_BEDROCK);
    return s;
}

static double volume(const struct stacks *s, int material)
{
    uint64_t amount[MATERIALS_MAX];
    stacks_amounts(s, amount);
    return (double)amount[material] * s->quantum * s->cell * s->cell;
}

/* The stacks that differ lie within lo..hi, and within `reach` of a segment seen from above. */
static void check_reach(const struct stacks *a, const struct stacks *b, const int lo[2], const int hi[2],
                        const double from[4], const double to[4], double reach)
{
    int changed = 0;
    for (int j = 0; j < a->n[1]; j++)
        for (int i = 0; i < a->n[0]; i++) {
            size_t na, nb;
            const uint32_t *la = stacks_column(a, i, j, &na), *lb = stacks_column(b, i, j, &nb);
            if (na == nb && (na == 0 || memcmp(la, lb, na * sizeof *la) == 0))
                continue;
            changed++;
            assert_true(i >= lo[0] && i <= hi[0] && j >= lo[1] && j <= hi[1]);
            double d[2] = {to[0] - from[0], to[1] - from[1]}, x = i + 0.5 - from[0], y = j + 0.5 - from[1];
            double square = d[0] * d[0] + d[1] * d[1];
            double t = square > 0 ? fmin(fmax((x * d[0] + y * d[1]) / square, 0), 1) : 0;
            assert_true(hypot(x - t * d[0], y - t * d[1]) <= reach + 1e-9);
        }
    assert_true(changed > 0);
}

static void test_sculpt(void **state)
{
    (void)state;
    /* A cliff: half the block is 20 m higher. */
    struct stacks s = block(48, 48, 64, 10), before;
    put(&s, 24, 0, 47, 47, 10, 30, MATERIAL_BEDROCK);
    for (int add = 0; add < 2; add++) {
        double at[1][4] = {{24, 24, 20, 4}};
        struct job_operation op = tool(TOOL_SCULPT, at, 1);
        int lo[2], hi[2];
        op.mode = add ? MODE_ADD : MODE_CARVE;
        op.project = true;
        op.strength = 2;
        assert_ok(stacks_copy(&s, &before));
        double was = volume(&s, MATERIAL_BEDROCK);
        apply(&s, &op, 1, lo, hi);
        double change = volume(&s, MATERIAL_BEDROCK) - was;
        /* Its middle is half a radius before or behind the wall. */
        const double middle[4] = {24 + (add ? 2 : -2), 24};
        check_reach(&before, &s, lo, hi, middle, middle, 4 + 0.3);
        size_t n;
        stacks_column(&s, 23, 24, &n);
        print_message("# %s the wall: %+.1f m3\n", add ? "added to" : "carved from", change);
        assert_true(add ? change > 3 : change < -3);
        assert_true(fabs(change) < 4.0 / 3 * M_PI * 64);
        if (add)
            assert_true(n > 1); /* an overhang: ground, air, rock */
        stacks_destroy(&s);
        s = before;
    }
    stacks_destroy(&s);
}

static void test_tunnels(void **state)
{
    (void)state;
    struct stacks s = block(128, 64, 128, 100), before;
    double at[4][4] = {{20, 32, 50, 6}, {108, 32, 50, 6}, {64, 32, 50, 5}, {64, 60, 70, 5}};
    struct job_operation op = tool(TOOL_SWEEP, at, 2);
    int lo[2], hi[2];
    assert_ok(stacks_copy(&s, &before));
    double was = volume(&s, MATERIAL_BEDROCK);
    apply(&s, &op, 1, lo, hi);
    double taken = was - volume(&s, MATERIAL_BEDROCK), exact = M_PI * 36 * 88 + 4.0 / 3 * M_PI * 216;
    print_message("# a straight tunnel with round ends: %.1f m3, exactly %.1f\n", taken, exact);
    assert_true(fabs(taken - exact) < 0.01 * exact);
    check_reach(&before, &s, lo, hi, at[0], at[1], 6);
    /* Again in five parts: the same tunnel. */
    struct stacks parts;
    assert_ok(stacks_copy(&before, &parts));
    op.frames = (struct frame_range){1, 5, 1};
    for (int frame = 1; frame <= 5; frame++) {
        assert_true(operation_active(&op, frame));
        apply(&parts, &op, frame, lo, hi);
        if (frame == 2)
            assert_true(hi[0] < 72 && lo[0] >= 24); /* only as far as it has come */
    }
    assert_true(fabs(volume(&parts, MATERIAL_BEDROCK) - volume(&s, MATERIAL_BEDROCK)) < 1e-6 * exact);
    /* A branch from its middle. */
    double arcs[2][2] = {{0, 1}, {2, 3}};
    op = tool(TOOL_SWEEP, at, 4);
    op.arcs = arcs;
    op.n_arcs = 2;
    stacks_destroy(&parts);
    assert_ok(stacks_copy(&before, &parts));
    apply(&parts, &op, 1, lo, hi);
    size_t n;
    stacks_column(&parts, 64, 55, &n);
    assert_int_equal(n, 3);
    assert_true(volume(&parts, MATERIAL_BEDROCK) < volume(&s, MATERIAL_BEDROCK) - M_PI * 25 * 20);
    /* And filled again, as a bridge would be. */
    op.mode = MODE_ADD;
    apply(&parts, &op, 1, lo, hi);
    assert_true(fabs(volume(&parts, MATERIAL_BEDROCK) - was) < 1e-6 * was);
    stacks_destroy(&s), stacks_destroy(&parts), stacks_destroy(&before);
}

static double area_of(const double (*v)[2], int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += 0.5 * (v[i][0] * v[(i + 1) % n][1] - v[(i + 1) % n][0] * v[i][1]);
    return sum;
}

/* The spline through the control points, finely. */
static double spline_area(const double (*c)[2], int n)
{
    double v[4096][2];
    for (int k = 0; k < 4096; k++) {
        double u = (double)k * n / 4096, t = u - floor(u);
        int i = (int)u;
        for (int a = 0; a < 2; a++) {
            double p[4] = {c[(i + n - 1) % n][a], c[i][a], c[(i + 1) % n][a], c[(i + 2) % n][a]};
            v[k][a] =
                p[1] +
                0.5 * t *
                    (p[2] - p[0] +
                     t * (2 * p[0] - 5 * p[1] + 4 * p[2] - p[3] + t * (3 * (p[1] - p[2]) + p[3] - p[0])));
        }
    }
    return fabs(area_of((const double(*)[2])v, 4096));
}

/* What a sweep carves between x0 and x1, m3. */
static double carved(const struct stacks *s, int x0, int x1)
{
    double air = 0;
    for (int j = 0; j < s->n[1]; j++)
        for (int i = x0; i < x1; i++) {
            size_t n;
            const uint32_t *layer = stacks_column(s, i, j, &n);
            double below = 0;
            for (size_t k = 0; k < n; k++) {
                const double top = layer_top(layer[k]) * s->quantum;
                if (layer_material(layer[k]) == MATERIAL_AIR && top < 100)
                    air += top - below;
                below = top;
            }
        }
    return air * s->cell * s->cell;
}

/* Points with profiles of their own: along a path the volume of each arc is that of the blend of its ends, and on a graph a branch has its
 * own, wherever the others are as far from the first point. */
static void profiles_at_points(double eight[8][2], double square[8][2])
{
    double at[4][4] = {{14, 48, 50, 16}, {46, 48, 50, 16}, {78, 48, 50, 16}, {110, 48, 50, 16}}, flat[8][2];
    for (int k = 0; k < 8; k++) {
        flat[k][0] = square[k][0];
        flat[k][1] = 0.4 * square[k][1];
    }
    struct job_point_profile own[2] = {{.point = 1, .profile = square, .n_profile = 8},
                                       {.point = 2, .profile = flat, .n_profile = 8}};
    double(*const ends[3][2])[2] = {{eight, square}, {square, flat}, {flat, eight}};
    struct stacks s = block(128, 96, 128, 100);
    struct job_operation op = tool(TOOL_SWEEP, at, 4);
    int lo[2], hi[2];
    op.profile = eight;
    op.n_profile = 8;
    op.profiles = own;
    op.n_profiles = 2;
    apply(&s, &op, 1, lo, hi);
    for (int arc = 0; arc < 3; arc++) {
        double exact = 0, taken = carved(&s, 14 + 32 * arc, 46 + 32 * arc);
        for (int k = 0; k < 32; k++) {
            double mixed[8][2], t = (k + 0.5) / 32;
            for (int p = 0; p < 8; p++)
                for (int a = 0; a < 2; a++)
                    mixed[p][a] = (1 - t) * ends[arc][0][p][a] + t * ends[arc][1][p][a];
            exact += 256 * spline_area((const double(*)[2])mixed, 8);
        }
        print_message("# between points %d and %d: %.0f m3, exactly %.0f\n", arc, arc + 1, taken, exact);
        assert_true(fabs(taken - exact) < 0.03 * exact);
    }
    stacks_destroy(&s);
    /* Two branches as long as each other: only one of them becomes flat. */
    double fork[3][4] = {{64, 48, 50, 10}, {14, 48, 50, 10}, {114, 48, 50, 10}},
           arcs[2][2] = {{0, 1}, {0, 2}};
    struct stacks two = block(128, 96, 128, 100);
    struct job_operation branch = tool(TOOL_SWEEP, fork, 3);
    branch.arcs = arcs;
    branch.n_arcs = 2;
    branch.profile = square;
    branch.n_profile = 8;
    own[0] = (struct job_point_profile){.point = 2, .profile = flat, .n_profile = 8};
    branch.profiles = own;
    branch.n_profiles = 1;
    apply(&two, &branch, 1, lo, hi);
    const double left = carved(&two, 14, 64), right = carved(&two, 64, 114);
    print_message("# branches of one size and one that becomes flat: %.0f and %.0f m3\n", left, right);
    assert_true(fabs(right / left - 0.7) < 0.03);
    stacks_destroy(&two);
}

static void test_profiles(void **state)
{
    (void)state;
    /* Two lobes with a waist: not convex. */
    double eight[8][2] = {{-1, 0.6}, {-0.3, 0.25}, {0.3, 0.25},   {1, 0.6},
                          {1, -0.6}, {0.3, -0.25}, {-0.3, -0.25}, {-1, -0.6}};
    double square[8][2] = {{-0.5, 0.5}, {-0.2, 0.5}, {0.2, 0.5},   {0.5, 0.5},
                           {0.5, -0.5}, {0.2, -0.5}, {-0.2, -0.5}, {-0.5, -0.5}};
    double at[2][4] = {{14, 48, 50, 16}, {114, 48, 50, 16}};
    for (int both = 0; both < 2; both++) {
        struct stacks s = block(128, 96, 128, 100);
        struct job_operation op = tool(TOOL_SWEEP, at, 2);
        int lo[2], hi[2];
        op.profile = eight;
        op.n_profile = 8;
        op.end_profile = square;
        op.n_end_profile = both ? 8 : 0;
        double was = volume(&s, MATERIAL_BEDROCK);
        apply(&s, &op, 1, lo, hi);
        double taken = was - volume(&s, MATERIAL_BEDROCK), exact = 0;
        for (int k = 0; k < 100; k++) { /* Simpson would do; so do slices */
            double mixed[8][2], t = both ? (k + 0.5) / 100 : 0;
            for (int p = 0; p < 8; p++)
                for (int a = 0; a < 2; a++)
                    mixed[p][a] = (1 - t) * eight[p][a] + t * square[p][a];
            exact += 256 * spline_area((const double(*)[2])mixed, 8);
        }
        print_message("# a spline profile%s: %.0f m3, exactly %.0f\n", both ? " that changes" : "", taken,
                      exact);
        assert_true(fabs(taken - exact) < 0.02 * exact);
        stacks_destroy(&s);
    }
    profiles_at_points(eight, square);
    /* A rough wall, and nothing but air within: noise moves the wall only. */
    struct stacks rough = block(128, 96, 128, 100);
    double bent[3][4] = {{14, 40, 50, 14}, {60, 56, 50, 14}, {114, 44, 50, 14}};
    struct job_operation wall = tool(TOOL_SWEEP, bent, 3);
    int from[2], to[2];
    wall.profile = square;
    wall.n_profile = 8;
    wall.roughness = 0.1;
    apply(&rough, &wall, 1, from, to);
    size_t n_layers;
    const uint32_t *hollow = stacks_column(&rough, 60, 56, &n_layers);
    assert_int_equal(n_layers, 3);
    assert_true(fabs(layer_top(hollow[0]) * rough.quantum - 43) < 2.5 * 1.4 + 0.5);
    assert_true(fabs(layer_top(hollow[1]) * rough.quantum - 57) < 2.5 * 1.4 + 0.5);
    stacks_destroy(&rough);
    /* A crack follows the ground: on a slope it is as deep everywhere. */
    struct stacks s = block(96, 48, 128, 10);
    for (int i = 0; i < 96; i++)
        put(&s, i, 0, i, 47, 0, 20 + 0.5 * i, MATERIAL_BEDROCK);
    double crack[2][4] = {{16, 24, 0, 4}, {80, 24, 0, 4}},
           slit[4][2] = {{-0.5, 1}, {0.5, 1}, {0.5, -1}, {-0.5, -1}};
    struct job_operation op = tool(TOOL_SWEEP, crack, 2);
    int lo[2], hi[2];
    op.project = true;
    op.profile = slit;
    op.n_profile = 4;
    apply(&s, &op, 1, lo, hi);
    for (int i = 24; i < 72; i += 8) {
        size_t n;
        const uint32_t *layer = stacks_column(&s, i, 24, &n);
        double depth = 20 + 0.5 * i - layer_top(layer[0]) * s.quantum;
        assert_true(depth > 3.5 && depth < 5.5);
    }
    stacks_destroy(&s);
}

static void test_loose(void **state)
{
    (void)state;
    struct stacks s = block(64, 64, 64, 10);
    put(&s, 16, 16, 47, 47, 30, 34, MATERIAL_BEDROCK);
    /* Under the roof, though the roof is nearer to the sky. */
    double at[1][4] = {{32, 32, 20, 8}};
    struct job_operation op = tool(TOOL_DEPOSIT, at, 1);
    int lo[2], hi[2];
    op.thickness_m = 3;
    apply(&s, &op, 1, lo, hi);
    double exact = 3 * M_PI * 64 / 3; /* of (1 - r2)^2 over a disk: a third */
    print_message("# dropped %.2f m3, exactly %.2f\n", volume(&s, MATERIAL_SAND), exact);
    assert_true(fabs(volume(&s, MATERIAL_SAND) - exact) < 0.01 * exact);
    size_t n;
    const uint32_t *layer = stacks_column(&s, 32, 32, &n);
    assert_int_equal(n, 4);
    assert_int_equal(layer_material(layer[1]), MATERIAL_SAND);
    /* Over as many frames, as much. */
    struct stacks slow = block(64, 64, 64, 10);
    op.frames = (struct frame_range){1, 7, 1};
    op.travel = false;
    for (int frame = 1; frame <= 7; frame++)
        apply(&slow, &op, frame, lo, hi);
    assert_true(fabs(volume(&slow, MATERIAL_SAND) - volume(&s, MATERIAL_SAND)) < 1e-3 * exact);
    stacks_destroy(&slow);
    /* Erosion turns bedrock into as much rock and sand. */
    double roof[1][4] = {{32, 32, 32, 7}};
    op = tool(TOOL_ERODE, roof, 1);
    op.rocks = 0.7;
    double bedrock = volume(&s, MATERIAL_BEDROCK), sand = volume(&s, MATERIAL_SAND);
    apply(&s, &op, 1, lo, hi);
    double taken = bedrock - volume(&s, MATERIAL_BEDROCK), rocks = volume(&s, MATERIAL_ROCK);
    print_message("# eroded %.2f m3 into %.2f of rock and %.2f of sand\n", taken, rocks,
                  volume(&s, MATERIAL_SAND) - sand);
    assert_true(fabs(rocks - 0.7 * taken) < 1e-4 * taken);
    assert_true(fabs(volume(&s, MATERIAL_SAND) - sand - 0.3 * taken) < 1e-4 * taken);
    struct stabilised out;
    struct stabilise options = {.table = table, .n_materials = N_TABLE};
    assert_ok(stabilise(&s, &options, lo, hi, &out));
    assert_true(out.resting);
    layer = stacks_column(&s, 32, 32, &n);
    assert_true(layer_material(layer[n - 1]) != MATERIAL_BEDROCK); /* the roof is through */
    /* Near the surface only: the depth is that of the field, half a sigma. */
    struct stacks flat = block(64, 64, 64, 20);
    double ground[1][4] = {{32, 32, 20, 12}};
    op = tool(TOOL_ERODE, ground, 1);
    op.depth = DEPTH_SURFACE;
    op.strength = 0.5;
    op.rocks = 0;
    apply(&flat, &op, 1, lo, hi);
    layer = stacks_column(&flat, 32, 32, &n);
    double depth = 20 - layer_top(layer[0]) * flat.quantum;
    print_message("# worn %.3f m deep in the middle\n", depth);
    assert_true(fabs(depth - 0.5) < 0.02);
    stacks_destroy(&s), stacks_destroy(&flat);
}

static void test_water(void **state)
{
    (void)state;
    struct stacks s = block(40, 40, 64, 20);
    put(&s, 5, 5, 14, 14, 10, 20, MATERIAL_AIR);  /* a basin */
    put(&s, 25, 5, 34, 14, 10, 20, MATERIAL_AIR); /* another */
    put(&s, 15, 9, 24, 10, 11, 12, MATERIAL_AIR); /* joined by a pipe */
    put(&s, 5, 25, 14, 34, 10, 20, MATERIAL_AIR); /* and one that is not */
    double at[1][4] = {{8.5, 8.5, 15, 1}};
    struct job_operation op = tool(TOOL_FILL, at, 1);
    int lo[2], hi[2];
    op.level_m = 16;
    apply(&s, &op, 1, lo, hi);
    double exact = 2 * 100 * 6 + 20 * 1;
    print_message("# water: %.3f m3, exactly %.3f\n", volume(&s, MATERIAL_WATER), exact);
    assert_true(fabs(volume(&s, MATERIAL_WATER) - exact) < 1e-3);
    op.level_m = 13; /* the level falls */
    apply(&s, &op, 2, lo, hi);
    assert_true(fabs(volume(&s, MATERIAL_WATER) - (2 * 100 * 3 + 20)) < 1e-3);
    stacks_destroy(&s);
}

static void test_noise(void **state)
{
    (void)state;
    struct stacks s = block(64, 64, 64, 30), before;
    double at[1][4] = {{32, 32, 30, 12}};
    struct job_operation op = tool(TOOL_NOISE, at, 1);
    int lo[2], hi[2];
    op.strength = 0.9;
    assert_ok(stacks_copy(&s, &before));
    apply(&s, &op, 1, lo, hi);
    check_reach(&before, &s, lo, hi, at[0], at[0], 12);
    struct job_operation all = tool(TOOL_NOISE, NULL, 0);
    all.strength = 0.5;
    apply(&s, &all, 1, lo, hi);
    assert_true(lo[0] == 0 && hi[1] == 63);
    assert_true(fabs(volume(&s, MATERIAL_BEDROCK) - 30 * 64 * 64) < 0.02 * 30 * 64 * 64);
    stacks_destroy(&s), stacks_destroy(&before);
}

/* ---- Table 1 */

static double share(uint32_t seed, uint32_t a, uint32_t b)
{
    return (double)random_float(random_hash(seed, a, b, 31));
}

/* A terrain of nx x ny stacks, `height` m high: ground that is rough, `n` winding tunnels through it, stone
 * bridges over a ravine, and erosion that leaves sand and rocks in them. The largest is for those with time, and
 * none for those with little: the tools have their own tests above, and what counts here is size. */
static void test_memory(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int nx, ny;
        double height, megabytes;
        uint32_t tunnels;
    } scenes[] = {{"cliff", 2000, 500, 4000, 26, 24},
                  {"cave", 1000, 750, 8000, 21, 12},
                  {"canyon", 1000, 500, 5000, 14, 12}};
    for (uint32_t k = effort() < 1 ? 3 : effort() > 1 ? 0 : 1; k < 3; k++) {
        /* A voxel of an eighth of a stack's width; stacks are finer still. */
        struct stacks s = block(scenes[k].nx, scenes[k].ny, scenes[k].height / 8, 0.6 * scenes[k].height / 8);
        double size = 0.12 * scenes[k].ny, t0 = clock_seconds(), h = scenes[k].height / 8;
        int lo[2], hi[2];
        struct job_operation rough = tool(TOOL_NOISE, NULL, 0);
        apply(&s, &rough, 1, lo, hi);
        double ravine[6][4];
        for (uint32_t p = 0; p < 6; p++) {
            ravine[p][0] = scenes[k].nx * (p + 0.2) / 5.4;
            ravine[p][1] = scenes[k].ny * (0.35 + 0.3 * share(k, p, 1));
            ravine[p][2] = 0.5 * h;
            ravine[p][3] = 0.4 * size;
        }
        double deep[6][2] = {{-1, 4}, {1, 4}, {0.7, 1}, {0.5, -2}, {-0.6, -2}, {-0.8, 1}};
        struct job_operation op = tool(TOOL_SWEEP, ravine, 6);
        op.profile = deep;
        op.n_profile = 6;
        apply(&s, &op, 1, lo, hi);
        for (uint32_t t = 0; t < scenes[k].tunnels; t++) {
            double at[4][4];
            for (uint32_t p = 0; p < 4; p++) {
                at[p][0] = scenes[k].nx * (0.1 + 0.8 * share(k, t, 10 + p));
                at[p][1] = scenes[k].ny * (0.1 + 0.8 * share(k, t, 20 + p));
                at[p][2] = h * (0.1 + 0.5 * share(k, t, 30 + p));
                at[p][3] = size * (0.1 + 0.2 * share(k, t, 40 + p));
            }
            op = tool(TOOL_SWEEP, at, 4);
            op.mode = t % 6 == 5 ? MODE_ADD : MODE_CARVE;
            apply(&s, &op, 1, lo, hi);
            if (t % 8)
                continue;
            op = tool(TOOL_ERODE, at, 4);
            op.depth = DEPTH_SURFACE;
            apply(&s, &op, 1, lo, hi);
            struct stabilised out;
            struct stabilise options = {.table = table, .n_materials = N_TABLE};
            assert_ok(stabilise(&s, &options, lo, hi, &out));
            assert_true(out.resting);
        }
        size_t overhangs = 0, most = 0;
        for (int j = 0; j < s.n[1]; j++)
            for (int i = 0; i < s.n[0]; i++) {
                size_t n;
                const uint32_t *layer = stacks_column(&s, i, j, &n);
                most = n > most ? n : most;
                for (size_t l = 0; l < n; l++)
                    overhangs += layer_material(layer[l]) == MATERIAL_AIR;
            }
        double megabytes = 1e-6 * (double)stacks_bytes(&s);
        print_message(
            "# %s, %d x %d x %.0f: %.1f MB (the paper's %.0f); %zu layers, up to %zu in a stack, %zu "
            "ceilings over %d stacks; made in %.1f s\n",
            scenes[k].name, s.n[0], s.n[1], scenes[k].height, megabytes, scenes[k].megabytes,
            stacks_layers(&s), most, overhangs, s.n[0] * s.n[1], clock_seconds() - t0);
        assert_true(megabytes <= scenes[k].megabytes);
        assert_true(overhangs > (size_t)(s.n[0] * s.n[1]) / 16);
        stacks_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sculpt), cmocka_unit_test(test_tunnels), cmocka_unit_test(test_profiles),
        cmocka_unit_test(test_loose),  cmocka_unit_test(test_water),   cmocka_unit_test(test_noise),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
