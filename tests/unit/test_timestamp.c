/* Times of counters that begin again, as devices have them. */
#include "check.h"

#include "gpu/timestamp.h"

static void time_passes(void **state)
{
    (void)state;
    assert_int_equal(timestamp_ns(1000, 1100, 64, 1), 100);
    assert_int_equal(timestamp_ns(1000, 1100, 64, 10.5), 1050);
    assert_int_equal(timestamp_ns(7, 7, 36, 83.333), 0);
    assert_int_equal(timestamp_ns(0, UINT64_C(1) << 35, 36, 1), 0); /* half its range: it stepped back */
    assert_int_equal(timestamp_ns(0, (UINT64_C(1) << 35) - 1, 36, 1), (UINT64_C(1) << 35) - 1);
}

static void a_counter_begins_again(void **state)
{
    (void)state;
    const uint32_t bits[] = {32, 36, 48, 63, 64};
    for (size_t i = 0; i < sizeof bits / sizeof *bits; i++) {
        const uint64_t range = bits[i] < 64 ? (UINT64_C(1) << bits[i]) - 1 : UINT64_MAX;
        const uint64_t from = range - 10, to = (from + 100) & range;
        assert_int_equal(timestamp_ns(from, to, bits[i], 1), 100);
        assert_int_equal(timestamp_ns(from, to, bits[i], 83.333), 8333);
    }
}

static void a_counter_that_steps_back_counts_nothing(void **state)
{
    (void)state;
    assert_int_equal(timestamp_ns(1000, 990, 36, 83.333), 0);
    assert_int_equal(timestamp_ns(1000, 990, 64, 83.333), 0);
    assert_int_equal(timestamp_ns(0, INT64_MAX, 64, 83.333), 0); /* more than a number of ns can say */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(time_passes),
        cmocka_unit_test(a_counter_begins_again),
        cmocka_unit_test(a_counter_that_steps_back_counts_nothing),
    };
    return cmocka_run_group_tests_name("timestamp", tests, NULL, NULL);
}
