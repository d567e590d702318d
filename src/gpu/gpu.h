/* The only door to Vulkan: a device, buffers on it, and kernels over them.
 *
 * Calling sequence
 *   gpu_create -> gpu_buffer_create ... -> GPU_RUN / gpu_fill / gpu_copy (these only record) -> gpu_download
 *   or gpu_wait
 * Order      Recorded work behaves as if each command ended before the next began: the recorder knows what
 *            every command reads and writes, and puts barriers where they are needed. Nothing else does.
 * Errors     Recording never fails visibly: the first error sticks, later commands do nothing, and
 *            gpu_wait(), gpu_upload() and gpu_download() return it. After a device loss nothing read from the
 *            device may be believed.
 * Same bits  Kernels gather or add integers; results depend on the device and driver only, not on threads or
 *            timing.
 * Threads    One thread at a time.
 */
#ifndef HOODOO_GPU_H
#define HOODOO_GPU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "gpu/kernels.h"
#include "shared/params.h"

struct gpu;
struct gpu_buffer;

struct gpu_info {
    int index;        /* in gpu_list()'s order */
    char name[256];   /* "llvmpipe (LLVM 15.0.6, 256 bits)" */
    char driver[256]; /* driver name and version */
    char uuid[33];    /* deviceUUID, hex */
    char pci[16];     /* "0000:65:00.0", or "" if the driver does not say */
    char type[12];    /* "discrete", "integrated", "virtual", "cpu", "other" */
    uint64_t memory;  /* bytes of its largest local heap */
    bool is_cpu;
    bool usable; /* Vulkan 1.2 with what hoodoo needs */
};

/* All devices, usable or not; *out freed with free(). E_DEVICE: no Vulkan loader or driver. */
MUST_USE status gpu_list(struct gpu_info **out, size_t *n);

struct gpu_options {
    /* "auto" (or NULL): a discrete GPU before an integrated one before a CPU device. "INDEX", "uuid:HEX",
     * "pci:DDDD:BB:DD.F" name one. "slurm": the GPU Slurm gave this job; never a CPU device. */
    const char *device;
    /* For tests: force a kernel variant (enum kernel_variant + 1; 0: the device's own), or pretend that the
     * device binds at most this many bytes, refuses to allocate more than this at once, or allows this many
     * allocations (0: its own limits). */
    int variant;
    uint64_t range_limit, allocation_limit;
    uint32_t allocations_limit;
};

/* E_DEVICE if there is no such device; the message lists those there are. */
MUST_USE status gpu_create(const struct gpu_options *options, struct gpu **out);
void gpu_destroy(struct gpu **gpu);
const struct gpu_info *gpu_info(const struct gpu *gpu);

/* What the device allows, as it says or as the options pretend. */
struct gpu_limits {
    uint64_t range;  /* bytes of a buffer that a kernel binds; larger ones are reached by their addresses */
    uint64_t texels; /* items of one that is read as texels */
    uint64_t allocation;     /* bytes in one piece that the device promises */
    uint32_t allocations;    /* how many at once */
    uint32_t subgroup;       /* threads that go in step */
    uint32_t timestamp_bits; /* 0: the device has no clock, and no kernel's time is known */
    const char *variant;     /* how kernels reach their buffers: "texel", "storage", "wide" */
};
struct gpu_limits gpu_limits(const struct gpu *gpu);

/* Bytes that can still be allocated, as far as device and host tell. */
uint64_t gpu_memory_free(const struct gpu *gpu);

/* Kernels count in 32 bits, and round threads up to whole groups: no buffer has more items, no dispatch more threads, so that none
 * of their counts wraps. */
#define GPU_ITEMS_MAX ((size_t)4294966272)

/* n items of `item` bytes (4: float or uint; 16: vec4), zeroed. E_MEMORY names the buffer and its size. */
MUST_USE status gpu_buffer_create(struct gpu *gpu, const char *name, size_t n, size_t item,
                                  struct gpu_buffer **out);
void gpu_buffer_destroy(struct gpu *gpu, struct gpu_buffer **buffer);
size_t gpu_buffer_count(const struct gpu_buffer *buffer);
size_t gpu_buffer_item(const struct gpu_buffer *buffer);

/* Records `threads` invocations of a kernel with its parameters and its buffers, in the order of its
 * bindings. */
void gpu_dispatch(struct gpu *gpu, enum gpu_kernel kernel, size_t threads, const void *params,
                  size_t params_size, struct gpu_buffer *const *buffers, size_t n_buffers);
#define GPU_RUN(gpu, kernel, threads, params, ...)                                                           \
    gpu_dispatch(gpu, KERNEL_##kernel, threads, &(params), sizeof(params),                                   \
                 (struct gpu_buffer *const[]){__VA_ARGS__},                                                  \
                 sizeof((struct gpu_buffer *const[]){__VA_ARGS__}) / sizeof(struct gpu_buffer *))

/* Every word of the buffer. */
void gpu_fill(struct gpu *gpu, struct gpu_buffer *buffer, uint32_t word);
void gpu_copy(struct gpu *gpu, struct gpu_buffer *to, const struct gpu_buffer *from, size_t n_items);

/* Wait for all recorded work, then move bytes between host memory and a buffer, from its item `first` on. */
MUST_USE status gpu_upload(struct gpu *gpu, struct gpu_buffer *to, size_t first, const void *from,
                           size_t n_items);
MUST_USE status gpu_download(struct gpu *gpu, const struct gpu_buffer *from, size_t first, void *to,
                             size_t n_items);

/* Start what is recorded without waiting. */
void gpu_submit(struct gpu *gpu);
MUST_USE status gpu_wait(struct gpu *gpu);

/* Device time, by stage (named with gpu_stage; the name must be a literal) and by kernel. */
struct gpu_time {
    const char *name;
    uint64_t ns, dispatches;
};
void gpu_stage(struct gpu *gpu, const char *name);

/* From now on `ended` is called when a stage ends, which is where another begins (a part of it, named "STAGE PART", is none); NULL: no more. It may use the device; its time is that of a stage "numbers". An error of
 * its sticks like the device's own. */
void gpu_watch(struct gpu *gpu, status (*ended)(void *user, const char *stage, const char *next), void *user);
size_t gpu_stage_times(const struct gpu *gpu, const struct gpu_time **times);
const struct gpu_time *gpu_kernel_time(const struct gpu *gpu, enum gpu_kernel kernel);
void gpu_times_reset(struct gpu *gpu);

#endif
