/* Buffers on the device, and transfers to and from them. */
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/internal.h"

static uint32_t memory_type(const struct gpu *gpu, uint32_t allowed, VkMemoryPropertyFlags flags)
{
    for (uint32_t i = 0; i < gpu->memory.memoryTypeCount; i++)
        if ((allowed & (1u << i)) && (gpu->memory.memoryTypes[i].propertyFlags & flags) == flags)
            return i;
    return UINT32_MAX;
}

void raw_buffer_create(struct gpu *gpu, VkDeviceSize bytes, VkBufferUsageFlags usage,
                       VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred, VkBuffer *buffer,
                       VkDeviceMemory *memory)
{
    VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
    VkMemoryAllocateFlagsInfo flags = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                       .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    bool addressed = (usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0;
    VkMemoryAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                     .pNext = addressed ? &flags : NULL};
    VkMemoryRequirements need;
    if (gpu->st != OK)
        return;
    VK_TRY(gpu, vkCreateBuffer(gpu->device, &info, NULL, buffer));
    vkGetBufferMemoryRequirements(gpu->device, *buffer, &need);
    allocate.allocationSize = need.size;
    allocate.memoryTypeIndex = memory_type(gpu, need.memoryTypeBits, wanted | preferred);
    if (allocate.memoryTypeIndex == UINT32_MAX)
        allocate.memoryTypeIndex = memory_type(gpu, need.memoryTypeBits, wanted);
    if (allocate.memoryTypeIndex == UINT32_MAX) {
        gpu_break(gpu, VK_ERROR_FEATURE_NOT_PRESENT, "the device has no suitable kind of memory");
        goto done;
    }
    if (gpu->options.allocation_limit && bytes > gpu->options.allocation_limit) {
        gpu_break(gpu, VK_ERROR_OUT_OF_DEVICE_MEMORY, "limit set by a test");
        goto done;
    }
    VK_TRY(gpu, vkAllocateMemory(gpu->device, &allocate, NULL, memory));
    gpu->n_allocations++;
    VK_TRY(gpu, vkBindBufferMemory(gpu->device, *buffer, *memory, 0));
done:;
}

/* The error for a buffer that the device did not allocate. Larger buffers than the device's promised limit are still tried, because
 * many devices allocate more. */
static status refused(const struct gpu *gpu, const struct gpu_buffer *b)
{
    char why[160] = "the device could not allocate it";
    if (b->bytes > gpu->allocation_limit)
        snprintf(why, sizeof why, "the device promises at most %.1f MB per allocation",
                 (double)gpu->allocation_limit / 1e6);
    return fail(E_MEMORY, "%s: the %s buffer needs %.1f MB, but %s: %s", gpu->info.name, b->name,
                (double)b->bytes / 1e6, why, gpu->message);
}

status gpu_buffer_create(struct gpu *gpu, const char *name, size_t n, size_t item, struct gpu_buffer **out)
{
    status st = OK;
    struct gpu_buffer *b = NULL;
    assert(item == 4 || item == 16);
    TRY(gpu_status(gpu));
    if (n > GPU_ITEMS_MAX)
        return fail(
            E_MEMORY,
            "the %s buffer needs %.1f MB for %zu items, but kernels can address at most %zu items; raise domain.spacing_m",
            name, (double)n * (double)item / 1e6, n, GPU_ITEMS_MAX);
    TRY(memory_alloc(1, sizeof *b, name, &b));
    snprintf(b->name, sizeof b->name, "%s", name);
    b->id = ++gpu->n_buffers;
    b->n = n;
    b->item = item;
    b->bytes = (n ? n : 1) * item;
    if (b->bytes > gpu_memory_free(gpu)) {
        st = fail(E_MEMORY, "%s: the %s buffer needs %.1f MB, but only %.1f MB are free", gpu->info.name,
                  name, (double)b->bytes / 1e6, (double)gpu_memory_free(gpu) / 1e6);
        goto done;
    }
    if (gpu->n_allocations >= gpu->allocations_limit) {
        st = fail(E_MEMORY,
                  "%s: cannot allocate the %s buffer: the device allows %u allocations, and all are in use",
                  gpu->info.name, name, gpu->allocations_limit);
        goto done;
    }
    raw_buffer_create(gpu, b->bytes,
                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                          VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                          (gpu->conditions.begin ? VK_BUFFER_USAGE_CONDITIONAL_RENDERING_BIT_EXT : 0),
                      VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                      gpu->maps ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                                : 0,
                      &b->handle, &b->memory);
    if (gpu->st == E_MEMORY) {
        /* Not sticky, since the caller may try with less. */
        st = refused(gpu, b);
        gpu->st = OK;
        goto done;
    }
    TRY(gpu_status(gpu));
    if (gpu->maps) {
        VK_TRY(gpu, vkMapMemory(gpu->device, b->memory, 0, VK_WHOLE_SIZE, 0, &b->mapped));
    }
    VkBufferDeviceAddressInfo address = {.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                         .buffer = b->handle};
    b->address = vkGetBufferDeviceAddress(gpu->device, &address);
    gpu_fill(gpu, b, 0);
    *out = b;
    b = NULL;
done:
    gpu_buffer_destroy(gpu, &b);
    return st != OK ? st : gpu_status(gpu);
}

void gpu_buffer_destroy(struct gpu *gpu, struct gpu_buffer **handle)
{
    struct gpu_buffer *b = *handle;
    if (!b)
        return;
    if (gpu_wait(gpu) != OK)
        vkDeviceWaitIdle(gpu->device);
    for (int i = 0; i < 3; i++)
        vkDestroyBufferView(gpu->device, b->view[i], NULL);
    vkDestroyBuffer(gpu->device, b->handle, NULL);
    vkFreeMemory(gpu->device, b->memory, NULL);
    gpu->n_allocations -= b->memory != VK_NULL_HANDLE;
    free(b);
    *handle = NULL;
}

size_t gpu_buffer_count(const struct gpu_buffer *buffer)
{
    return buffer->n;
}

size_t gpu_buffer_item(const struct gpu_buffer *buffer)
{
    return buffer->item;
}

VkBufferView buffer_view(struct gpu *gpu, struct gpu_buffer *b, char letter)
{
    static const VkFormat format[] = {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32_UINT,
                                      VK_FORMAT_R32G32B32A32_SFLOAT};
    int i = letter == 'F' ? 0 : letter == 'U' ? 1 : 2;
    VkBufferViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                   .buffer = b->handle,
                                   .format = format[i],
                                   .range = b->bytes};
    if (!b->view[i])
        VK_TRY(gpu, vkCreateBufferView(gpu->device, &info, NULL, &b->view[i]));
done:
    return b->view[i];
}

void gpu_fill(struct gpu *gpu, struct gpu_buffer *buffer, uint32_t word)
{
    VkCommandBuffer commands = record_begin(gpu);
    if (!commands)
        return;
    record_accesses(gpu, commands, &(struct access){buffer, true}, 1);
    vkCmdFillBuffer(commands, buffer->handle, 0, VK_WHOLE_SIZE, word);
}

void gpu_copy(struct gpu *gpu, struct gpu_buffer *to, const struct gpu_buffer *from, size_t n_items)
{
    assert(to->item == from->item && n_items <= to->n && n_items <= from->n);
    VkCommandBuffer commands = record_begin(gpu);
    VkBufferCopy region = {.size = n_items * to->item};
    if (!commands || n_items == 0)
        return;
    record_accesses(gpu, commands, (struct access[]){{(struct gpu_buffer *)from, false}, {to, true}}, 2);
    vkCmdCopyBuffer(commands, from->handle, to->handle, 1, &region);
}

/* Transfers go through the two halves of the staging buffer in turn, where the host cannot map the memory of the device: it copies a
 * piece of STAGING_BYTES while the device copies the next. Each piece is a submission, behind the kernels recorded before. */
struct piece {
    char *staged;       /* in a half of the staging buffer */
    struct slot **last; /* the submission that last used this half */
    size_t at, bytes;
};

static struct piece piece_at(struct gpu *gpu, size_t at, size_t bytes)
{
    const size_t half = at / STAGING_BYTES % 2;
    return (struct piece){.staged = gpu->staging_mapped + half * STAGING_BYTES,
                          .last = &gpu->staged[half],
                          .at = at,
                          .bytes = bytes - at < STAGING_BYTES ? bytes - at : STAGING_BYTES};
}

static void submit_piece(struct gpu *gpu, struct gpu_buffer *b, VkDeviceSize offset, const struct piece *p,
                         bool upload)
{
    VkCommandBuffer commands = record_begin(gpu);
    const VkDeviceSize there = offset + p->at, staged = (VkDeviceSize)(p->staged - gpu->staging_mapped);
    VkBufferCopy region = {
        .srcOffset = upload ? staged : there, .dstOffset = upload ? there : staged, .size = p->bytes};
    if (!commands)
        return;
    record_accesses(gpu, commands, &(struct access){b, upload}, 1);
    vkCmdCopyBuffer(commands, upload ? gpu->staging : b->handle, upload ? b->handle : gpu->staging, 1,
                    &region);
    *p->last = &gpu->slot[gpu->current];
    gpu_submit(gpu);
}

/* Waits until the device has copied the piece, or what was last in its half. */
static void await_piece(struct gpu *gpu, const struct piece *p)
{
    if (*p->last)
        slot_finish(gpu, *p->last);
}

static status upload_staged(struct gpu *gpu, struct gpu_buffer *b, size_t offset, const char *host,
                            size_t bytes)
{
    for (size_t at = 0; at < bytes && gpu->st == OK; at += STAGING_BYTES) {
        const struct piece p = piece_at(gpu, at, bytes);
        await_piece(gpu, &p);
        memcpy(p.staged, host + at, p.bytes);
        submit_piece(gpu, b, offset, &p, true);
    }
    return gpu_status(gpu);
}

static status download_staged(struct gpu *gpu, struct gpu_buffer *b, size_t offset, char *host, size_t bytes)
{
    for (size_t at = 0; at < bytes + STAGING_BYTES && gpu->st == OK; at += STAGING_BYTES) {
        if (at < bytes) {
            const struct piece next = piece_at(gpu, at, bytes);
            await_piece(gpu, &next);
            submit_piece(gpu, b, offset, &next, false);
        }
        if (at > 0) {
            const struct piece p = piece_at(gpu, at - STAGING_BYTES, bytes);
            await_piece(gpu, &p);
            if (gpu->st == OK)
                memcpy(host + p.at, p.staged, p.bytes);
        }
    }
    return gpu_wait(gpu);
}

status gpu_upload(struct gpu *gpu, struct gpu_buffer *to, size_t first, const void *from, size_t n_items)
{
    status st = OK;
    const size_t offset = first * to->item, bytes = n_items * to->item;
    assert(first <= to->n && n_items <= to->n - first);
    TRY(gpu_status(gpu));
    if (bytes == 0)
        return OK;
    if (bytes <= UPDATE_BYTES) {
        VkCommandBuffer commands = record_begin(gpu);
        if (commands) {
            record_accesses(gpu, commands, &(struct access){to, true}, 1);
            vkCmdUpdateBuffer(commands, to->handle, offset, bytes, from);
        }
        return gpu_status(gpu);
    }
    if (!to->mapped)
        return upload_staged(gpu, to, offset, from, bytes);
    TRY(gpu_wait(gpu));
    memcpy((char *)to->mapped + offset, from, bytes);
done:
    return st;
}

status gpu_download(struct gpu *gpu, const struct gpu_buffer *from, size_t first, void *to, size_t n_items)
{
    status st = OK;
    const size_t offset = first * from->item, bytes = n_items * from->item;
    assert(first <= from->n && n_items <= from->n - first);
    TRY(gpu_status(gpu));
    if (!from->mapped)
        return download_staged(gpu, (struct gpu_buffer *)from, offset, to, bytes);
    TRY(gpu_wait(gpu));
    if (bytes)
        memcpy(to, (const char *)from->mapped + offset, bytes);
done:
    return st;
}
