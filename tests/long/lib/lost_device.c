/* A library for LD_PRELOAD under which the device is lost: the LOST_AT-th submission fails, or with LOST_LATE the wait for it, and every call after
 * it. With LOST_AT=0 none fails; the number of submissions is written to the file LOST_COUNT at the end. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <vulkan/vulkan.h>

static long submissions;
static int lost;

static long number(const char *name)
{
    const char *text = getenv(name);
    return text ? atol(text) : 0;
}

VKAPI_ATTR VkResult VKAPI_CALL vkQueueSubmit(VkQueue queue, uint32_t n, const VkSubmitInfo *info,
                                             VkFence fence)
{
    static PFN_vkQueueSubmit real;
    if (!real)
        *(void **)&real = dlsym(RTLD_NEXT, "vkQueueSubmit");
    submissions++;
    if (number("LOST_AT") && submissions >= number("LOST_AT")) {
        lost = 1;
        if (!getenv("LOST_LATE"))
            return VK_ERROR_DEVICE_LOST;
    }
    return real(queue, n, info, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL vkWaitForFences(VkDevice device, uint32_t n, const VkFence *fences,
                                               VkBool32 all, uint64_t timeout)
{
    static PFN_vkWaitForFences real;
    if (!real)
        *(void **)&real = dlsym(RTLD_NEXT, "vkWaitForFences");
    return lost ? VK_ERROR_DEVICE_LOST : real(device, n, fences, all, timeout);
}

__attribute__((destructor)) static void end(void)
{
    const char *path = getenv("LOST_COUNT");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (file) {
        fprintf(file, "%ld\n", submissions);
        fclose(file);
    }
}
