/* Devices: listing them, choosing one, opening and closing it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/cores.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/version.h"
#include "gpu/choose.h"
#include "gpu/internal.h"
#include "system/threads.h"

const char *vk_result_text(VkResult result)
{
    switch (result) {
#define CASE(name)                                                                                           \
    case name:                                                                                               \
        return #name;
        CASE(VK_SUCCESS)
        CASE(VK_NOT_READY)
        CASE(VK_TIMEOUT)
        CASE(VK_ERROR_OUT_OF_HOST_MEMORY)
        CASE(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        CASE(VK_ERROR_INITIALIZATION_FAILED)
        CASE(VK_ERROR_DEVICE_LOST)
        CASE(VK_ERROR_LAYER_NOT_PRESENT)
        CASE(VK_ERROR_EXTENSION_NOT_PRESENT)
        CASE(VK_ERROR_FEATURE_NOT_PRESENT)
        CASE(VK_ERROR_INCOMPATIBLE_DRIVER)
        CASE(VK_ERROR_TOO_MANY_OBJECTS)
#undef CASE
    default:
        return "unknown VkResult";
    }
}

void gpu_break(struct gpu *gpu, VkResult result, const char *call)
{
    if (gpu->st != OK)
        return;
    bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
    gpu->st = memory ? E_MEMORY : E_DEVICE;
    snprintf(
        gpu->message, sizeof gpu->message, "%s: %s (%.200s)%s", gpu->info.name, vk_result_text(result), call,
        result == VK_ERROR_DEVICE_LOST ? "; run the same command again to continue from the last checkpoint"
                                       : "");
}

status gpu_status(const struct gpu *gpu)
{
    return gpu->st == OK ? OK : fail(gpu->st, "%s", gpu->message);
}

static status instance_create(VkInstance *out)
{
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .pApplicationName = "hoodoo",
                                     .apiVersion = VK_API_VERSION_1_2};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application};
    shader_cache_choose();
    VkResult result = vkCreateInstance(&info, NULL, out);
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY)
        return fail(E_MEMORY, "out of memory while starting a Vulkan driver");
    if (result != VK_SUCCESS)
        return fail(
            E_DEVICE,
            "no Vulkan driver could be started (%s); install mesa-vulkan-drivers for a CPU device, or the GPU's own driver",
            vk_result_text(result));
    return OK;
}

/* Uses an array of fixed size, because running out of memory here would look like a missing extension. Devices have a few hundred at
 * most. */
static bool has_extension(VkPhysicalDevice physical, const char *name)
{
    enum { MOST_EXTENSIONS = 1024 };
    uint32_t n = MOST_EXTENSIONS;
    bool found = false;
    VkExtensionProperties list[MOST_EXTENSIONS];
    VkResult result = vkEnumerateDeviceExtensionProperties(physical, NULL, &n, list);
    for (uint32_t i = 0; (result == VK_SUCCESS || result == VK_INCOMPLETE) && i < n && !found; i++)
        found = strcmp(list[i].extensionName, name) == 0;
    return found;
}

static uint32_t compute_family(VkPhysicalDevice physical, uint32_t *timestamp_bits)
{
    VkQueueFamilyProperties family[32];
    uint32_t n = 32;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &n, family);
    for (uint32_t i = 0; i < n; i++)
        if (family[i].queueFlags & VK_QUEUE_COMPUTE_BIT) {
            *timestamp_bits = family[i].timestampValidBits;
            return i;
        }
    return UINT32_MAX;
}

static void describe(VkPhysicalDevice physical, int index, struct gpu_info *info)
{
    static const char *const types[] = {"other", "integrated", "discrete", "virtual", "cpu"};
    bool pci = has_extension(physical, VK_EXT_PCI_BUS_INFO_EXTENSION_NAME);
    VkPhysicalDevicePCIBusInfoPropertiesEXT bus = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PCI_BUS_INFO_PROPERTIES_EXT};
    VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
                                               .pNext = pci ? &bus : NULL};
    VkPhysicalDeviceIDProperties id = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES,
                                       .pNext = &driver};
    VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                              .pNext = &id};
    VkPhysicalDeviceVulkan12Features features12 = {.sType =
                                                       VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &features12};
    VkPhysicalDeviceMemoryProperties memory;
    uint32_t bits;

    vkGetPhysicalDeviceProperties2(physical, &properties);
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    *info = (struct gpu_info){.index = index};
    snprintf(info->name, sizeof info->name, "%.255s", properties.properties.deviceName);
    snprintf(info->driver, sizeof info->driver, "%.100s %.100s", driver.driverName, driver.driverInfo);
    for (size_t i = 0; i < VK_UUID_SIZE; i++)
        snprintf(info->uuid + 2 * i, 3, "%02x", id.deviceUUID[i]);
    if (pci)
        snprintf(info->pci, sizeof info->pci, "%04x:%02x:%02x.%x", bus.pciDomain & 0xffff, bus.pciBus & 0xff,
                 bus.pciDevice & 0xff, bus.pciFunction & 0xf);
    int type = (int)properties.properties.deviceType;
    snprintf(info->type, sizeof info->type, "%s", types[type >= 0 && type <= 4 ? type : 0]);
    info->is_cpu = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    for (uint32_t i = 0; i < memory.memoryHeapCount; i++)
        if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) &&
            memory.memoryHeaps[i].size > info->memory)
            info->memory = memory.memoryHeaps[i].size;
    if (properties.properties.apiVersion >= VK_API_VERSION_1_2) {
        vkGetPhysicalDeviceFeatures2(physical, &features);
        info->usable = features12.bufferDeviceAddress && features12.scalarBlockLayout &&
                       compute_family(physical, &bits) != UINT32_MAX;
    }
}

static status enumerate(VkInstance instance, VkPhysicalDevice **physical, struct gpu_info **info, uint32_t *n)
{
    status st = OK;
    *physical = NULL;
    *info = NULL;
    *n = 0;
    VkResult result = vkEnumeratePhysicalDevices(instance, n, NULL);
    if (result != VK_SUCCESS || *n == 0)
        return fail(
            E_DEVICE,
            "no Vulkan device found; install mesa-vulkan-drivers for a CPU device, or the GPU's driver");
    TRY(memory_alloc(*n, sizeof **physical, "the list of devices", physical));
    TRY(memory_alloc(*n, sizeof **info, "the list of devices", info));
    vkEnumeratePhysicalDevices(instance, n, *physical);
    for (uint32_t i = 0; i < *n; i++)
        describe((*physical)[i], (int)i, &(*info)[i]);
done:
    return st;
}

status gpu_list(struct gpu_info **out, size_t *n)
{
    status st = OK;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice *physical = NULL;
    struct gpu_info *info = NULL;
    uint32_t count = 0;
    TRY(instance_create(&instance));
    TRY(enumerate(instance, &physical, &info, &count));
    *out = info;
    *n = count;
    info = NULL;
done:
    free(physical);
    free(info);
    if (instance)
        vkDestroyInstance(instance, NULL);
    return st;
}

static status device_open(struct gpu *gpu)
{
    status st = OK;
    float priority = 1;
    const char *extension[2];
    uint32_t n_extensions = 0;
    gpu->family = compute_family(gpu->physical, &gpu->timestamp_bits);
    gpu->has_budget = has_extension(gpu->physical, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    if (gpu->has_budget)
        extension[n_extensions++] = VK_EXT_MEMORY_BUDGET_EXTENSION_NAME;
    VkPhysicalDeviceConditionalRenderingFeaturesEXT conditions = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CONDITIONAL_RENDERING_FEATURES_EXT};
    if (!gpu->options.unconditional &&
        has_extension(gpu->physical, VK_EXT_CONDITIONAL_RENDERING_EXTENSION_NAME)) {
        vkGetPhysicalDeviceFeatures2(
            gpu->physical, &(VkPhysicalDeviceFeatures2){.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                                        .pNext = &conditions});
        conditions.inheritedConditionalRendering = VK_FALSE;
        extension[n_extensions++] = VK_EXT_CONDITIONAL_RENDERING_EXTENSION_NAME;
    }
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                     .queueFamilyIndex = gpu->family,
                                     .queueCount = 1,
                                     .pQueuePriorities = &priority};
    VkPhysicalDeviceVulkan12Features features = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
        .pNext = conditions.conditionalRendering ? &conditions : NULL,
        .bufferDeviceAddress = VK_TRUE,
        .scalarBlockLayout = VK_TRUE};
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = &features,
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queue,
                               .enabledExtensionCount = n_extensions,
                               .ppEnabledExtensionNames = extension};
    VkPhysicalDeviceSubgroupProperties subgroup = {.sType =
                                                       VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceMaintenance3Properties sizes = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES, .pNext = &subgroup};
    VkPhysicalDeviceProperties2 asked = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                         .pNext = &sizes};
    const VkPhysicalDeviceLimits *limits = &asked.properties.limits;
    const struct gpu_options *o = &gpu->options;
    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                    .queueFamilyIndex = gpu->family};
    vkGetPhysicalDeviceMemoryProperties(gpu->physical, &gpu->memory);
    vkGetPhysicalDeviceProperties2(gpu->physical, &asked);
    gpu->range_limit = o->range_limit ? o->range_limit : limits->maxStorageBufferRange;
    gpu->allocation_limit = o->allocation_limit ? o->allocation_limit : sizes.maxMemoryAllocationSize;
    gpu->allocations_limit = o->allocations_limit ? o->allocations_limit : limits->maxMemoryAllocationCount;
    gpu->texel_limit = limits->maxTexelBufferElements;
    gpu->subgroup = subgroup.subgroupSize;
    gpu->group_limit = limits->maxComputeWorkGroupCount[0];
    gpu->timestamp_ns = (double)limits->timestampPeriod;
    gpu->variant = o->variant         ? (enum kernel_variant)(o->variant - 1)
                   : gpu->info.is_cpu ? VARIANT_TEXEL
                                      : VARIANT_STORAGE;
    VK_TRY(gpu, vkCreateDevice(gpu->physical, &info, NULL, &gpu->device));
    if (conditions.conditionalRendering) {
        gpu->conditions.begin = (PFN_vkCmdBeginConditionalRenderingEXT)vkGetDeviceProcAddr(
            gpu->device, "vkCmdBeginConditionalRenderingEXT");
        gpu->conditions.end = (PFN_vkCmdEndConditionalRenderingEXT)vkGetDeviceProcAddr(
            gpu->device, "vkCmdEndConditionalRenderingEXT");
    }
    vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);
    VK_TRY(gpu, vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->commands));
    if (!gpu->maps) {
        raw_buffer_create(gpu, 2 * STAGING_BYTES,
                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                          VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                          VK_MEMORY_PROPERTY_HOST_CACHED_BIT, &gpu->staging, &gpu->staging_memory);
        if (gpu->st == OK)
            VK_TRY(gpu, vkMapMemory(gpu->device, gpu->staging_memory, 0, VK_WHOLE_SIZE, 0,
                                    (void **)&gpu->staging_mapped));
    }
    slots_create(gpu);
    TRY(sets_create(gpu));
done:
    return st != OK ? st : gpu_status(gpu);
}

status gpu_create(const struct gpu_options *options, struct gpu **out)
{
    status st = OK;
    VkPhysicalDevice *physical = NULL;
    struct gpu_info *info = NULL;
    uint32_t n;
    size_t chosen;
    struct gpu *gpu = NULL;
    TRY(memory_alloc(1, sizeof *gpu, "the device", &gpu));
    gpu->options = *options;
    gpu->epoch = 1;
    /* What a run with lavapipe was seen to have beside its first thread: heartbeat and writer, two of the driver's and its two pools,
     * OpenMP's of two threads, TBB's, and a pool of twice the cores. */
    TRY(threads_check(7 * cores() + 1));
    TRY(instance_create(&gpu->instance));
    TRY(enumerate(gpu->instance, &physical, &info, &n));
    const char *ids = getenv("SLURM_STEP_GPUS");
    const char *given = options->device ? options->device : getenv("HOODOO_DEVICE");
    TRY(gpu_choose(given && *given ? given : NULL, ids ? ids : getenv("SLURM_JOB_GPUS"), info, n, &chosen));
    gpu->info = info[chosen];
    gpu->maps = gpu->info.is_cpu && !options->staged;
    gpu->physical = physical[chosen];
    TRY(device_open(gpu));
    shader_cache_hold();
    *out = gpu;
    gpu = NULL;
done:
    free(physical);
    free(info);
    gpu_destroy(&gpu);
    return st;
}

void gpu_destroy(struct gpu **handle)
{
    struct gpu *gpu = *handle;
    if (!gpu)
        return;
    if (gpu->device) {
        vkDeviceWaitIdle(gpu->device);
        pipelines_destroy(gpu);
        sets_destroy(gpu);
        slots_destroy(gpu);
        vkDestroyBuffer(gpu->device, gpu->staging, NULL);
        vkFreeMemory(gpu->device, gpu->staging_memory, NULL);
        vkDestroyCommandPool(gpu->device, gpu->commands, NULL);
        vkDestroyDevice(gpu->device, NULL);
    }
    if (gpu->instance)
        vkDestroyInstance(gpu->instance, NULL);
    free(gpu);
    *handle = NULL;
}

const struct gpu_info *gpu_info(const struct gpu *gpu)
{
    return &gpu->info;
}

struct gpu_limits gpu_limits(const struct gpu *gpu)
{
    static const char *const variants[VARIANTS] = {"texel", "storage", "wide"};
    return (struct gpu_limits){.range = gpu->range_limit,
                               .texels = gpu->texel_limit,
                               .allocation = gpu->allocation_limit,
                               .allocations = gpu->allocations_limit,
                               .subgroup = gpu->subgroup,
                               .timestamp_bits = gpu->timestamp_bits,
                               .variant = variants[gpu->variant]};
}

uint64_t gpu_memory_free(const struct gpu *gpu)
{
    if (gpu->info.is_cpu)
        return memory_available();
    if (!gpu->has_budget)
        return gpu->info.memory;
    VkPhysicalDeviceMemoryBudgetPropertiesEXT budget = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT};
    VkPhysicalDeviceMemoryProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2, .pNext = &budget};
    uint64_t most = 0;
    vkGetPhysicalDeviceMemoryProperties2(gpu->physical, &properties);
    for (uint32_t i = 0; i < gpu->memory.memoryHeapCount; i++) {
        uint64_t left =
            budget.heapBudget[i] > budget.heapUsage[i] ? budget.heapBudget[i] - budget.heapUsage[i] : 0;
        if ((gpu->memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) && left > most)
            most = left;
    }
    return most;
}
