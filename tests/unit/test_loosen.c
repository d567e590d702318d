/* What stands on nothing in stacks, against a flood fill of their layers one by one. */
#include "check.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "stacks/loosen.h"

enum { SOLID = 1 << MATERIAL_BEDROCK, SIDE = 24, LEVELS = 24 };

struct put {
    uint32_t lo, hi, material;
};

static status put_one(void *user, int i, int j, struct column *c)
{
    const struct put *p = user;
    (void)i, (void)j;
    return column_set(c, p->lo, p->hi, p->material);
}

/* Stacks i0..i1, j0..j1 between two levels of a metre. */
static void put(struct stacks *s, int i0, int j0, int i1, int j1, int lo, int hi, uint32_t material)
{
    struct put p = {stacks_quanta(s, lo), stacks_quanta(s, hi), material};
    assert_ok(stacks_edit(s, (const int[]){i0, j0}, (const int[]){i1, j1}, put_one, &p));
}

static struct stacks floor_of_rock(void)
{
    struct stacks s;
    assert_ok(stacks_create((const int[]){SIDE, SIDE}, 1, LEVELS, &s));
    put(&s, 0, 0, SIDE - 1, SIDE - 1, 0, 2, MATERIAL_BEDROCK);
    return s;
}

static uint32_t at(const struct stacks *s, int i, int j, int level)
{
    size_t n;
    const uint32_t *layer = stacks_column(s, i, j, &n);
    return column_at(layer, n, stacks_quanta(s, level + 0.5));
}

/* ---- pieces one can name */

static void test_named(void **state)
{
    (void)state;
    struct stacks s = floor_of_rock();
    int lo[2], hi[2];
    put(&s, 2, 2, 3, 3, 2, 12, MATERIAL_BEDROCK); /* a bridge on two piers */
    put(&s, 10, 2, 11, 3, 2, 12, MATERIAL_BEDROCK);
    put(&s, 2, 2, 11, 3, 10, 12, MATERIAL_BEDROCK);
    put(&s, 6, 2, 6, 2, 8, 10, MATERIAL_BEDROCK); /* what hangs from it */
    put(&s, 6, 6, 7, 7, 2, 5, MATERIAL_SAND);     /* a boulder on sand */
    put(&s, 6, 6, 7, 7, 5, 7, MATERIAL_BEDROCK);
    put(&s, 20, 20, 21, 21, 2, 6, MATERIAL_WATER); /* on water */
    put(&s, 20, 20, 21, 21, 6, 8, MATERIAL_BEDROCK);
    put(&s, 4, 15, 6, 17, 9, 11, MATERIAL_BEDROCK); /* in the air, with sand on it */
    put(&s, 4, 15, 6, 17, 11, 12, MATERIAL_SAND);
    put(&s, 12, 4, 12, 4, 14, 16, MATERIAL_BEDROCK); /* touches nothing but a corner */
    put(&s, 11, 3, 11, 3, 12, 16, MATERIAL_BEDROCK);
    assert_ok(loosen(&s, SOLID, lo, hi));
    assert_int_equal(at(&s, 6, 2, 11), MATERIAL_BEDROCK);
    assert_int_equal(at(&s, 6, 2, 8), MATERIAL_BEDROCK);
    assert_int_equal(at(&s, 6, 6, 6), MATERIAL_BEDROCK);
    assert_int_equal(at(&s, 11, 3, 15), MATERIAL_BEDROCK);
    assert_int_equal(at(&s, 20, 20, 7), MATERIAL_ROCK);
    assert_int_equal(at(&s, 5, 16, 10), MATERIAL_ROCK);
    assert_int_equal(at(&s, 5, 16, 11), MATERIAL_SAND);
    assert_int_equal(at(&s, 12, 4, 15), MATERIAL_ROCK);
    assert_true(lo[0] == 4 && lo[1] == 4 && hi[0] == 21 && hi[1] == 21);
    stacks_destroy(&s);
}

/* ---- anything, against cells of a metre */

static struct stacks anything(uint32_t seed)
{
    struct stacks s;
    assert_ok(stacks_create((const int[]){SIDE, SIDE}, 1, LEVELS, &s));
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++)
            for (int k = 0; k < 5; k++) {
                uint32_t h = random_hash(seed, (uint32_t)(j * SIDE + i), (uint32_t)k, 5);
                int lo = (int)(h % LEVELS), hi = lo + 1 + (int)(h / LEVELS % 4);
                put(&s, i, j, i, j, k ? lo : 0, hi < LEVELS ? hi : LEVELS, h / 1024 % 5);
            }
    return s;
}

struct cells {
    uint8_t material[LEVELS][SIDE][SIDE], held[LEVELS][SIDE][SIDE];
};

/* Rock holds rock beside and above it; a filling holds what it touches from below, and rock holds fillings. */
static bool holds(const struct cells *c, int x, int y, int z, int dx, int dy, int dz)
{
    int a = c->material[z][y][x], b = c->material[z + dz][y + dy][x + dx];
    bool solid_a = a == MATERIAL_BEDROCK, solid_b = b == MATERIAL_BEDROCK;
    bool loose_a = a == MATERIAL_SAND || a == MATERIAL_ROCK,
         loose_b = b == MATERIAL_SAND || b == MATERIAL_ROCK;
    if (solid_a && solid_b)
        return true;
    /* A full room carries both ways; one that is not full carries nothing, and asks nobody. */
    return dz != 0 && (solid_a || loose_a) && (solid_b || loose_b);
}

static void flood(struct cells *c)
{
    bool more = true;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            c->held[0][y][x] = c->material[0][y][x] != MATERIAL_AIR && c->material[0][y][x] != MATERIAL_WATER;
    while (more) {
        more = false;
        for (int z = 0; z < LEVELS; z++)
            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++)
                    for (int d = 0; d < 6 && !c->held[z][y][x]; d++) {
                        int s = d % 2 ? 1 : -1, dx = d / 2 == 0 ? s : 0, dy = d / 2 == 1 ? s : 0,
                            dz = d / 2 == 2 ? s : 0;
                        if (x + dx < 0 || x + dx >= SIDE || y + dy < 0 || y + dy >= SIDE || z + dz < 0 ||
                            z + dz >= LEVELS || !c->held[z + dz][y + dy][x + dx])
                            continue;
                        if (holds(c, x + dx, y + dy, z + dz, -dx, -dy, -dz)) {
                            c->held[z][y][x] = 1;
                            more = true;
                        }
                    }
    }
}

static void test_anything(void **state)
{
    (void)state;
    size_t rock = 0, loose = 0;
    struct cells *c = calloc(1, sizeof *c);
    assert_non_null(c);
    for (uint32_t seed = 0; seed < 60; seed++) {
        struct stacks s = anything(seed);
        uint64_t before[MATERIALS_MAX], after[MATERIALS_MAX];
        int lo[2], hi[2];
        memset(c, 0, sizeof *c);
        for (int z = 0; z < LEVELS; z++)
            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++)
                    c->material[z][y][x] = (uint8_t)at(&s, x, y, z);
        flood(c);
        stacks_amounts(&s, before);
        assert_ok(loosen(&s, SOLID, lo, hi));
        stacks_amounts(&s, after);
        assert_true(before[MATERIAL_BEDROCK] + before[MATERIAL_ROCK] ==
                    after[MATERIAL_BEDROCK] + after[MATERIAL_ROCK]);
        for (int z = 0; z < LEVELS; z++)
            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++) {
                    uint32_t was = c->material[z][y][x], is = at(&s, x, y, z);
                    if (was != MATERIAL_BEDROCK) {
                        assert_int_equal(is, was);
                        continue;
                    }
                    assert_int_equal(is, c->held[z][y][x] ? MATERIAL_BEDROCK : MATERIAL_ROCK);
                    *(c->held[z][y][x] ? &rock : &loose) += 1;
                }
        stacks_destroy(&s);
    }
    print_message("# %zu cells of bedrock stand, %zu became rock\n", rock, loose);
    assert_true(rock > 1000 && loose > 1000);
    free(c);
}

/* What stands stays as it is, to the last layer. */
static void test_nothing(void **state)
{
    (void)state;
    struct stacks s = floor_of_rock();
    int lo[2], hi[2];
    put(&s, 2, 2, 12, 12, 2, 12, MATERIAL_BEDROCK);
    put(&s, 4, 2, 6, 12, 3, 6, MATERIAL_AIR);
    size_t bytes = stacks_bytes(&s), layers = stacks_layers(&s);
    assert_ok(loosen(&s, SOLID, lo, hi));
    assert_true(lo[0] > hi[0]);
    assert_int_equal(stacks_bytes(&s), bytes);
    assert_int_equal(stacks_layers(&s), layers);
    stacks_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_named), cmocka_unit_test(test_anything),
                                       cmocka_unit_test(test_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
