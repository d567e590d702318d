/* Stacks of layers: edits, copies, the smooth surface over them, and how loose material comes to rest. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/random.h"
#include "effort.h"
#include "shared/params.h"
#include "stacks/stabilise.h"
#include "stacks/surface.h"

static const struct material table[] = {{"air", 90, 0, {0}},
                                        {"bedrock", 90, 1, {0}},
                                        {"sand", 32, 1, {0}},
                                        {"rock", 42, 1, {0}},
                                        {"water", 0, 0, {0}}};
enum { N_TABLE = 5 };

static double random_share(uint32_t seed, uint32_t a, uint32_t b)
{
    return (double)random_float(random_hash(seed, a, b, 77));
}

/* ---- building by hand */

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

/* Bedrock full of holes, with slabs of sand and rock anywhere, in the air too. */
struct chaos {
    uint32_t seed;
    const struct stacks *s;
};

static status put_chaos(void *user, int i, int j, struct column *c)
{
    status st = OK;
    const struct chaos *k = user;
    uint32_t at = (uint32_t)(j * 1000 + i), block = (uint32_t)(j / 4 * 1000 + i / 4);
    TRY(column_set(c, 0, stacks_quanta(k->s, 1 + 3 * random_share(k->seed, block, 1)), MATERIAL_BEDROCK));
    for (uint32_t n = 0; n < 6; n++) {
        bool wide = n % 2;
        uint32_t where = wide ? block : at;
        if (random_share(k->seed, where, 10 + n) > 0.6)
            continue;
        double lo = 20 * random_share(k->seed, where, 20 + n),
               size = 4 * random_share(k->seed, where, 30 + n);
        uint32_t material = n == 1   ? MATERIAL_BEDROCK
                            : n == 3 ? MATERIAL_AIR
                            : n == 4 ? MATERIAL_ROCK
                            : n == 5 ? MATERIAL_BEDROCK
                                     : MATERIAL_SAND;
        TRY(column_set(c, stacks_quanta(k->s, lo), stacks_quanta(k->s, lo + size), material));
    }
done:
    return st;
}

static struct stacks make_chaos(int n, uint32_t seed)
{
    struct stacks s;
    assert_ok(stacks_create((const int[]){n, n}, 1, 60, &s));
    struct chaos chaos = {seed, &s};
    assert_ok(stacks_edit(&s, (const int[]){0, 0}, s.n, put_chaos, &chaos));
    return s;
}

/* ---- columns and copies */

static void test_columns(void **state)
{
    (void)state;
    struct column c = {0};
    assert_ok(column_set(&c, 0, 100, MATERIAL_BEDROCK));
    assert_ok(column_set(&c, 30, 40, MATERIAL_AIR));
    assert_ok(column_set(&c, 120, 140, MATERIAL_SAND));
    assert_int_equal(c.n, 5);
    assert_int_equal(column_at(c.layer, c.n, 29), MATERIAL_BEDROCK);
    assert_int_equal(column_at(c.layer, c.n, 30), MATERIAL_AIR);
    assert_int_equal(column_at(c.layer, c.n, 40), MATERIAL_BEDROCK);
    assert_int_equal(column_at(c.layer, c.n, 110), MATERIAL_AIR);
    assert_int_equal(column_at(c.layer, c.n, 139), MATERIAL_SAND);
    assert_int_equal(column_at(c.layer, c.n, 140), MATERIAL_AIR);
    /* Only bedrock turns; the hole and the sand stay. */
    assert_ok(column_replace(&c, 20, 200, 1u << MATERIAL_BEDROCK, MATERIAL_ROCK));
    uint64_t amount[MATERIALS_MAX] = {0};
    column_amounts(c.layer, c.n, amount);
    assert_int_equal(amount[MATERIAL_BEDROCK], 20);
    assert_int_equal(amount[MATERIAL_ROCK], 10 + 60);
    assert_int_equal(amount[MATERIAL_SAND], 20);
    assert_int_equal(amount[MATERIAL_AIR], 10 + 20);
    /* Air on top is not kept, nor neighbours alike. */
    assert_ok(column_set(&c, 25, 1000, MATERIAL_AIR));
    assert_ok(column_set(&c, 20, 25, MATERIAL_BEDROCK));
    assert_int_equal(c.n, 1);
    column_free(&c);
}

static void test_copies_share_what_is_not_edited(void **state)
{
    (void)state;
    struct stacks s = make_chaos(100, 1), copy;
    assert_ok(stacks_copy(&s, &copy));
    size_t same = 0, n_tiles = (size_t)s.tiles[0] * (size_t)s.tiles[1];
    put(&s, 40, 40, 41, 41, 2, 3, MATERIAL_SAND);
    for (size_t t = 0; t < n_tiles; t++)
        same += s.tile[t] == copy.tile[t];
    assert_int_equal(same, n_tiles - 1);
    struct stacks fresh = make_chaos(100, 1);
    for (int j = 0; j < 100; j++)
        for (int i = 0; i < 100; i++) {
            size_t a, b;
            const uint32_t *la = stacks_column(&copy, i, j, &a), *lb = stacks_column(&fresh, i, j, &b);
            assert_int_equal(a, b);
            assert_memory_equal(la, lb, a * sizeof *la);
        }
    /* There and back through flat arrays. */
    size_t n = stacks_layers(&s);
    uint32_t *count = calloc(100 * 100, 4), *layer = calloc(n, 4);
    stacks_pack(&s, count, layer);
    struct stacks back;
    assert_ok(stacks_create(s.n, s.cell, 60, &back));
    assert_ok(stacks_unpack(&back, count, layer, n));
    uint32_t *again = calloc(n, 4);
    stacks_pack(&back, count, again);
    assert_memory_equal(layer, again, n * 4);
    layer[5] = layer[4]; /* not ascending */
    assert_int_equal(stacks_unpack(&back, count, layer, n), E_INPUT);
    free(count), free(layer), free(again);
    stacks_destroy(&s), stacks_destroy(&copy), stacks_destroy(&fresh), stacks_destroy(&back);
}

/* ---- the surface */

enum { ROCK_SET = 1 << MATERIAL_BEDROCK | 1 << MATERIAL_SAND };

static void test_pure_and_half(void **state)
{
    (void)state;
    struct stacks s;
    assert_ok(stacks_create((const int[]){16, 16}, 0.5, 32, &s));
    put(&s, 0, 0, 15, 15, 0, 16, MATERIAL_BEDROCK);
    for (double sigma = 0.3; sigma < 3; sigma *= 1.7) {
        struct surface f = {&s, ROCK_SET, sigma};
        double worst = 0;
        for (double x = 0; x <= 8; x += 0.37) {
            worst = fmax(worst, fabs(surface_at(&f, (const double[]){x, 8 - x, 16 - sigma}) - 1));
            worst = fmax(worst, fabs(surface_at(&f, (const double[]){x, 8 - x, 16 + sigma}) + 1));
            worst = fmax(worst, fabs(surface_at(&f, (const double[]){x, 8 - x, 16}) - 0));
        }
        print_message("# sigma %.3f m: pure and half-filled boxes within %.1e of 1, -1 and 0\n", sigma,
                      worst);
        assert_true(worst < 4 * s.quantum / sigma);
    }
    /* Filled by half from the side. */
    put(&s, 8, 0, 15, 15, 0, 16, MATERIAL_AIR);
    struct surface f = {&s, ROCK_SET, 0.8};
    assert_true(fabs(surface_at(&f, (const double[]){4, 3.3, 8})) < 1e-12);
    stacks_destroy(&s);
}

/* The same integral by counting: 1/8 of a cell across, exact along z only if the voxels are the quanta; so
 * boxes are aligned to voxels, and layers to whole voxels. */
static void test_equals_voxels(void **state)
{
    (void)state;
    enum { N = 12, FINE = 8, Z = 24 * FINE };
    struct stacks s;
    /* Quanta that eighths of a metre are exact in: a height of STACK_TOP / 2^20. */
    assert_ok(stacks_create((const int[]){N, N}, 1, STACK_TOP / 1048576.0, &s));
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            for (uint32_t k = 0; k < 5; k++) {
                uint32_t at = (uint32_t)(j * N + i);
                double lo = floor(8 * 18 * random_share(3, at, k)) / 8,
                       size = floor(8 * 6 * random_share(4, at, k)) / 8;
                put(&s, i, j, i, j, lo, lo + size, k == 3 ? MATERIAL_AIR : MATERIAL_BEDROCK + k % 3);
            }
    struct surface f = {&s, ROCK_SET, 1.25};
    double worst = 0, worst_line = 0;
    struct profile line = {0};
    for (uint32_t t = 0; t < 300; t++) {
        double p[3] = {floor(8 * N * random_share(5, t, 0)) / 8, floor(8 * N * random_share(5, t, 1)) / 8,
                       2 + floor(8 * 18 * random_share(5, t, 2)) / 8};
        long full = 0, all = 0;
        for (int c = 0; c < 20; c++)
            for (int b = 0; b < 20; b++)
                for (int a = 0; a < 20; a++) {
                    double q[3] = {p[0] - 1.25 + (a + 0.5) / 8, p[1] - 1.25 + (b + 0.5) / 8,
                                   p[2] - 1.25 + (c + 0.5) / 8};
                    int i = (int)fmin(fmax(floor(q[0]), 0), N - 1),
                        j = (int)fmin(fmax(floor(q[1]), 0), N - 1);
                    size_t n;
                    const uint32_t *layer = stacks_column(&s, i, j, &n);
                    uint32_t m = column_at(layer, n, stacks_quanta(&s, fmax(q[2], 0)));
                    full += ROCK_SET >> m & 1;
                    all++;
                }
        double expected = 2.0 * (double)full / (double)all - 1, got = surface_at(&f, p);
        worst = fmax(worst, fabs(got - expected));
        assert_ok(surface_profile(&f, p[0], p[1], &line));
        worst_line = fmax(worst_line, fabs(profile_at(&line, p[2]) - expected));
    }
    print_message("# against voxels: f within %.1e, its vertical profile within %.1e\n", worst, worst_line);
    assert_true(worst < 1e-5 && worst_line < 1e-5);

    /* The lattice's samples are the same function, and f is continuous: steps shrink with the distance. */
    float share[20 * 18 * 22];
    const double origin[3] = {-1.3, 0.2, 0.4};
    struct surface_scratch scratch = {0};
    assert_ok(
        surface_sample(&f, &(struct surface_box){{origin[0], origin[1], origin[2]}, 0.71, {0}, {20, 18, 22}},
                       &scratch, share));
    double worst_share = 0, jump = 0, slope = 0;
    for (int k = 0, at = 0; k < 22; k++)
        for (int j = 0; j < 18; j++)
            for (int i = 0; i < 20; i++, at++) {
                const double p[3] = {origin[0] + 0.71 * i, origin[1] + 0.71 * j, origin[2] + 0.71 * k};
                worst_share = fmax(worst_share, fabs((surface_at(&f, p) + 1) / 2 - (double)share[at]));
            }
    for (uint32_t t = 0; t < 20000; t++) {
        double p[3] = {12 * random_share(6, t, 0), 12 * random_share(6, t, 1), 22 * random_share(6, t, 2)};
        double here = surface_at(&f, p);
        for (int a = 0; a < 3; a++)
            p[a] += 1e-4 * (random_share(7, t, (uint32_t)a) - 0.5);
        jump = fmax(jump, fabs(surface_at(&f, p) - here));
    }
    print_message("# lattice within %.1e; moved by 1e-4 m, f changes by at most %.1e\n", worst_share, jump);
    assert_true(worst_share < 1e-5);
    /* A part of it is the same to the bit. */
    float part[8 * 5 * 6];
    assert_ok(surface_sample(
        &f, &(struct surface_box){{origin[0], origin[1], origin[2]}, 0.71, {11, 3, 9}, {8, 5, 6}}, &scratch,
        part));
    free(scratch.line);
    for (int k = 0, at = 0; k < 6; k++)
        for (int j = 0; j < 5; j++)
            for (int i = 0; i < 8; i++, at++)
                assert_true(part[at] == share[((k + 9) * 18 + j + 3) * 20 + i + 11]);
    assert_true(jump < 3 * 1e-4 / 1.25); /* |df/dx| <= 1 / sigma along an axis */

    /* The gradient by differences, and roots on the surface. */
    int off = 0, n_found = 0;
    for (uint32_t t = 0; t < 2000; t++) {
        double p[3] = {12 * random_share(8, t, 0), 12 * random_share(8, t, 1), 22 * random_share(8, t, 2)};
        double g[3];
        surface_gradient(&f, p, g);
        for (int a = 0; a < 3; a++) {
            double q[2][3];
            memcpy(q[0], p, sizeof p), memcpy(q[1], p, sizeof p);
            q[0][a] -= 1e-5, q[1][a] += 1e-5;
            slope = (surface_at(&f, q[1]) - surface_at(&f, q[0])) / 2e-5;
            off += fabs(slope - g[a]) > 1e-4; /* where a face lies just on a boundary */
        }
        bool found;
        assert_ok(surface_project(&f, p, &found));
        n_found += found;
        if (found)
            assert_true(fabs(surface_at(&f, p)) < 1e-5);
    }
    print_message("# gradient: %d of 6000 differ from differences (on boundaries)\n", off);
    assert_true(off < 30 && n_found > 1500);
    profile_free(&line);
    stacks_destroy(&s);
}

static void test_visible(void **state)
{
    (void)state;
    struct stacks s;
    double area[MATERIALS_MAX];
    assert_ok(stacks_create((const int[]){16, 16}, 1, 32, &s));
    put(&s, 0, 0, 15, 15, 0, 10, MATERIAL_BEDROCK);
    put(&s, 8, 0, 15, 15, 10, 10.05, MATERIAL_SAND); /* a veneer shows as much as a dune */
    struct surface f = {&s, ROCK_SET, 2};
    surface_visible(&f, (const double[]){8, 8, 10}, area);
    assert_true(fabs(area[MATERIAL_BEDROCK] - 8) < 1e-6);
    assert_true(fabs(area[MATERIAL_SAND] - 8 - 4 * 0.05) < 1e-4); /* and its edge */
    put(&s, 0, 0, 7, 15, 6, 10, MATERIAL_AIR); /* a wall 4 m high; the box holds 2 m of it */
    surface_visible(&f, (const double[]){8, 8, 10}, area);
    assert_true(fabs(area[MATERIAL_BEDROCK] - 4 * 2) < 1e-4);
    stacks_destroy(&s);
}

static uint32_t material_at(const struct stacks *s, const double q[3])
{
    size_t n;
    const uint32_t *layer = stacks_column(s, (int)q[0], (int)q[1], &n);
    return column_at(layer, n, stacks_quanta(s, q[2]));
}

/* The same by counting faces of voxels of 1/16 m between air or water and all else. Boxes begin and end within
 * voxels of 1/8 m, in which layers are whole. */
static void test_visible_equals_faces(void **state)
{
    (void)state;
    enum { N = 12, WIDE = 40 };
    struct stacks s;
    double worst = 0, most = 0;
    int kinds[MATERIALS_MAX] = {0};
    assert_ok(stacks_create((const int[]){N, N}, 1, STACK_TOP / 1048576.0, &s));
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            for (uint32_t k = 0; k < 6; k++) {
                uint32_t at = (uint32_t)(j * N + i);
                double lo = floor(8 * 14 * random_share(13, at, k)) / 8,
                       size = 0.125 + floor(8 * 5 * random_share(14, at, k)) / 8;
                put(&s, i, j, i, j, lo, lo + size, k % 5); /* air, bedrock, sand, rock, water */
            }
    struct surface f = {&s, ROCK_SET, 1.25};
    for (uint32_t t = 0; t < 60; t++) {
        double p[3], area[MATERIALS_MAX], counted[MATERIALS_MAX] = {0};
        for (uint32_t a = 0; a < 3; a++)
            p[a] = 2 + floor(8 * (a == 2 ? 12 : N - 4) * random_share(15, t, a)) / 8 + 1.0 / 16;
        for (int c = 0; c < WIDE; c++)
            for (int b = 0; b < WIDE; b++)
                for (int a = 0; a < WIDE; a++) {
                    const int x[3] = {a, b, c};
                    double q[3], r[3];
                    for (int d = 0; d < 3; d++)
                        q[d] = p[d] - 1.25 + (x[d] + 0.5) / 16;
                    uint32_t own = material_at(&s, q);
                    for (int d = 0; d < 3; d++) {
                        memcpy(r, q, sizeof q);
                        r[d] += 1.0 / 16;
                        uint32_t next = material_at(&s, r);
                        bool open = own == MATERIAL_AIR || own == MATERIAL_WATER;
                        if (x[d] + 1 < WIDE && open != (next == MATERIAL_AIR || next == MATERIAL_WATER))
                            counted[open ? next : own] += 1.0 / 256;
                    }
                }
        surface_visible(&f, p, area);
        for (int m = 0; m < MATERIALS_MAX; m++) {
            worst = fmax(worst, fabs(area[m] - counted[m]));
            most = fmax(most, counted[m]);
            kinds[m] += counted[m] > 0;
        }
    }
    print_message("# what shows, against faces of voxels: within %.1e of up to %.1f m2\n", worst, most);
    assert_true(worst < 1e-5 && kinds[MATERIAL_BEDROCK] > 30 && kinds[MATERIAL_SAND] > 30 &&
                kinds[MATERIAL_ROCK] > 30);
    assert_true(kinds[MATERIAL_AIR] == 0 && kinds[MATERIAL_WATER] == 0);
    stacks_destroy(&s);
}

/* ---- coming to rest */

/* The steepest that loose material stands above what it could slide into, deg over its repose: every pair of
 * spaces of neighbouring stacks, straight from the layers. */
struct room {
    double floor, ceiling, sand, rock;
};

static int rooms_of(const struct stacks *s, int i, int j, struct room out[64])
{
    size_t n;
    int count = 0;
    bool open = false;
    double bottom = 0;
    const uint32_t *layer = stacks_column(s, i, j, &n);
    for (size_t k = 0; k <= n; k++) {
        double top = k < n ? layer_top(layer[k]) * s->quantum : STACK_TOP * s->quantum;
        uint32_t m = k < n ? layer_material(layer[k]) : MATERIAL_AIR;
        if (m == MATERIAL_BEDROCK) {
            open = false;
        } else {
            if (!open)
                out[count++] = (struct room){bottom, 0, 0, 0};
            open = true;
            out[count - 1].ceiling = top;
            out[count - 1].sand += m == MATERIAL_SAND ? top - bottom : 0;
            out[count - 1].rock += m == MATERIAL_ROCK ? top - bottom : 0;
            /* Sorted: no sand above rock, nothing loose above air. */
            if (m == MATERIAL_SAND)
                assert_true(fabs(bottom - out[count - 1].floor) < 1e-9);
            if (m == MATERIAL_ROCK)
                assert_true(fabs(bottom - out[count - 1].floor - out[count - 1].sand) < 1e-9);
        }
        bottom = top;
    }
    return count;
}

static double steepest(const struct stacks *s, bool rock)
{
    double worst = -90, repose = table[rock ? MATERIAL_ROCK : MATERIAL_SAND].repose_deg;
    for (int j = 0; j < s->n[1]; j++)
        for (int i = 0; i < s->n[0]; i++) {
            struct room own[64], other[64];
            int n_own = rooms_of(s, i, j, own);
            for (int d = 0; d < 9; d++) {
                int a = i + d % 3 - 1, b = j + d / 3 - 1;
                if (d == 4 || a < 0 || b < 0 || a >= s->n[0] || b >= s->n[1])
                    continue;
                double away = s->cell * hypot(d % 3 - 1, d / 3 - 1);
                int n_other = rooms_of(s, a, b, other);
                for (int x = 0; x < n_own; x++)
                    for (int y = 0; y < n_other; y++) {
                        double h = own[x].floor + own[x].sand + (rock ? own[x].rock : 0);
                        double g = other[y].floor + other[y].sand + (rock ? other[y].rock : 0);
                        double room = other[y].ceiling - other[y].floor - other[y].sand - other[y].rock;
                        bool meet =
                            fmin(own[x].ceiling, other[y].ceiling) > fmax(own[x].floor, other[y].floor);
                        double amount = rock ? own[x].rock : own[x].sand;
                        if (!meet || amount < 1e-6 || room < 1e-6 || h <= other[y].floor)
                            continue;
                        double drop = fmin(h, g + room) - g;
                        /* It can fall no deeper than there is of it. */
                        if (drop > 0)
                            worst = fmax(worst, atan2(drop, away) * 180 / M_PI - repose);
                    }
            }
        }
    return worst;
}

enum { ALL_WALLS = WALL_X_MIN | WALL_X_MAX | WALL_Y_MIN | WALL_Y_MAX };

static struct stabilised rest(struct stacks *s, bool open_edges)
{
    struct stabilised out;
    struct stabilise options = {.table = table, .n_materials = N_TABLE, .walls = open_edges ? 0 : ALL_WALLS};
    assert_ok(stabilise(s, &options, (const int[]){0, 0}, s->n, &out));
    assert_true(out.resting);
    return out;
}

static void test_a_heap(void **state)
{
    (void)state;
    struct stacks s;
    assert_ok(stacks_create((const int[]){81, 81}, 1, 200, &s));
    put(&s, 0, 0, 80, 80, 0, 5, MATERIAL_BEDROCK);
    put(&s, 39, 39, 41, 41, 5, 105, MATERIAL_SAND);
    struct timespec t0, t1;
    clock_gettime(CLOCK_MONOTONIC, &t0);
    struct stabilised out = rest(&s, false);
    clock_gettime(CLOCK_MONOTONIC, &t1);
    double over = steepest(&s, false), height = 0;
    size_t n;
    const uint32_t *layer = stacks_column(&s, 40, 40, &n);
    height = layer_top(layer[n - 1]) * s.quantum - 5;
    /* A cone of 900 m3 at 32 degrees: V = pi h^3 / (3 tan^2). */
    double cone = cbrt(900 * 3 / M_PI) * pow(tan(32 * M_PI / 180), 2.0 / 3);
    print_message(
        "# 900 m3 of sand: %lld sweeps, %lld moves, %.0f ms; steepest %+.3f deg over repose; %.2f m "
        "high, a cone would be %.2f m\n",
        (long long)out.sweeps, (long long)out.moves,
        1e3 * (double)(t1.tv_sec - t0.tv_sec) + 1e-6 * (double)(t1.tv_nsec - t0.tv_nsec), over, height, cone);
    assert_true(over < 0.5);
    assert_true(fabs(height - cone) < 0.08 * cone);
    stacks_destroy(&s);
}

/* Through a hole, and over the edge of a ledge with room under it. */
static void test_falls_through_and_over(void **state)
{
    (void)state;
    struct stacks s;
    assert_ok(stacks_create((const int[]){41, 41}, 1, 64, &s));
    put(&s, 0, 0, 40, 40, 0, 4, MATERIAL_BEDROCK);
    put(&s, 0, 0, 30, 40, 20, 24, MATERIAL_BEDROCK); /* a roof, open on one side */
    put(&s, 10, 20, 10, 20, 20, 24, MATERIAL_AIR);   /* with a hole */
    put(&s, 5, 15, 15, 25, 24, 30, MATERIAL_SAND);
    put(&s, 26, 5, 30, 9, 24, 34, MATERIAL_ROCK);
    uint64_t before[MATERIALS_MAX], after[MATERIALS_MAX];
    stacks_amounts(&s, before);
    rest(&s, false);
    stacks_amounts(&s, after);
    assert_int_equal(before[MATERIAL_SAND], after[MATERIAL_SAND]);
    assert_int_equal(before[MATERIAL_ROCK], after[MATERIAL_ROCK]);
    struct room r[64];
    assert_int_equal(rooms_of(&s, 9, 20, r), 2); /* under the roof, and on it */
    rooms_of(&s, 10, 20, r);
    double sand = r[0].sand;
    rooms_of(&s, 31, 7, r);
    print_message("# under the hole %.2f m of sand; beyond the ledge %.2f m of rock\n", sand, r[0].rock);
    assert_true(sand > 3 && r[0].rock > 1);
    assert_true(steepest(&s, false) < 0.5 && steepest(&s, true) < 0.5);
    stacks_destroy(&s);
}

static void test_chaos_comes_to_rest(void **state)
{
    (void)state;
    double worst[2] = {-90, -90};
    int64_t most = 0;
    for (uint32_t seed = 0; seed < effort_of(100); seed++) {
        struct stacks s = make_chaos(24, seed);
        uint64_t before[MATERIALS_MAX], after[MATERIALS_MAX];
        stacks_amounts(&s, before);
        struct stabilised out = rest(&s, seed % 3 == 0);
        stacks_amounts(&s, after);
        for (int m = MATERIAL_BEDROCK; m < N_TABLE; m++)
            assert_int_equal(before[m], after[m] + out.left[m]);
        most = out.sweeps > most ? out.sweeps : most;
        for (int rock = 0; rock < 2; rock++)
            worst[rock] = fmax(worst[rock], steepest(&s, rock));
        if (seed < 20) { /* what rests stays */
            struct stabilised again = rest(&s, seed % 3 == 0);
            assert_int_equal(again.moves, 0);
        }
        stacks_destroy(&s);
    }
    print_message(
        "# %zu random scenes rest after at most %lld sweeps; sand %+.3f, rock %+.3f deg over repose; "
        "every quantum is there\n",
        effort_of(100), (long long)most, worst[0], worst[1]);
    assert_true(worst[0] < 0.5 && worst[1] < 0.5);
}

/* Sweep by sweep comes to the same place as at once. */
static void test_a_slide_in_parts(void **state)
{
    (void)state;
    struct stacks s = make_chaos(40, 9), slow;
    struct stabilised out;
    struct stabilise options = {.table = table, .n_materials = N_TABLE, .sweeps = 3};
    assert_ok(stacks_copy(&s, &slow));
    int calls = 0;
    do {
        assert_ok(stabilise(&slow, &options, (const int[]){0, 0}, slow.n, &out));
        calls++;
    } while (!out.resting && calls < 10000);
    print_message("# at rest after %d calls of 3 sweeps\n", calls);
    assert_true(out.resting && calls > 3);
    assert_true(steepest(&slow, false) < 0.5 && steepest(&slow, true) < 0.5);
    stacks_destroy(&s), stacks_destroy(&slow);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_columns),
        cmocka_unit_test(test_copies_share_what_is_not_edited),
        cmocka_unit_test(test_pure_and_half),
        cmocka_unit_test(test_equals_voxels),
        cmocka_unit_test(test_visible),
        cmocka_unit_test(test_visible_equals_faces),
        cmocka_unit_test(test_a_heap),
        cmocka_unit_test(test_falls_through_and_over),
        cmocka_unit_test(test_chaos_comes_to_rest),
        cmocka_unit_test(test_a_slide_in_parts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
