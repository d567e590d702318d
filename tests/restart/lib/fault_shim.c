/* A library for LD_PRELOAD under which one call fails, once: the FAULT_AT-th (from 1) to the function FAULT_CALL, with the error number
 * FAULT_ERROR. Calls about files count only if the file's path contains FAULT_UNDER; calls of Vulkan fail for lack of device memory, submissions and waits because the device is lost. With
 * FAULT_NOTES=FILE the numbers of calls are written to FILE at the end, and which file the failed one was about. */
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

/* clang-format off */
#define CALLS(X)                                                                                             \
    X(open) X(fopen) X(read) X(pread) X(write) X(pwrite) X(writev) X(fsync) X(rename) X(link) X(mkdir) X(unlink) X(close)      \
    X(ftruncate) X(fallocate) X(mmap) X(opendir) X(stat) X(access) X(vkAllocateMemory) X(vkCreateBuffer)             \
    X(vkCreateComputePipelines) X(vkCreateDescriptorPool) X(vkAllocateCommandBuffers) X(vkMapMemory) X(vkQueueSubmit) X(vkWaitForFences)
/* clang-format on */
#define NAME(name) CALL_##name,
enum call { CALLS(NAME) N_CALLS };
#define TEXT(name) #name,
static const char *const names[] = {CALLS(TEXT)};

static atomic_long calls[N_CALLS];
static enum call chosen = N_CALLS;
static long at;
static int error = EIO;
static const char *under;
static char about[512];
static pid_t process;

static void note(void)
{
    const char *path = getenv("FAULT_NOTES");
    char text[4096];
    int n = 0;
    if (!path || getpid() != process)
        return;
    for (int i = 0; i < N_CALLS; i++)
        n += snprintf(text + n, sizeof text - (size_t)n, "%s %ld\n", names[i], (long)calls[i]);
    n += snprintf(text + n, sizeof text - (size_t)n, "about %s\n", about);
    const int fd = (int)syscall(SYS_open, path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    syscall(SYS_write, fd, text, n);
    syscall(SYS_close, fd);
}

__attribute__((constructor)) static void begin(void)
{
    const char *call = getenv("FAULT_CALL"), *number = getenv("FAULT_AT"), *code = getenv("FAULT_ERROR");
    for (int i = 0; call && i < N_CALLS; i++)
        if (strcmp(call, names[i]) == 0)
            chosen = (enum call)i;
    at = number ? atol(number) : 0;
    error = code ? atoi(code) : EIO;
    if (strncmp(program_invocation_short_name, "hoodoo-read", 11) != 0) /* readers.py kills these */
        under = getenv("FAULT_UNDER");
    process = getpid();
    atexit(note);
}

/* Whether this call is to fail. `path` or `fd` tells the file. */
static bool fails(enum call call, const char *path, int fd)
{
    char link[64], name[4096];
    if (!process || !under)
        return false;
    if (!path) {
        snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
        const long n = syscall(SYS_readlink, link, name, sizeof name - 1);
        if (fd < 0 || n <= 0)
            return false;
        name[n] = '\0';
        path = name;
    }
    if (!strstr(path, under))
        return false;
    const long now = ++calls[call];
    if (call != chosen || now != at)
        return false;
    snprintf(about, sizeof about, "%.500s", path);
    errno = error;
    return true;
}

#define REAL(name)                                                                                           \
    static __typeof__(name) *real;                                                                           \
    if (!real)                                                                                               \
        *(void **)&real = dlsym(RTLD_NEXT, #name);

static int mode_of(int flags, va_list list)
{
    return flags & (O_CREAT | O_TMPFILE) ? va_arg(list, int) : 0;
}
#define OPEN(name)                                                                                           \
    int name(const char *path, int flags, ...)                                                               \
    {                                                                                                        \
        REAL(name)                                                                                           \
        va_list list;                                                                                        \
        va_start(list, flags);                                                                               \
        const int mode = mode_of(flags, list);                                                               \
        va_end(list);                                                                                        \
        return fails(CALL_open, path, -1) ? -1 : real(path, flags, mode);                                    \
    }
OPEN(open)
OPEN(open64)
#define CALL(type, name, call, path, fd, failed, parameters, arguments)                                      \
    type name parameters                                                                                     \
    {                                                                                                        \
        REAL(name)                                                                                           \
        return fails(CALL_##call, path, fd) ? failed : real arguments;                                       \
    }
CALL(FILE *, fopen, fopen, path, -1, NULL, (const char *path, const char *mode), (path, mode))
CALL(FILE *, fopen64, fopen, path, -1, NULL, (const char *path, const char *mode), (path, mode))
CALL(ssize_t, read, read, NULL, fd, -1, (int fd, void *to, size_t n), (fd, to, n))
CALL(ssize_t, pread, pread, NULL, fd, -1, (int fd, void *to, size_t n, off_t from), (fd, to, n, from))
CALL(ssize_t, pread64, pread, NULL, fd, -1, (int fd, void *to, size_t n, off_t from), (fd, to, n, from))
CALL(ssize_t, write, write, NULL, fd, -1, (int fd, const void *from, size_t n), (fd, from, n))
CALL(ssize_t, pwrite, pwrite, NULL, fd, -1, (int fd, const void *from, size_t n, off_t to), (fd, from, n, to))
CALL(ssize_t, pwrite64, pwrite, NULL, fd, -1, (int fd, const void *from, size_t n, off_t to),
     (fd, from, n, to))
CALL(ssize_t, writev, writev, NULL, fd, -1, (int fd, const struct iovec *from, int n), (fd, from, n))
CALL(int, fsync, fsync, NULL, fd, -1, (int fd), (fd))
CALL(int, fdatasync, fsync, NULL, fd, -1, (int fd), (fd))
CALL(int, rename, rename, to, -1, -1, (const char *from, const char *to), (from, to))
CALL(int, link, link, to, -1, -1, (const char *from, const char *to), (from, to))
CALL(int, mkdir, mkdir, path, -1, -1, (const char *path, mode_t mode), (path, mode))
CALL(int, unlink, unlink, path, -1, -1, (const char *path), (path))
CALL(int, ftruncate, ftruncate, NULL, fd, -1, (int fd, off_t n), (fd, n))
CALL(int, ftruncate64, ftruncate, NULL, fd, -1, (int fd, off_t n), (fd, n))
CALL(int, posix_fallocate, fallocate, NULL, fd, error, (int fd, off_t from, off_t n), (fd, from, n))
CALL(int, fallocate, fallocate, NULL, fd, -1, (int fd, int mode, off_t from, off_t n), (fd, mode, from, n))
CALL(void *, mmap, mmap, NULL, fd, MAP_FAILED,
     (void *where, size_t n, int prot, int flags, int fd, off_t from), (where, n, prot, flags, fd, from))
CALL(void *, mmap64, mmap, NULL, fd, MAP_FAILED,
     (void *where, size_t n, int prot, int flags, int fd, off_t from), (where, n, prot, flags, fd, from))
CALL(DIR *, opendir, opendir, path, -1, NULL, (const char *path), (path))
CALL(int, stat, stat, path, -1, -1, (const char *path, struct stat *info), (path, info))
CALL(int, lstat, stat, path, -1, -1, (const char *path, struct stat *info), (path, info))
CALL(int, fstat, stat, NULL, fd, -1, (int fd, struct stat *info), (fd, info))
CALL(int, access, access, path, -1, -1, (const char *path, int mode), (path, mode))

int close(int fd)
{
    REAL(close)
    const bool failed = fails(CALL_close, NULL, fd);
    const int done = real(fd); /* a failed close() closes, too */
    errno = failed ? error : errno;
    return failed ? -1 : done;
}

/* ---- Vulkan */

#define DEVICE(name, parameters, arguments)                                                                  \
    FAILING(name, VK_ERROR_OUT_OF_DEVICE_MEMORY, parameters, arguments)
#define FAILING(name, result, parameters, arguments)                                                         \
    VKAPI_ATTR VkResult VKAPI_CALL name parameters                                                           \
    {                                                                                                        \
        REAL(name)                                                                                           \
        return fails(CALL_##name, under, -1) ? result : real arguments;                                      \
    }
DEVICE(vkAllocateMemory,
       (VkDevice d, const VkMemoryAllocateInfo *i, const VkAllocationCallbacks *a, VkDeviceMemory *m),
       (d, i, a, m))
DEVICE(vkCreateBuffer, (VkDevice d, const VkBufferCreateInfo *i, const VkAllocationCallbacks *a, VkBuffer *b),
       (d, i, a, b))
DEVICE(vkCreateComputePipelines,
       (VkDevice d, VkPipelineCache c, uint32_t n, const VkComputePipelineCreateInfo *i,
        const VkAllocationCallbacks *a, VkPipeline *p),
       (d, c, n, i, a, p))
DEVICE(vkCreateDescriptorPool,
       (VkDevice d, const VkDescriptorPoolCreateInfo *i, const VkAllocationCallbacks *a, VkDescriptorPool *p),
       (d, i, a, p))
DEVICE(vkAllocateCommandBuffers, (VkDevice d, const VkCommandBufferAllocateInfo *i, VkCommandBuffer *b),
       (d, i, b))
DEVICE(vkMapMemory,
       (VkDevice d, VkDeviceMemory m, VkDeviceSize from, VkDeviceSize n, VkMemoryMapFlags f, void **to),
       (d, m, from, n, f, to))
FAILING(vkQueueSubmit, VK_ERROR_DEVICE_LOST, (VkQueue q, uint32_t n, const VkSubmitInfo *i, VkFence f),
        (q, n, i, f))
FAILING(vkWaitForFences, VK_ERROR_DEVICE_LOST,
        (VkDevice d, uint32_t n, const VkFence *f, VkBool32 all, uint64_t timeout), (d, n, f, all, timeout))
