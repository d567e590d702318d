/* Parameters of the kernels, read by both languages. Scalars only, so that layouts cannot differ. At most 128 bytes. */
#ifndef HOODOO_PARAMS_H
#define HOODOO_PARAMS_H

#ifdef __STDC_VERSION__
#include <stdint.h>
typedef uint32_t uint;
#define SHARED_SIZE(type, bytes) _Static_assert(sizeof(struct type) == (bytes), #type " drifted");
#else
#define SHARED_SIZE(type, bytes)
#endif

/* For kernels that need no more than a count. */
struct count_params {
    uint n;
};
SHARED_SIZE(count_params, 4)

#endif
