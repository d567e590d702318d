/* Time between two timestamps of a device. */
#ifndef HOODOO_TIMESTAMP_H
#define HOODOO_TIMESTAMP_H

#include <stdint.h>

/* Nanoseconds between two timestamps of a counter with `bits` valid bits, which wraps around to 0 (with 36 bits, as on some devices,
 * after a minute to an hour and a half). A difference of half the range or more is taken as 0, because the timestamps of some drivers
 * step back a little. */
static inline uint64_t timestamp_ns(uint64_t from, uint64_t to, uint32_t bits, double ns_per_tick)
{
    const uint64_t range = bits < 64 ? (UINT64_C(1) << bits) - 1 : UINT64_MAX, ticks = (to - from) & range;
    const double ns = (double)ticks * ns_per_tick;
    return ticks > range / 2 || !(ns < 0x1p63) ? 0 : (uint64_t)ns;
}

#endif
