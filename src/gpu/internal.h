/* What the files of src/gpu/ share. Nothing outside this folder includes it. */
#ifndef HOODOO_GPU_INTERNAL_H
#define HOODOO_GPU_INTERNAL_H

#include <vulkan/vulkan.h>

#include "gpu/gpu.h"
#include "gpu/kernel_source.h"

enum {
    SLOTS = 3,                /* command buffers in flight */
    DISPATCHES_PER_SLOT = 96, /* a submission stays well under a second, which some drivers insist on */
    BINDINGS_MAX = 16,
    PARAMS_MAX = 128, /* bytes of push constants every device has */
    GROUP = 64,       /* shaders/shared/buffers.glsl: local_size_x */
    STAGES_MAX = 32
};

struct gpu_buffer {
    char name[48];
    size_t n, item;
    VkDeviceSize bytes;
    VkBuffer handle;
    VkDeviceMemory memory;
    void *mapped; /* where device memory is host memory, else NULL */
    VkDeviceAddress address;
    VkBufferView view[3];   /* by letter: F, U, V; made when first read as texels */
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
    VkDescriptorPool pool;
    VkQueryPool queries;
    VkBuffer addresses; /* for VARIANT_WIDE: BINDINGS_MAX addresses a dispatch */
    VkDeviceMemory addresses_memory;
    char *addresses_mapped;
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
    uint64_t range_limit, texel_limit, allocation_limit; /* of bytes, texels, bytes */
    uint32_t group_limit, timestamp_bits, n_allocations, allocations_limit, subgroup;
    double timestamp_ns;
    bool has_budget;
    enum kernel_variant variant;
    VkCommandPool commands;
    struct slot slot[SLOTS];
    int current;
    bool recording;
    uint64_t epoch; /* of barriers */
    struct pipeline pipeline[KERNELS][VARIANTS];
    VkBuffer staging;
    VkDeviceMemory staging_memory;
    char *staging_mapped;
    status st;
    char message[1024];
    struct gpu_time stage[STAGES_MAX], kernel[KERNELS];
    int n_stages, current_stage;
    status (*ended)(void *user, const char *stage, const char *next); /* gpu_watch() */
    void *ended_user;
};

enum { STAGING_BYTES = 16 << 20 };

const char *vk_result_text(VkResult result);

/* Notes the first failure of the device; everything after does nothing. */
void gpu_break(struct gpu *gpu, VkResult result, const char *call);
#define VK_TRY(gpu, call)                                                                                    \
    do {                                                                                                     \
        VkResult vk_result_ = (call);                                                                        \
        if (vk_result_ != VK_SUCCESS) {                                                                      \
            gpu_break(gpu, vk_result_, #call);                                                               \
            goto done;                                                                                       \
        }                                                                                                    \
    } while (0)

/* The sticky error, said again on this thread. */
status gpu_status(const struct gpu *gpu);

/* A Vulkan buffer with bound memory that has all of `wanted`, preferably `preferred` too. */
void raw_buffer_create(struct gpu *gpu, VkDeviceSize bytes, VkBufferUsageFlags usage,
                       VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred, VkBuffer *buffer,
                       VkDeviceMemory *memory);

/* The current slot's command buffer, recording. NULL after an error. */
VkCommandBuffer record_begin(struct gpu *gpu);

/* What one command does to a buffer. */
struct access {
    struct gpu_buffer *buffer;
    bool write; /* else it only reads */
};

/* Puts a barrier before a command if any of its accesses conflicts with one since the last barrier. */
void record_accesses(struct gpu *gpu, VkCommandBuffer commands, const struct access *access, size_t n);

const struct pipeline *pipeline_get(struct gpu *gpu, enum gpu_kernel kernel, enum kernel_variant variant);
VkBufferView buffer_view(struct gpu *gpu, struct gpu_buffer *buffer, char letter);

/* Before an instance is made: where Mesa keeps compiled kernels, or that it keeps none. After a device is: room for that. */
void shader_cache_choose(void);
void shader_cache_hold(void);

bool slots_create(struct gpu *gpu);
void slots_destroy(struct gpu *gpu);
void pipelines_destroy(struct gpu *gpu);

#endif
