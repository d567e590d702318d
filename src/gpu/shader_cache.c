/* Selects the folder in which Mesa caches compiled kernels. Mesa maps a file of a megabyte there without allocating its blocks, so on a
 * full disk (such as a home folder at its quota) writing to it kills the process without a message. Therefore hoodoo chooses the
 * folder and allocates the blocks first; if that fails, the cache is disabled. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/log.h"
#include "base/path.h"
#include "gpu/internal.h"
#include "system/atomic_file.h"
#include "system/cache.h"

/* The folder that Mesa creates in the given one, and the file in it that Mesa maps. */
static const char inside[] = "mesa_shader_cache", mapped[] = "mesa_shader_cache/index";

/* Bytes for the mapped file and kernels. */
enum { SPACE = 4 << 20 };

/* HOODOO_CACHE takes precedence over Mesa's own variable. */
static bool find_folder(struct path *out)
{
    const char *hoodoo = getenv("HOODOO_CACHE"), *mesa = getenv("MESA_SHADER_CACHE_DIR");
    if (mesa && *mesa && !(hoodoo && *hoodoo))
        return path_format(out, "%s", mesa) == OK;
    return cache_folder(out);
}

static bool has_room(const char *folder)
{
    struct path probe;
    if (path_format(&probe, "%s/room.%ld", folder, (long)getpid()) != OK)
        return false;
    int fd = open(probe.text, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (fd < 0)
        return false;
    bool good = posix_fallocate(fd, 0, SPACE) == 0;
    close(fd);
    unlink(probe.text);
    return good;
}

/* Allocates the blocks of the mapped file, if it exists. */
static bool allocate_blocks(const char *folder)
{
    struct path path;
    struct stat is;
    if (path_join(&path, folder, mapped) != OK)
        return false;
    int fd = open(path.text, O_RDWR | O_CLOEXEC);
    if (fd < 0)
        return errno == ENOENT;
    bool good = fstat(fd, &is) == 0 && (is.st_size == 0 || posix_fallocate(fd, 0, is.st_size) == 0);
    close(fd);
    return good;
}

void shader_cache_choose(void)
{
    struct path folder, whole;
    if (getenv("MESA_SHADER_CACHE_DISABLE"))
        return;
    if (find_folder(&folder) && path_join(&whole, folder.text, inside) == OK &&
        folder_make(whole.text) == OK && has_room(folder.text) && allocate_blocks(folder.text))
        setenv("MESA_SHADER_CACHE_DIR", folder.text, 1);
    else
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
}

void shader_cache_hold(void)
{
    const char *folder = getenv("MESA_SHADER_CACHE_DIR");
    if (folder && !getenv("MESA_SHADER_CACHE_DISABLE") && !allocate_blocks(folder))
        log_warn("%s has no space for compiled kernels; set HOODOO_CACHE to another folder", folder);
}
