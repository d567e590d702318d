/* The compiled kernels, embedded at build time by src/embed_kernels.c. */
#ifndef HOODOO_KERNEL_SOURCE_H
#define HOODOO_KERNEL_SOURCE_H

#include <stddef.h>
#include <stdint.h>

#include "gpu/kernels.h"

/* How a kernel accesses its buffers: the same GLSL is compiled three times (shaders/shared/buffers.glsl). */
enum kernel_variant {
    VARIANT_TEXEL, /* reads through texel buffers, writes through storage buffers: the fastest on lavapipe */
    VARIANT_STORAGE, /* storage buffers only */
    VARIANT_WIDE,    /* device addresses only: for buffers larger than the device's storage-buffer range */
    VARIANTS
};

struct kernel_source {
    const char *name;     /* "stress_dot" */
    const char *bindings; /* such as "rF wV ": r read, w written; F float, U uint, V vec4 */
    const uint32_t *spirv[VARIANTS];
    size_t size[VARIANTS]; /* bytes */
};

extern const struct kernel_source *const kernel_source[KERNELS];

#endif
