/* Declarations shared by the files of src/gpu/; no other folder includes this. */
#ifndef HOODOO_GPU_INTERNAL_H
#define HOODOO_GPU_INTERNAL_H

#include <vulkan/vulkan.h>

#include "gpu/gpu.h"
#include "gpu/kernel_source.h"
#include "gpu/primitives.h"

enum {
    SLOTS = 3,                /* command buffers in flight */
    DISPATCHES_PER_SLOT = 96, /* keeps a submission well under a second; some drivers abort longer ones */
    BINDINGS_MAX = 16,
    PARAMS_MAX = 128, /* bytes of push constants that every device supports */
    GROUP = 64,       /* shaders/shared/buffers.glsl: local_size_x */
    STAGES_MAX = 32
};

struct gpu_buffer {
    char name[48];
    uint64_t id; /* of all buffers of this device, also those destroyed */
    size_t n, item;
    VkDeviceSize bytes;
    VkBuffer handle;
    VkDeviceMemory memory;
    void *mapped; /* NULL unless the host can map this memory */
    VkDeviceAddress address;
    VkBufferView view[3];   /* for F, U, V; created when first read as texels */
    uint64_t read, written; /* the barrier epoch in which it was last read or written */
};

struct pipeline {
    VkPipeline handle;
    VkPipelineLayout layout;
    VkDescriptorSetLayout set_layout;
};

struct slot {
    VkCommandBuffer commands;
    VkFence fence;
    VkQueryPool queries;
    VkBuffer addresses; /* for VARIANT_WIDE: BINDINGS_MAX addresses per dispatch */
    VkDeviceMemory addresses_memory;
    char *addresses_mapped;
    VkDescriptorSet address_set;
    bool submitted;
    uint32_t n_dispatches;
    struct {
        enum gpu_kernel kernel;
        int stage;
    } dispatch[DISPATCHES_PER_SLOT];
};

struct gpu {
    struct gpu_info info;
    struct gpu_options options;
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    VkPhysicalDeviceMemoryProperties memory;
    uint64_t range_limit, texel_limit, allocation_limit; /* in bytes, texels, bytes */
    uint32_t group_limit, timestamp_bits, n_allocations, allocations_limit, subgroup;
    double timestamp_ns;
    bool has_budget;
    bool maps; /* the host maps the buffers; otherwise copies go through `staging` */
    enum kernel_variant variant;
    VkCommandPool commands;
    struct slot slot[SLOTS];
    int current;
    bool recording;
    uint64_t epoch;             /* of barriers */
    struct condition condition; /* of what is being recorded; flags NULL: none */
    struct {
        PFN_vkCmdBeginConditionalRenderingEXT begin; /* NULL: the device cannot leave out dispatches */
        PFN_vkCmdEndConditionalRenderingEXT end;
    } conditions;
    struct pipeline pipeline[KERNELS][VARIANTS];
    struct sets *sets;
    VkDescriptorSetLayout address_layout;
    VkDescriptorPool address_pool;
    uint64_t n_buffers; /* ever created */
    VkBuffer staging;
    VkDeviceMemory staging_memory;
    char *staging_mapped;
    struct slot *staged[2]; /* the slot that last copied from or to each half of `staging` */
    status st;
    char message[1024];
    struct gpu_time stage[STAGES_MAX], kernel[KERNELS];
    int n_stages, current_stage;
    status (*ended)(void *user, const char *stage, const char *next); /* gpu_watch() */
    void *ended_user;
};

/* Bytes of a half of the staging buffer, and of the largest upload that is recorded with its data, which waits for nothing. */
enum { STAGING_BYTES = 4 << 20, UPDATE_BYTES = 4096 };

const char *vk_result_text(VkResult result);

/* Records the first failure of the device, after which all commands do nothing. */
void gpu_break(struct gpu *gpu, VkResult result, const char *call);
#define VK_TRY(gpu, call)                                                                                    \
    do {                                                                                                     \
        VkResult vk_result_ = (call);                                                                        \
        if (vk_result_ != VK_SUCCESS) {                                                                      \
            gpu_break(gpu, vk_result_, #call);                                                               \
            goto done;                                                                                       \
        }                                                                                                    \
    } while (0)

/* The recorded failure, with its message set for this thread. */
status gpu_status(const struct gpu *gpu);

/* Creates a Vulkan buffer bound to memory with the properties `wanted` and, if there is such memory, `preferred`. */
void raw_buffer_create(struct gpu *gpu, VkDeviceSize bytes, VkBufferUsageFlags usage,
                       VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred, VkBuffer *buffer,
                       VkDeviceMemory *memory);

/* The command buffer of the current slot, in the recording state. NULL after an error. */
VkCommandBuffer record_begin(struct gpu *gpu);

/* Waits until the slot's commands have run, if they were submitted. */
void slot_finish(struct gpu *gpu, struct slot *s);

/* One command's access to a buffer. */
struct access {
    struct gpu_buffer *buffer;
    bool write; /* false: it only reads */
};

/* Records a barrier before a command if one of its accesses conflicts with one since the last barrier. */
void record_accesses(struct gpu *gpu, VkCommandBuffer commands, const struct access *access, size_t n);

/* The descriptor sets of kernels that bind their buffers (descriptors.c). set_get() may submit what is recorded. VK_NULL_HANDLE after an
 * error. */
status sets_create(struct gpu *gpu);
void sets_destroy(struct gpu *gpu);
VkDescriptorSet set_get(struct gpu *gpu, const struct pipeline *p, enum gpu_kernel kernel,
                        enum kernel_variant variant, struct gpu_buffer *const *buffers, uint32_t n);

/* How a kernel accesses its binding i: 'F', 'U' or 'V', and the type of its descriptor. */
char binding_letter(enum gpu_kernel kernel, uint32_t i);
VkDescriptorType descriptor_type(enum gpu_kernel kernel, enum kernel_variant variant, uint32_t i);

/* The dispatches recorded from here on run only if the flag is not 0; fills and copies always do. A condition without flags ends that. */
void record_condition(struct gpu *gpu, struct condition condition);

const struct pipeline *pipeline_get(struct gpu *gpu, enum gpu_kernel kernel, enum kernel_variant variant);
VkBufferView buffer_view(struct gpu *gpu, struct gpu_buffer *buffer, char letter);

/* Before the instance is created: tells Mesa where to cache compiled kernels, or not to. After the device is created: allocates disk
 * space for the cache. */
void shader_cache_choose(void);
void shader_cache_hold(void);

bool slots_create(struct gpu *gpu);
void slots_destroy(struct gpu *gpu);
void pipelines_destroy(struct gpu *gpu);

#endif
