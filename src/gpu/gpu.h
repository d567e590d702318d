/* The only interface to Vulkan: a device, buffers on it, and kernels that run over them.
 *
 * Calling sequence   gpu_create(); gpu_buffer_create(); GPU_RUN(), gpu_fill(), gpu_copy(), which only record; gpu_download() or
 *                    gpu_wait().
 * Order      Recorded commands behave as if each ended before the next began. The recorder knows which buffers each command reads and
 *            writes, and inserts barriers where they are needed; callers never do.
 * Errors     Recording does not return errors. The first error is sticky: later commands do nothing, and gpu_wait(), gpu_upload() and
 *            gpu_download() return it. After a device is lost, data read from it are invalid.
 * Same bits  Kernels gather, or add integers, so results depend on the device and driver but not on threads or timing.
 * Threads    Not thread-safe: only one thread may use a device at a time.
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
    int index;        /* in the order of gpu_list() */
    char name[256];   /* "llvmpipe (LLVM 15.0.6, 256 bits)" */
    char driver[256]; /* driver name and version */
    char uuid[33];    /* deviceUUID, hex */
    char pci[16];     /* "0000:65:00.0", or "" if the driver does not report it */
    char type[12];    /* "discrete", "integrated", "virtual", "cpu", "other" */
    uint64_t memory;  /* bytes of its largest device-local heap */
    bool is_cpu;
    bool usable; /* has Vulkan 1.2 and the features that hoodoo needs */
};

/* All devices, usable or not; *out is freed with free(). E_DEVICE: there is no Vulkan loader or driver. */
MUST_USE status gpu_list(struct gpu_info **out, size_t *n);

struct gpu_options {
    /* "auto" or NULL: prefers a discrete GPU to an integrated one, and that to a CPU device. "INDEX", "uuid:HEX" or
     * "pci:DDDD:BB:DD.F" selects a device. "slurm": the GPU that Slurm assigned to this job, never a CPU device. */
    const char *device;
    /* For tests. variant: forces a kernel variant (enum kernel_variant + 1; 0: the device's preferred one). The limits replace those of
     * the device: bytes that can be bound, bytes of one allocation, number of allocations (0: the device's own). staged: copies to and from
     * buffers as for memory that the host cannot map, also on a CPU. unconditional: does not use VK_EXT_conditional_rendering. */
    int variant;
    bool staged, unconditional;
    uint64_t range_limit, allocation_limit;
    uint32_t allocations_limit;
};

/* E_DEVICE if there is no such device; the message lists the devices. */
MUST_USE status gpu_create(const struct gpu_options *options, struct gpu **out);
void gpu_destroy(struct gpu **gpu);
const struct gpu_info *gpu_info(const struct gpu *gpu);

/* The limits of the device, or those that gpu_options sets. */
struct gpu_limits {
    uint64_t range;          /* bytes of a bound buffer; kernels access larger buffers by device address */
    uint64_t texels;         /* items of a texel buffer */
    uint64_t allocation;     /* bytes of one allocation that the device promises */
    uint32_t allocations;    /* number of allocations */
    uint32_t subgroup;       /* threads of a subgroup */
    uint32_t timestamp_bits; /* 0: the device has no timestamps, and times of kernels are unknown */
    const char *variant;     /* how kernels access buffers: "texel", "storage" or "wide" */
};
struct gpu_limits gpu_limits(const struct gpu *gpu);

/* An estimate of the bytes that can still be allocated, from the device's memory budget and the host's free memory. */
uint64_t gpu_memory_free(const struct gpu *gpu);

/* The most items of a buffer and threads of a dispatch. Kernels use 32-bit indices and round threads up to whole groups, so indices
 * never wrap around. */
#define GPU_ITEMS_MAX ((size_t)4294966272)

/* Allocates n items of `item` bytes (4: float or uint; 16: vec4), set to zero. E_MEMORY, with the buffer's name and size. */
MUST_USE status gpu_buffer_create(struct gpu *gpu, const char *name, size_t n, size_t item,
                                  struct gpu_buffer **out);
void gpu_buffer_destroy(struct gpu *gpu, struct gpu_buffer **buffer);
size_t gpu_buffer_count(const struct gpu_buffer *buffer);
size_t gpu_buffer_item(const struct gpu_buffer *buffer);

/* Records a dispatch of `threads` threads of a kernel, with its parameters (push constants) and its buffers in the order of its
 * bindings. */
void gpu_dispatch(struct gpu *gpu, enum gpu_kernel kernel, size_t threads, const void *params,
                  size_t params_size, struct gpu_buffer *const *buffers, size_t n_buffers);
#define GPU_RUN(gpu, kernel, threads, params, ...)                                                           \
    gpu_dispatch(gpu, KERNEL_##kernel, threads, &(params), sizeof(params),                                   \
                 (struct gpu_buffer *const[]){__VA_ARGS__},                                                  \
                 sizeof((struct gpu_buffer *const[]){__VA_ARGS__}) / sizeof(struct gpu_buffer *))

/* Records setting every 32-bit word of the buffer, and copying the first n_items. */
void gpu_fill(struct gpu *gpu, struct gpu_buffer *buffer, uint32_t word);
void gpu_copy(struct gpu *gpu, struct gpu_buffer *to, const struct gpu_buffer *from, size_t n_items);

/* Copy items between host memory and a buffer, starting at its item `first`, behind all work recorded before. gpu_upload() has read `from`
 * when it returns, and waits for the device only with large data; gpu_download() waits. */
MUST_USE status gpu_upload(struct gpu *gpu, struct gpu_buffer *to, size_t first, const void *from,
                           size_t n_items);
MUST_USE status gpu_download(struct gpu *gpu, const struct gpu_buffer *from, size_t first, void *to,
                             size_t n_items);

/* Submits the recorded work without waiting; gpu_wait() also waits for it. */
void gpu_submit(struct gpu *gpu);
MUST_USE status gpu_wait(struct gpu *gpu);

/* Device time and number of dispatches, by stage and by kernel. gpu_stage() names the stage of the commands that follow; the name must
 * be a literal. A name such as "STAGE PART" is a part of STAGE and does not end it. */
struct gpu_time {
    const char *name;
    uint64_t ns, dispatches;
};
void gpu_stage(struct gpu *gpu, const char *name);

/* Sets a callback that gpu_stage() calls whenever a stage ends and another begins; NULL removes it. The callback may use the device,
 * and its time is counted as a stage "numbers". An error that it returns is sticky, like those of the device. */
void gpu_watch(struct gpu *gpu, status (*ended)(void *user, const char *stage, const char *next), void *user);
size_t gpu_stage_times(const struct gpu *gpu, const struct gpu_time **times);
const struct gpu_time *gpu_kernel_time(const struct gpu *gpu, enum gpu_kernel kernel);
void gpu_times_reset(struct gpu *gpu);

#endif
