/* Time between two stamps of a device's counter. */
#ifndef HOODOO_TIMESTAMP_H
#define HOODOO_TIMESTAMP_H

#include <stdint.h>

/* Nanoseconds from one stamp to a later one of a counter that has `bits` valid bits (36 on some devices, which is a
 * minute to an hour and a half) and begins again at 0 after them. Half the counter's range or more is no time that
 * passed: some drivers' stamps step back a little. That is 0. */
static inline uint64_t timestamp_ns(uint64_t from, uint64_t to, uint32_t bits, double ns_per_tick)
{
    const uint64_t range = bits < 64 ? (UINT64_C(1) << bits) - 1 : UINT64_MAX, ticks = (to - from) & range;
    const double ns = (double)ticks * ns_per_tick;
    return ticks > range / 2 || !(ns < 0x1p63) ? 0 : (uint64_t)ns;
}

#endif
