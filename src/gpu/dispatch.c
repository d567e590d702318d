/* Kernels: pipelines are created when first used; gpu_dispatch() binds their buffers and launches them. */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/internal.h"

/* In "rF wV ", binding i is described by bindings[3 i] and bindings[3 i + 1]. */
static uint32_t binding_count(enum gpu_kernel kernel)
{
    return (uint32_t)(strlen(kernel_source[kernel]->bindings) / 3);
}

static bool binding_writes(enum gpu_kernel kernel, uint32_t i)
{
    return kernel_source[kernel]->bindings[3 * i] == 'w';
}

char binding_letter(enum gpu_kernel kernel, uint32_t i)
{
    return kernel_source[kernel]->bindings[3 * i + 1];
}

VkDescriptorType descriptor_type(enum gpu_kernel kernel, enum kernel_variant variant, uint32_t i)
{
    if (variant == VARIANT_WIDE)
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
    return variant == VARIANT_TEXEL && !binding_writes(kernel, i) ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                                                                  : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

const struct pipeline *pipeline_get(struct gpu *gpu, enum gpu_kernel kernel, enum kernel_variant variant)
{
    struct pipeline *p = &gpu->pipeline[kernel][variant];
    VkDescriptorSetLayoutBinding binding[BINDINGS_MAX];
    uint32_t n = variant == VARIANT_WIDE ? 1 : binding_count(kernel);
    assert(binding_count(kernel) <= BINDINGS_MAX);
    if (p->handle)
        return p;
    for (uint32_t i = 0; i < n; i++)
        binding[i] = (VkDescriptorSetLayoutBinding){.binding = i,
                                                    .descriptorType = descriptor_type(kernel, variant, i),
                                                    .descriptorCount = 1,
                                                    .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    VkDescriptorSetLayoutCreateInfo set = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                           .bindingCount = n,
                                           .pBindings = binding};
    VkPushConstantRange push = {.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .size = PARAMS_MAX};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &p->set_layout,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &push};
    VkShaderModuleCreateInfo code = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                     .codeSize = kernel_source[kernel]->size[variant],
                                     .pCode = kernel_source[kernel]->spirv[variant]};
    VkShaderModule module = VK_NULL_HANDLE;
    VK_TRY(gpu, vkCreateDescriptorSetLayout(gpu->device, &set, NULL, &p->set_layout));
    VK_TRY(gpu, vkCreatePipelineLayout(gpu->device, &layout, NULL, &p->layout));
    VK_TRY(gpu, vkCreateShaderModule(gpu->device, &code, NULL, &module));
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main"},
        .layout = p->layout};
    VK_TRY(gpu, vkCreateComputePipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &p->handle));
done:
    vkDestroyShaderModule(gpu->device, module, NULL);
    return gpu->st == OK ? p : NULL;
}

void pipelines_destroy(struct gpu *gpu)
{
    for (int k = 0; k < KERNELS; k++)
        for (int v = 0; v < VARIANTS; v++) {
            struct pipeline *p = &gpu->pipeline[k][v];
            vkDestroyPipeline(gpu->device, p->handle, NULL);
            vkDestroyPipelineLayout(gpu->device, p->layout, NULL);
            vkDestroyDescriptorSetLayout(gpu->device, p->set_layout, NULL);
        }
}

/* The device's preferred variant, or VARIANT_WIDE if a buffer is larger than the device can bind. */
static enum kernel_variant fitting_variant(const struct gpu *gpu, enum gpu_kernel kernel,
                                           struct gpu_buffer *const *buffers, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        bool texel = gpu->variant == VARIANT_TEXEL && !binding_writes(kernel, i);
        if (texel ? buffers[i]->n > gpu->texel_limit : buffers[i]->bytes > gpu->range_limit)
            return VARIANT_WIDE;
    }
    return gpu->variant;
}

/* Writes the addresses of a dispatch's buffers to those of its command buffer; returns their offset. */
static uint32_t write_addresses(struct slot *s, struct gpu_buffer *const *buffers, uint32_t n)
{
    const uint32_t offset = s->n_dispatches * BINDINGS_MAX * 16;
    for (uint32_t i = 0; i < n; i++)
        memcpy(s->addresses_mapped + offset + 16 * i, &buffers[i]->address, sizeof buffers[i]->address);
    return offset;
}

void gpu_dispatch(struct gpu *gpu, enum gpu_kernel kernel, size_t threads, const void *params,
                  size_t params_size, struct gpu_buffer *const *buffers, size_t n_buffers)
{
    uint32_t n = (uint32_t)n_buffers;
    assert(n_buffers == binding_count(kernel) && params_size <= PARAMS_MAX);
    for (uint32_t i = 0; i < n; i++)
        assert(buffers[i]->item == (binding_letter(kernel, i) == 'V' ? 16 : 4));
    if (threads > GPU_ITEMS_MAX) {
        gpu_break(gpu, VK_ERROR_OUT_OF_DEVICE_MEMORY, "more than 2^32 threads");
        return;
    }
    if (threads == 0 || gpu->st != OK)
        return;
    enum kernel_variant variant = fitting_variant(gpu, kernel, buffers, n);
    const bool wide = variant == VARIANT_WIDE;
    const struct pipeline *p = pipeline_get(gpu, kernel, variant);
    VkDescriptorSet set = p && !wide ? set_get(gpu, p, kernel, variant, buffers, n) : VK_NULL_HANDLE;
    VkCommandBuffer commands = record_begin(gpu);
    if (!commands)
        return;
    struct slot *s = &gpu->slot[gpu->current];
    const uint32_t offset = wide ? write_addresses(s, buffers, n) : 0;
    struct access access[BINDINGS_MAX];
    for (uint32_t i = 0; i < n; i++)
        access[i] = (struct access){buffers[i], binding_writes(kernel, i)};
    record_accesses(gpu, commands, access, n);

    uint32_t groups = (uint32_t)((threads + GROUP - 1) / GROUP);
    uint32_t x = groups < gpu->group_limit ? groups : gpu->group_limit;
    uint32_t y = (groups + x - 1) / x;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p->handle);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p->layout, 0, 1,
                            wide ? &s->address_set : &set, wide, &offset);
    vkCmdPushConstants(commands, p->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, (uint32_t)params_size, params);
    if (gpu->timestamp_bits)
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, s->queries, 2 * s->n_dispatches);
    vkCmdDispatch(commands, x, y, 1);
    if (gpu->timestamp_bits)
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, s->queries,
                            2 * s->n_dispatches + 1);
    s->dispatch[s->n_dispatches].kernel = kernel;
    s->dispatch[s->n_dispatches].stage = gpu->current_stage;
    if (++s->n_dispatches == DISPATCHES_PER_SLOT)
        gpu_submit(gpu);
}
