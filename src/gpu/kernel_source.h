/* The compiled kernels, embedded at build time by src/embed_kernels.c. */
#ifndef HOODOO_KERNEL_SOURCE_H
#define HOODOO_KERNEL_SOURCE_H

#include <stddef.h>
#include <stdint.h>

#include "gpu/kernels.h"

/* How a kernel reaches its buffers: the same GLSL, compiled three ways (shaders/shared/buffers.glsl). */
enum kernel_variant {
    VARIANT_TEXEL,   /* reads through texel buffers, writes through storage buffers: fastest on lavapipe */
    VARIANT_STORAGE, /* storage buffers for all */
    VARIANT_WIDE,    /* device addresses for all: buffers beyond the device's storage-buffer range */
    VARIANTS
};

struct kernel_source {
    const char *name;     /* "stress_dot" */
    const char *bindings; /* "rF wV ": read or write; F float, U uint, V vec4 */
    const uint32_t *spirv[VARIANTS];
    size_t size[VARIANTS]; /* bytes */
};

extern const struct kernel_source *const kernel_source[KERNELS];

#endif
