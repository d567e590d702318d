/* The closest particle's value, against looking at all of them; and places that are far apart. */
#include "check.h"

#include <math.h>
#include <stdlib.h>

#include "base/random.h"
#include "render/closest.h"

enum { POINTS = 300, PARTICLES = 2000 };

static float number(uint32_t i, uint32_t what, float low, float high)
{
    return low + (high - low) * (float)(random_hash(i, what, 5, 1) >> 8) / (float)(1 << 24);
}

static void the_closest_one_is_taken(void **state)
{
    (void)state;
    static float point[3 * POINTS], particle[4 * PARTICLES], value[PARTICLES], got[POINTS];
    size_t none = 0;
    for (int round = 0; round < 6; round++) {
        /* Few cells and many; flat clouds too. */
        double reach = (double[]){0.3, 1, 5, 0.05, 1, 100}[round];
        float thick = round == 4 ? 0 : 8;
        for (uint32_t i = 0; i < PARTICLES; i++) {
            for (uint32_t k = 0; k < 3; k++) /* on a lattice, so that some are as close as others */
                particle[4 * i + k] =
                    roundf(4 * number(i, k + 10 * (uint32_t)round, 0, k == 2 ? thick : 10)) / 4;
            value[i] = 1 + number(i, 3, 0, 1);
        }
        for (uint32_t i = 0; i < POINTS; i++) {
            for (uint32_t k = 0; k < 3; k++)
                point[3 * i + k] = number(i, 4 + k, -2, 12);
            got[i] = 0;
        }
        assert_ok(closest_values(point, POINTS, particle, value, PARTICLES, reach, got));
        for (size_t i = 0; i < POINTS; i++) {
            double best = reach * reach;
            float want = 0;
            for (size_t k = 0; k < PARTICLES; k++) {
                double d = 0;
                for (size_t a = 0; a < 3; a++)
                    d += pow((double)particle[4 * k + a] - (double)point[3 * i + a], 2);
                if (d < best) {
                    best = d;
                    want = value[k];
                }
            }
            none += want == 0;
            assert_float_equal(got[i], want, 0);
        }
    }
    print_message("# %d points, %zu of them with nothing in reach\n", 6 * POINTS, none);
    assert_in_range(none, 100, 6 * POINTS - 100);
}

static void nothing_and_nowhere(void **state)
{
    (void)state;
    float point[3] = {0}, out[1] = {0}, value[2] = {1, 2};
    float far[8] = {0, 0, 0, 0, 1e30F, 1e30F, 1e30F, 0}, nowhere[4] = {0, NAN, 0, 0};
    assert_ok(closest_values(point, 1, far, value, 0, 1, out));
    assert_true(out[0] == 0);
    assert_int_equal(closest_values(point, 1, far, value, 2, 1, out), E_INPUT);
    assert_int_equal(closest_values(point, 1, nowhere, value, 1, 1, out), E_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_closest_one_is_taken),
        cmocka_unit_test(nothing_and_nowhere),
    };
    return cmocka_run_group_tests_name("closest", tests, NULL, NULL);
}
