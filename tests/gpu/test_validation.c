/* The validation layer sees wrong use, a missing barrier and what is not given back here, so that its silence in
 * tests/cli/validation.sh means something. With an argument: does all three without listening, for that script to
 * find on this program's output. */
#include "check.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <vulkan/vulkan.h>

struct seen {
    int errors, hazards;
};

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT type,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    struct seen *seen = user;
    (void)type;
    seen->errors += severity == VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    seen->hazards += strstr(data->pMessage, "SYNC-HAZARD-WRITE-AFTER-WRITE") != NULL ||
                     (data->pMessageIdName && strstr(data->pMessageIdName, "SYNC-HAZARD-WRITE-AFTER-WRITE"));
    return VK_FALSE;
}

static VkInstance make_instance(struct seen *seen)
{
    const char *layers[] = {"VK_LAYER_KHRONOS_validation"};
    const char *extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    VkInstance instance = NULL;
    VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = seen};
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .apiVersion = VK_API_VERSION_1_2};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                 .pApplicationInfo = &application,
                                 .enabledLayerCount = 1,
                                 .ppEnabledLayerNames = layers,
                                 .enabledExtensionCount = 1,
                                 .ppEnabledExtensionNames = extensions};
    assert_int_equal(vkCreateInstance(&info, NULL, &instance), VK_SUCCESS);
    if (!seen)
        return instance;
    VkDebugUtilsMessengerEXT handle;
    PFN_vkVoidFunction make = vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT");
    assert_non_null(make);
    assert_int_equal(((PFN_vkCreateDebugUtilsMessengerEXT)make)(instance, &messenger, NULL, &handle),
                     VK_SUCCESS);
    return instance; /* and its messenger: they live as long as this program */
}

static VkDevice make_device(VkInstance instance, VkPhysicalDevice *physical)
{
    VkDevice device = NULL;
    uint32_t n = 1;
    const float priority = 1;
    assert_true(vkEnumeratePhysicalDevices(instance, &n, physical) >= 0);
    assert_int_equal(n, 1);
    VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queue};
    assert_int_equal(vkCreateDevice(*physical, &info, NULL, &device), VK_SUCCESS);
    return device;
}

static VkBuffer make_buffer(VkPhysicalDevice physical, VkDevice device)
{
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkMemoryRequirements need;
    VkPhysicalDeviceMemoryProperties types;
    uint32_t type = 0;
    VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                               .size = 256,
                               .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    assert_int_equal(vkCreateBuffer(device, &info, NULL, &buffer), VK_SUCCESS);
    vkGetBufferMemoryRequirements(device, buffer, &need);
    vkGetPhysicalDeviceMemoryProperties(physical, &types);
    while (type < types.memoryTypeCount && !(need.memoryTypeBits & 1u << type))
        type++;
    VkMemoryAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                     .allocationSize = need.size,
                                     .memoryTypeIndex = type};
    assert_int_equal(vkAllocateMemory(device, &allocate, NULL, &memory), VK_SUCCESS);
    assert_int_equal(vkBindBufferMemory(device, buffer, memory, 0), VK_SUCCESS);
    return buffer;
}

static void two_fills(VkDevice device, VkBuffer buffer, bool barrier)
{
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkCommandPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    assert_int_equal(vkCreateCommandPool(device, &pool_info, NULL, &pool), VK_SUCCESS);
    VkCommandBufferAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = pool,
                                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                            .commandBufferCount = 1};
    assert_int_equal(vkAllocateCommandBuffers(device, &allocate, &commands), VK_SUCCESS);
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    assert_int_equal(vkBeginCommandBuffer(commands, &begin), VK_SUCCESS);
    vkCmdFillBuffer(commands, buffer, 0, 256, 1);
    VkMemoryBarrier between = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                               .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT};
    if (barrier)
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1,
                             &between, 0, NULL, 0, NULL);
    vkCmdFillBuffer(commands, buffer, 0, 256, 2);
    assert_int_equal(vkEndCommandBuffer(commands), VK_SUCCESS);
}

static void miss_a_barrier(struct seen *seen)
{
    VkPhysicalDevice physical;
    VkInstance instance = make_instance(seen);
    VkDevice device = make_device(instance, &physical);
    VkBuffer buffer = make_buffer(physical, device);
    two_fills(device, buffer, true);
    if (seen)
        assert_int_equal(seen->errors, 0);
    two_fills(device, buffer, false);
}

static void use_wrongly(struct seen *seen)
{
    VkPhysicalDevice physical;
    VkBuffer buffer;
    VkBufferCreateInfo nothing = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 0, .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VkInstance instance = make_instance(seen);
    VkDevice device = make_device(instance, &physical);
    if (seen)
        assert_int_equal(seen->errors, 0);
    (void)vkCreateBuffer(device, &nothing, NULL, &buffer);
}

/* Gives the device back before the buffer that was made on it. */
static void leave_a_buffer(struct seen *seen)
{
    VkPhysicalDevice physical;
    VkInstance instance = make_instance(seen);
    VkDevice device = make_device(instance, &physical);
    (void)make_buffer(physical, device);
    vkDestroyDevice(device, NULL);
}

static void a_missing_barrier_is_seen(void **state)
{
    struct seen seen = {0};
    (void)state;
    setenv("VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT", 1);
    miss_a_barrier(&seen);
    assert_true(seen.hazards > 0);
}

static void wrong_use_is_seen(void **state)
{
    struct seen seen = {0};
    (void)state;
    unsetenv("VK_LAYER_ENABLES");
    use_wrongly(&seen);
    assert_true(seen.errors > 0);
}

static void what_is_left_is_seen(void **state)
{
    struct seen seen = {0};
    (void)state;
    unsetenv("VK_LAYER_ENABLES");
    leave_a_buffer(&seen);
    assert_true(seen.errors > 0);
}

static void without_listening(void **state)
{
    (void)state;
    use_wrongly(NULL);
    leave_a_buffer(NULL);
    miss_a_barrier(NULL);
}

int main(int argc, char **argv)
{
    (void)argv;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_use_is_seen),
        cmocka_unit_test(a_missing_barrier_is_seen),
        cmocka_unit_test(what_is_left_is_seen),
    };
    const struct CMUnitTest for_the_script[] = {cmocka_unit_test(without_listening)};
    if (argc > 1)
        return cmocka_run_group_tests_name("validation", for_the_script, NULL, NULL);
    return cmocka_run_group_tests_name("validation", tests, NULL, NULL);
}
