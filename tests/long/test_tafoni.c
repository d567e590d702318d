/* Tafoni have a size: holes of a cliff are as far apart at two spacings and with two seeds, and farther where damp air reaches farther. */
#include "physics/tafoni.h"

static const char on[] = "crust: 20, crust_kyr: 1, damp: 3";

static void holes_are_as_far_apart_at_any_spacing(void **state)
{
    (void)state;
    const struct tafoni first = weather_cliff(0.1, 9, 0.4, 1, 60, 0.14, on);
    const struct tafoni coarse = weather_cliff(0.125, 9, 0.4, 1, 60, 0.14, on);
    const struct tafoni other = weather_cliff(0.1, 9, 0.4, 2, 60, 0.14, on);
    const struct tafoni other_coarse = weather_cliff(0.125, 9, 0.4, 2, 60, 0.14, on);
    assert_true(fabs(coarse.apart / first.apart - 1) < 0.15 && fabs(coarse.kyr / first.kyr - 1) < 0.15);
    assert_true(fabs(other_coarse.apart / other.apart - 1) < 0.15);
    assert_true(fabs(other.apart / first.apart - 1) < 0.15);
    assert_true(first.n >= 40);
}

static void holes_follow_how_far_damp_reaches(void **state)
{
    (void)state;
    const struct tafoni near = weather_cliff(0.1, 9, 0.3, 1, 60, 0.14, on),
                        far = weather_cliff(0.1, 9, 0.7, 1, 60, 0.14, on);
    assert_true(far.apart > 1.25 * near.apart);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holes_are_as_far_apart_at_any_spacing),
        cmocka_unit_test(holes_follow_how_far_damp_reaches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
