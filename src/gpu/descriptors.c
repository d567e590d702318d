/* Descriptor sets of kernels that bind their buffers: one is made for each pipeline and list of buffers, and kept, since most dispatches
 * repeat an earlier one. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/internal.h"

/* Sets of the pool; its descriptors of each kind, of which a set has a few; places of the table, which is at most half full. */
enum { SETS_MOST = 2048, DESCRIPTORS_MOST = 8 * SETS_MOST, PLACES = 2 * SETS_MOST };

/* A pipeline and its buffers, by their ids. Ids are never used again, so sets of destroyed buffers are not found. */
struct key {
    const struct pipeline *pipeline;
    uint64_t buffer[BINDINGS_MAX];
};

struct sets {
    VkDescriptorPool pool;
    uint32_t n;
    struct {
        struct key key;
        VkDescriptorSet set; /* VK_NULL_HANDLE: the place is free */
    } place[PLACES];
};

status sets_create(struct gpu *gpu)
{
    status st = OK;
    TRY(memory_alloc(1, sizeof *gpu->sets, "descriptor sets", &gpu->sets));
    VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, DESCRIPTORS_MOST},
                                    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, DESCRIPTORS_MOST}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = SETS_MOST,
                                       .poolSizeCount = 2,
                                       .pPoolSizes = sizes};
    VK_TRY(gpu, vkCreateDescriptorPool(gpu->device, &pool, NULL, &gpu->sets->pool));
done:
    return st != OK ? st : gpu_status(gpu);
}

void sets_destroy(struct gpu *gpu)
{
    if (gpu->sets)
        vkDestroyDescriptorPool(gpu->device, gpu->sets->pool, NULL);
    free(gpu->sets);
}

static struct key key_of(const struct pipeline *pipeline, struct gpu_buffer *const *buffers, uint32_t n)
{
    struct key key = {.pipeline = pipeline};
    for (uint32_t i = 0; i < n; i++)
        key.buffer[i] = buffers[i]->id;
    return key;
}

/* The place of the key, or the free one where it belongs. */
static uint32_t find(const struct sets *s, const struct key *key)
{
    uint64_t hash = (uint64_t)(uintptr_t)key->pipeline;
    for (int i = 0; i < BINDINGS_MAX; i++)
        hash = (hash ^ key->buffer[i]) * UINT64_C(0x9e3779b97f4a7c15) ^ hash >> 29;
    uint32_t at = (uint32_t)(hash >> 32) % PLACES;
    while (s->place[at].set && memcmp(&s->place[at].key, key, sizeof *key) != 0)
        at = (at + 1) % PLACES;
    return at;
}

/* No command that uses a set may be pending when the sets are given back. */
static void forget_all(struct gpu *gpu)
{
    struct sets *s = gpu->sets;
    if (gpu_wait(gpu) != OK)
        return;
    VK_TRY(gpu, vkResetDescriptorPool(gpu->device, s->pool, 0));
    memset(s->place, 0, sizeof s->place);
    s->n = 0;
done:;
}

static VkDescriptorSet allocate(struct gpu *gpu, const struct pipeline *p)
{
    VkDescriptorSet set = VK_NULL_HANDLE;
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = gpu->sets->pool,
                                        .descriptorSetCount = 1,
                                        .pSetLayouts = &p->set_layout};
    VkResult result = gpu->sets->n < SETS_MOST ? vkAllocateDescriptorSets(gpu->device, &info, &set)
                                               : VK_ERROR_OUT_OF_POOL_MEMORY;
    if (result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL) {
        forget_all(gpu);
        result = gpu->st == OK ? vkAllocateDescriptorSets(gpu->device, &info, &set) : VK_SUCCESS;
    }
    VK_TRY(gpu, result);
done:
    return gpu->st == OK ? set : VK_NULL_HANDLE;
}

static void fill_in(struct gpu *gpu, VkDescriptorSet set, enum gpu_kernel kernel, enum kernel_variant variant,
                    struct gpu_buffer *const *buffers, uint32_t n)
{
    VkWriteDescriptorSet write[BINDINGS_MAX];
    VkDescriptorBufferInfo range[BINDINGS_MAX];
    VkBufferView view[BINDINGS_MAX];
    for (uint32_t i = 0; i < n; i++) {
        VkDescriptorType type = descriptor_type(kernel, variant, i);
        write[i] = (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                          .dstSet = set,
                                          .dstBinding = i,
                                          .descriptorCount = 1,
                                          .descriptorType = type,
                                          .pBufferInfo = &range[i],
                                          .pTexelBufferView = &view[i]};
        if (type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER)
            view[i] = buffer_view(gpu, buffers[i], binding_letter(kernel, i));
        else
            range[i] = (VkDescriptorBufferInfo){buffers[i]->handle, 0, buffers[i]->bytes};
    }
    if (gpu->st == OK)
        vkUpdateDescriptorSets(gpu->device, n, write, 0, NULL);
}

VkDescriptorSet set_get(struct gpu *gpu, const struct pipeline *p, enum gpu_kernel kernel,
                        enum kernel_variant variant, struct gpu_buffer *const *buffers, uint32_t n)
{
    struct sets *s = gpu->sets;
    const struct key key = key_of(p, buffers, n);
    uint32_t at = find(s, &key);
    if (s->place[at].set)
        return s->place[at].set;
    const VkDescriptorSet set = allocate(gpu, p);
    if (!set)
        return VK_NULL_HANDLE;
    fill_in(gpu, set, kernel, variant, buffers, n);
    if (gpu->st != OK)
        return VK_NULL_HANDLE;
    at = find(s, &key); /* all may have been forgotten */
    s->place[at].key = key;
    s->place[at].set = set;
    s->n++;
    return set;
}
