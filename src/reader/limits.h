/* The resources that a reader may use, by the size of its file. Compressed voxels take many times their size in memory. */
#ifndef HOODOO_READER_LIMITS_H
#define HOODOO_READER_LIMITS_H

#include <stdint.h>

/* Seconds of CPU time. */
static inline double reader_cpu_seconds(uint64_t file_size)
{
    const uint64_t more = file_size >> 22;
    return 60 + (double)(more < 36000 ? more : 36000);
}

/* Bytes of memory; `base` is what even a small file may need. */
static inline uint64_t reader_memory(uint64_t base, uint64_t file_size)
{
    return file_size > (UINT64_MAX - base) / 64 ? UINT64_MAX : base + 64 * file_size;
}

#endif
