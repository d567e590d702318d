/* Where Mesa keeps the kernels that it has compiled. It maps a file of a megabyte, whose room it does not ask for: written on a
 * full disk, such as a home at its quota, that ends the process without a word. So the folder is ours, room in it is asked for
 * before, and where there is none nothing is kept. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/cache.h"
#include "base/log.h"
#include "base/path.h"
#include "gpu/internal.h"

/* What Mesa puts into the folder that it is told, and the file in that which it maps. */
static const char inside[] = "mesa_shader_cache", mapped[] = "mesa_shader_cache/index";

/* In bytes: the mapped file, and kernels. */
enum { ROOM = 4 << 20 };

/* What the user has told Mesa itself comes behind what hoodoo was told. */
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
    bool good = posix_fallocate(fd, 0, ROOM) == 0;
    close(fd);
    unlink(probe.text);
    return good;
}

/* Room for all of the mapped file, if there is one. */
static bool hold_room(const char *folder)
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
        folder_make(whole.text) == OK && has_room(folder.text) && hold_room(folder.text))
        setenv("MESA_SHADER_CACHE_DIR", folder.text, 1);
    else
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
}

void shader_cache_hold(void)
{
    const char *folder = getenv("MESA_SHADER_CACHE_DIR");
    if (folder && !getenv("MESA_SHADER_CACHE_DISABLE") && !hold_room(folder))
        log_warn("%s has no room for compiled kernels; name another folder in HOODOO_CACHE", folder);
}
