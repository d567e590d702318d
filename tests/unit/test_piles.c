/* Piles of rocks: cells that repeat, rocks that touch and never overlap, and where they are put. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/vector.h"
#include "piles/piles.h"

static struct pile_tile make(size_t rocks, uint32_t seed)
{
    struct pile_tile tile;
    struct pile_options options = {
        .radius = 0.5, .rocks = rocks, .erosion = 0.25, .contacts = 1, .detail = 3, .seed = seed};
    assert_ok(pile_tile_create(&options, &tile));
    return tile;
}

static void corner(const struct pile_rock *r, uint32_t v, double out[3])
{
    for (size_t a = 0; a < 3; a++)
        out[a] = (double)r->vertex[3 * (size_t)v + a];
}

/* Of a closed mesh, by tetrahedra from the centre. */
static double volume_of(const struct pile_tile *t, const struct pile_rock *r)
{
    double sum = 0;
    for (size_t f = 0; f < t->n_triangles; f++) {
        double p[3][3];
        for (int c = 0; c < 3; c++)
            corner(r, t->triangle[3 * f + (size_t)c], p[c]);
        sum += (p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
                p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
                p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0])) /
               6;
    }
    return sum;
}

static void test_spheres_and_periods(void **state)
{
    (void)state;
    struct pile_tile t = make(60, 3);
    double nearest = HUGE_VAL;
    assert_true(t.n >= 50 && t.n <= 70);
    for (size_t i = 0; i < t.n; i++)
        for (size_t j = 0; j < t.n; j++)
            for (int image = 0; image < 27; image++) {
                const int off[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
                double d[3];
                for (int a = 0; a < 3; a++)
                    d[a] = t.rock[j].center[a] + off[a] * t.side - t.rock[i].center[a];
                if (dot3(d, d) > 0)
                    nearest = fmin(nearest, sqrt(dot3(d, d)));
            }
    print_message("# %zu rocks in a tile of %.3f m; centres %.4f m apart or more (2 radii: %.1f)\n", t.n,
                  t.side, nearest, 2 * t.radius);
    assert_true(nearest >= 2 * t.radius - 1e-12);
    pile_tile_destroy(&t);
}

/* Every vertex of every rock is nearer to its own centre than to any other in the repeated tile, so that no two
 * rocks share anything but contact points; and random points are inside one rock at most. */
static void test_no_overlap(void **state)
{
    (void)state;
    struct pile_tile t = make(60, 4);
    double worst = -HUGE_VAL, fill = 0;
    for (size_t i = 0; i < t.n; i++) {
        const struct pile_rock *r = &t.rock[i];
        fill += volume_of(&t, r);
        for (uint32_t v = 0; v < r->n_vertices; v++) {
            double p[3];
            corner(r, v, p);
            for (size_t j = 0; j < t.n; j++)
                for (int image = 0; image < 27; image++) {
                    const int off[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
                    double d[3];
                    for (int a = 0; a < 3; a++)
                        d[a] = t.rock[j].center[a] + off[a] * t.side - r->center[a];
                    double length = sqrt(dot3(d, d));
                    if (length > 0)
                        worst = fmax(worst, dot3(p, d) / length - length / 2);
                }
        }
    }
    fill /= t.side * t.side * t.side;
    print_message(
        "# rocks fill %.1f %% of the tile; no vertex is beyond a face of its cell by more than %.1e m\n",
        100 * fill, worst);
    assert_true(worst < 1e-5);
    assert_true(fill > 0.3 && fill < 0.9);
    pile_tile_destroy(&t);
}

static void test_contacts(void **state)
{
    (void)state;
    struct pile_tile t = make(60, 5);
    size_t contacts = 0, alone = 0;
    double worst = 0, apart = 0, side = 0;
    for (size_t i = 0; i < t.n; i++) {
        const struct pile_rock *r = &t.rock[i];
        contacts += r->n_contacts;
        alone += r->n_contacts == 0;
        for (size_t c = 0; c < r->n_contacts; c++) {
            const struct pile_contact *k = &r->contact[c];
            double own = HUGE_VAL, other = HUGE_VAL;
            for (uint32_t v = 0; v < r->n_vertices; v++) {
                double p[3];
                corner(r, v, p);
                const double d[3] = {p[0] - k->at[0], p[1] - k->at[1], p[2] - k->at[2]};
                own = fmin(own, sqrt(dot3(d, d)));
            }
            for (uint32_t v = 0; v < t.rock[k->other].n_vertices; v++) {
                double p[3];
                corner(&t.rock[k->other], v, p);
                const double d[3] = {p[0] + k->shift[0] - k->at[0], p[1] + k->shift[1] - k->at[1],
                                     p[2] + k->shift[2] - k->at[2]};
                other = fmin(other, sqrt(dot3(d, d)));
            }
            worst = fmax(worst, fmax(own, other));
            apart += own + other;
            /* The other is where it says, a whole number of tiles off. */
            for (int a = 0; a < 3; a++) {
                double tiles = (k->shift[a] - (t.rock[k->other].center[a] - r->center[a])) / t.side;
                side = fmax(side, fabs(tiles - round(tiles)));
            }
        }
    }
    print_message("# %.1f contacts a rock; both rocks come within %.1e m of each (%.1e in the mean)\n",
                  (double)contacts / (double)t.n, worst, apart / (double)contacts / 2);
    assert_true(contacts > 6 * t.n && alone == 0);
    assert_true(worst < 1e-5 && side < 1e-9);
    pile_tile_destroy(&t);
}

static void test_rocks_are_solid(void **state)
{
    (void)state;
    struct pile_tile t = make(50, 6), again = make(50, 6);
    double smallest = HUGE_VAL, largest = 0;
    for (size_t i = 0; i < t.n; i++) {
        double v = volume_of(&t, &t.rock[i]);
        smallest = fmin(smallest, v);
        largest = fmax(largest, v);
        assert_memory_equal(t.rock[i].vertex, again.rock[i].vertex, 12 * t.rock[i].n_vertices);
    }
    print_message("# volumes %.3f to %.3f of a sphere's\n", smallest / (M_PI / 6), largest / (M_PI / 6));
    assert_true(smallest > 0.2 * M_PI / 6);
    /* Closed: every edge once in each direction. */
    int8_t *edge = calloc(t.rock[0].n_vertices * t.rock[0].n_vertices, 1);
    for (size_t f = 0; f < 3 * t.n_triangles; f++) {
        size_t a = t.triangle[f], b = t.triangle[f % 3 == 2 ? f - 2 : f + 1];
        edge[a * t.rock[0].n_vertices + b]++;
        edge[b * t.rock[0].n_vertices + a]--;
    }
    for (size_t k = 0; k < t.rock[0].n_vertices * t.rock[0].n_vertices; k++)
        assert_int_equal(edge[k], 0);
    free(edge);
    pile_tile_destroy(&t), pile_tile_destroy(&again);
}

/* A wedge of rocks: 0 to 6 m thick, over a floor that is 3 m high. */
static size_t wedge(void *user, double x, double y, double (*span)[2], size_t most)
{
    (void)user, (void)y;
    if (most < 1 || x < 10)
        return 0;
    span[0][0] = 3;
    span[0][1] = 3 + 0.2 * (x - 10);
    return 1;
}

static void test_places(void **state)
{
    (void)state;
    struct pile_tile t = make(60, 7);
    struct pile_place *place;
    size_t n;
    assert_ok(pile_place_all(&t, (const double[]){40, 30}, wedge, NULL, &place, &n));
    double deepest = 0;
    for (size_t i = 0; i < n; i++) {
        double top = 3 + 0.2 * (place[i].at[0] - 10);
        assert_true(place[i].at[0] >= 10 && place[i].at[2] >= 3 && place[i].at[2] < top);
        deepest = fmax(deepest, top - place[i].at[2]);
        for (int a = 0; a < 3; a++) { /* on the repeated tile */
            double tiles = (place[i].at[a] - t.rock[place[i].rock].center[a]) / t.side;
            assert_true(fabs(tiles - round(tiles)) < 1e-9);
        }
    }
    /* As many as there are centres to the volume of the layer's top. */
    double volume = 0;
    for (double x = 10; x < 40; x += 0.01)
        volume += 0.01 * 30 * fmin(0.2 * (x - 10), 2 * t.reach);
    double expected = volume * (double)t.n / (t.side * t.side * t.side);
    print_message(
        "# %zu rocks, expected %.0f; the deepest %.2f m below the top, the largest reaches %.2f m\n", n,
        expected, deepest, t.reach);
    assert_true(deepest <= 2 * t.reach);
    assert_true(fabs((double)n - expected) < 0.05 * expected);
    free(place);
    pile_tile_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spheres_and_periods),
        cmocka_unit_test(test_no_overlap),
        cmocka_unit_test(test_contacts),
        cmocka_unit_test(test_rocks_are_solid),
        cmocka_unit_test(test_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
