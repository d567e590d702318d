/* Rock of five hundred thin beds retreats alike at any spacing, from above and from the side: across beds time adds up, along them the
 * softest lead. */
#include "physics/beds.h"

static void five_hundred_beds_retreat_alike(void **state)
{
    (void)state;
    static const double spacing[] = {2, 1, 0.5};
    compare_retreats(0.1, 50, spacing, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(five_hundred_beds_retreat_alike)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
