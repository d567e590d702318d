/* Recording: command buffers in slots, barriers between commands that access the same buffer, submission, timestamps. */
#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "gpu/internal.h"
#include "gpu/timestamp.h"

/* What VARIANT_WIDE binds: a part of the slot's buffer of addresses, at an offset that each dispatch gives. */
static void address_sets_create(struct gpu *gpu)
{
    VkDescriptorSetLayoutBinding binding = {.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC,
                                            .descriptorCount = 1,
                                            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    VkDescriptorSetLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                              .bindingCount = 1,
                                              .pBindings = &binding};
    VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, SLOTS};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = SLOTS,
                                       .poolSizeCount = 1,
                                       .pPoolSizes = &size};
    VK_TRY(gpu, vkCreateDescriptorSetLayout(gpu->device, &layout, NULL, &gpu->address_layout));
    VK_TRY(gpu, vkCreateDescriptorPool(gpu->device, &pool, NULL, &gpu->address_pool));
    for (int i = 0; i < SLOTS; i++) {
        struct slot *s = &gpu->slot[i];
        VkDescriptorSetAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                .descriptorPool = gpu->address_pool,
                                                .descriptorSetCount = 1,
                                                .pSetLayouts = &gpu->address_layout};
        VkDescriptorBufferInfo range = {s->addresses, 0, BINDINGS_MAX * 16};
        VK_TRY(gpu, vkAllocateDescriptorSets(gpu->device, &allocate, &s->address_set));
        VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                      .dstSet = s->address_set,
                                      .descriptorCount = 1,
                                      .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC,
                                      .pBufferInfo = &range};
        vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
    }
done:;
}

bool slots_create(struct gpu *gpu)
{
    VkCommandBufferAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = gpu->commands,
                                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                            .commandBufferCount = 1};
    VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkQueryPoolCreateInfo queries = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = 2 * DISPATCHES_PER_SLOT};
    for (int i = 0; i < SLOTS && gpu->st == OK; i++) {
        struct slot *s = &gpu->slot[i];
        VK_TRY(gpu, vkAllocateCommandBuffers(gpu->device, &allocate, &s->commands));
        VK_TRY(gpu, vkCreateFence(gpu->device, &fence, NULL, &s->fence));
        VK_TRY(gpu, vkCreateQueryPool(gpu->device, &queries, NULL, &s->queries));
        raw_buffer_create(gpu, (VkDeviceSize)DISPATCHES_PER_SLOT * BINDINGS_MAX * 16,
                          VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                          VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, 0,
                          &s->addresses, &s->addresses_memory);
        if (gpu->st == OK)
            VK_TRY(gpu, vkMapMemory(gpu->device, s->addresses_memory, 0, VK_WHOLE_SIZE, 0,
                                    (void **)&s->addresses_mapped));
    }
    if (gpu->st == OK)
        address_sets_create(gpu);
done:
    return gpu->st == OK;
}

void slots_destroy(struct gpu *gpu)
{
    for (int i = 0; i < SLOTS; i++) {
        struct slot *s = &gpu->slot[i];
        vkDestroyFence(gpu->device, s->fence, NULL);
        vkDestroyQueryPool(gpu->device, s->queries, NULL);
        vkDestroyBuffer(gpu->device, s->addresses, NULL);
        vkFreeMemory(gpu->device, s->addresses_memory, NULL);
    }
    vkDestroyDescriptorPool(gpu->device, gpu->address_pool, NULL);
    vkDestroyDescriptorSetLayout(gpu->device, gpu->address_layout, NULL);
}

static void collect_times(struct gpu *gpu, struct slot *s)
{
    uint64_t stamp[2 * DISPATCHES_PER_SLOT];
    if (s->n_dispatches == 0)
        return;
    if (gpu->timestamp_bits)
        VK_TRY(gpu, vkGetQueryPoolResults(gpu->device, s->queries, 0, 2 * s->n_dispatches,
                                          2 * s->n_dispatches * sizeof *stamp, stamp, sizeof *stamp,
                                          VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
    for (uint32_t i = 0; i < s->n_dispatches; i++) {
        uint64_t ns = gpu->timestamp_bits ? timestamp_ns(stamp[2 * i], stamp[2 * i + 1], gpu->timestamp_bits,
                                                         gpu->timestamp_ns)
                                          : 0;
        struct gpu_time *times[] = {&gpu->kernel[s->dispatch[i].kernel], &gpu->stage[s->dispatch[i].stage]};
        for (int t = 0; t < 2; t++) {
            times[t]->ns += ns;
            times[t]->dispatches++;
        }
    }
done:;
}

void slot_finish(struct gpu *gpu, struct slot *s)
{
    if (!s->submitted || gpu->st != OK)
        return;
    VK_TRY(gpu, vkWaitForFences(gpu->device, 1, &s->fence, VK_TRUE, UINT64_MAX));
    s->submitted = false;
    collect_times(gpu, s);
    VK_TRY(gpu, vkResetFences(gpu->device, 1, &s->fence));
done:;
}

static void barrier(struct gpu *gpu, VkCommandBuffer commands)
{
    const bool conditions = gpu->conditions.begin != NULL;
    VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                              .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                              .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                                               VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT};
    VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    vkCmdPipelineBarrier(commands,
                         stages | (conditions ? VK_PIPELINE_STAGE_CONDITIONAL_RENDERING_BIT_EXT : 0), stages,
                         0, 1, &memory, 0, NULL, 0, NULL);
    gpu->epoch++;
}

/* The device reads the flag when it reaches the first command that depends on it, so whatever sets it must have ended. */
static void condition_begin(struct gpu *gpu, VkCommandBuffer commands)
{
    struct gpu_buffer *flags = gpu->condition.flags;
    VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                              .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                              .dstAccessMask = VK_ACCESS_CONDITIONAL_RENDERING_READ_BIT_EXT};
    if (!flags)
        return;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_CONDITIONAL_RENDERING_BIT_EXT, 0, 1, &memory, 0, NULL, 0, NULL);
    gpu->conditions.begin(commands, &(VkConditionalRenderingBeginInfoEXT){
                                        .sType = VK_STRUCTURE_TYPE_CONDITIONAL_RENDERING_BEGIN_INFO_EXT,
                                        .buffer = flags->handle,
                                        .offset = 4 * gpu->condition.flag});
}

static void condition_end(struct gpu *gpu, VkCommandBuffer commands)
{
    if (!gpu->condition.flags)
        return;
    gpu->conditions.end(commands);
    gpu->condition.flags->read = gpu->epoch; /* devices may read it again for every dispatch */
}

void record_condition(struct gpu *gpu, struct condition condition)
{
    VkCommandBuffer commands = gpu->recording && gpu->st == OK ? gpu->slot[gpu->current].commands : NULL;
    if (condition.flags == gpu->condition.flags && condition.flag == gpu->condition.flag)
        return;
    if (commands)
        condition_end(gpu, commands);
    gpu->condition = condition;
    if (commands)
        condition_begin(gpu, commands);
}

VkCommandBuffer record_begin(struct gpu *gpu)
{
    struct slot *s = &gpu->slot[gpu->current];
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    if (gpu->st != OK)
        return VK_NULL_HANDLE;
    if (gpu->recording)
        return s->commands;
    slot_finish(gpu, s);
    s->n_dispatches = 0;
    VK_TRY(gpu, vkBeginCommandBuffer(s->commands, &begin));
    vkCmdResetQueryPool(s->commands, s->queries, 0, 2 * DISPATCHES_PER_SLOT);
    gpu->recording = true;
    condition_begin(gpu, s->commands);
done:
    return gpu->st == OK ? s->commands : VK_NULL_HANDLE;
}

void record_accesses(struct gpu *gpu, VkCommandBuffer commands, const struct access *access, size_t n)
{
    bool conflict = false;
    for (size_t i = 0; i < n; i++) {
        const struct gpu_buffer *b = access[i].buffer;
        conflict |= b->written == gpu->epoch || (access[i].write && b->read == gpu->epoch);
    }
    if (conflict)
        barrier(gpu, commands);
    for (size_t i = 0; i < n; i++)
        *(access[i].write ? &access[i].buffer->written : &access[i].buffer->read) = gpu->epoch;
}

void gpu_submit(struct gpu *gpu)
{
    struct slot *s = &gpu->slot[gpu->current];
    VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &s->commands};
    VkMemoryBarrier to_host = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                               .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    if (gpu->st != OK || !gpu->recording)
        return;
    condition_end(gpu, s->commands);
    /* Commands of the next slot may access the same buffers, and the host may read them after the fence. */
    barrier(gpu, s->commands);
    vkCmdPipelineBarrier(s->commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, NULL, 0, NULL);
    gpu->recording = false;
    VK_TRY(gpu, vkEndCommandBuffer(s->commands));
    VK_TRY(gpu, vkQueueSubmit(gpu->queue, 1, &submit, s->fence));
    s->submitted = true;
    gpu->current = (gpu->current + 1) % SLOTS;
done:;
}

status gpu_wait(struct gpu *gpu)
{
    gpu_submit(gpu);
    for (int i = 0; i < SLOTS; i++)
        slot_finish(gpu, &gpu->slot[(gpu->current + i) % SLOTS]);
    return gpu_status(gpu);
}

void gpu_watch(struct gpu *gpu, status (*ended)(void *user, const char *stage, const char *next), void *user)
{
    gpu->ended = ended;
    gpu->ended_user = user;
}

/* Whether one name is the other's or a part of it, as "stress level 1" is of "stress". */
static bool same_stage(const char *a, const char *b)
{
    const size_t n = strcspn(a, " ");
    return n == strcspn(b, " ") && strncmp(a, b, n) == 0;
}

static int stage_index(struct gpu *gpu, const char *name)
{
    for (int i = 0; i < gpu->n_stages; i++)
        if (strcmp(gpu->stage[i].name, name) == 0)
            return i;
    assert(gpu->n_stages < STAGES_MAX);
    gpu->stage[gpu->n_stages] = (struct gpu_time){.name = name};
    return gpu->n_stages++;
}

static void end_stage(struct gpu *gpu, const char *next)
{
    const char *last = gpu->n_stages ? gpu->stage[gpu->current_stage].name : next;
    if (!gpu->ended || gpu->st != OK || same_stage(last, next))
        return;
    gpu->current_stage = stage_index(gpu, "numbers");
    const status st = gpu->ended(gpu->ended_user, last, next);
    if (st != OK && gpu->st == OK) {
        gpu->st = st;
        snprintf(gpu->message, sizeof gpu->message, "%s", status_message());
    }
}

void gpu_stage(struct gpu *gpu, const char *name)
{
    end_stage(gpu, name);
    gpu->current_stage = stage_index(gpu, name);
}

size_t gpu_stage_times(const struct gpu *gpu, const struct gpu_time **times)
{
    *times = gpu->stage;
    return (size_t)gpu->n_stages;
}

const struct gpu_time *gpu_kernel_time(const struct gpu *gpu, enum gpu_kernel kernel)
{
    return &gpu->kernel[kernel];
}

void gpu_times_reset(struct gpu *gpu)
{
    for (int i = 0; i < gpu->n_stages; i++)
        gpu->stage[i].ns = gpu->stage[i].dispatches = 0;
    for (int i = 0; i < KERNELS; i++)
        gpu->kernel[i] = (struct gpu_time){.name = kernel_source[i]->name};
}
