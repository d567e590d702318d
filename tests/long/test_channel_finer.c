/* A river's channel, and a step in its bed, are the same at spacings of 2, 1 and half a metre. */
#include "physics/channel.h"

static void a_channel_does_not_depend_on_the_spacing(void **state)
{
    (void)state;
    channels_are_the_same(2, 1);
    channels_are_the_same(1, 0.5);
    channels_are_the_same(2, 0.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_channel_does_not_depend_on_the_spacing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
