#include "look/states.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/build.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/memory.h"
#include "system/atomic_file.h"
#include "system/cache.h"
#include "text/text.h"

static const char ending[] = ".state";

void states_open(const struct gpu_info *device, struct states *out)
{
    struct text t = {0};
    *out = (struct states){0};
    text_add(&t, "%s\n%s\n%s\n%s", hoodoo_build, device->name, device->driver, device->uuid);
    if (text_status(&t) == OK && cache_folder(&out->folder) &&
        path_join(&out->folder, out->folder.text, "look") == OK && folder_make(out->folder.text) == OK) {
        out->salt = hash_bytes(t.data, t.size);
        atomic_file_sweep(out->folder.text);
    } else {
        out->folder.text[0] = '\0';
    }
    text_free(&t);
}

static bool path_of(const struct states *s, uint64_t hash, struct path *out)
{
    const uint64_t both[2] = {hash, s->salt};
    char name[17];
    return *s->folder.text && path_format(out, "%s/%s%s", s->folder.text,
                                          hash_text(hash_bytes(both, sizeof both), name), ending) == OK;
}

bool states_has(const struct states *s, uint64_t hash)
{
    struct path path;
    return path_of(s, hash, &path) && utimensat(AT_FDCWD, path.text, NULL, 0) == 0;
}

void states_drop(const struct states *s, uint64_t hash)
{
    struct path path;
    if (path_of(s, hash, &path))
        unlink(path.text);
}

size_t states_find(const struct states *s, const uint64_t *hash, size_t n, struct checkpoint *out)
{
    struct path path;
    for (size_t i = n; i-- > 0;) {
        if (!states_has(s, hash[i]) || !path_of(s, hash[i], &path))
            continue;
        if (checkpoint_read(path.text, out) == OK)
            return i;
        states_drop(s, hash[i]);
    }
    return n;
}

void states_keep(struct states *s, uint64_t hash, const struct checkpoint *state)
{
    struct path path;
    void *bytes = NULL;
    size_t size;
    if (!path_of(s, hash, &path) || states_has(s, hash))
        return;
    if ((checkpoint_encode(state, &bytes, &size) != OK || atomic_file_write(path.text, bytes, size) != OK) &&
        !s->complained) {
        log_warn("%s; states cannot be cached, so looks start at the first frame", status_message());
        s->complained = true;
    }
    free(bytes);
}

/* ---- the limit of the cache */

struct kept {
    struct path path;
    struct timespec used;
    uint64_t size;
};

static int by_use(const void *a, const void *b)
{
    const struct kept *x = a, *y = b;
    if (x->used.tv_sec != y->used.tv_sec)
        return x->used.tv_sec < y->used.tv_sec ? -1 : 1;
    return (x->used.tv_nsec > y->used.tv_nsec) - (x->used.tv_nsec < y->used.tv_nsec);
}

static bool is_state(const char *name)
{
    const size_t n = strlen(name);
    return n == 16 + strlen(ending) && strcmp(name + 16, ending) == 0;
}

void states_trim(const struct states *s)
{
    DIR *folder = *s->folder.text ? opendir(s->folder.text) : NULL;
    struct kept *kept = NULL;
    size_t n = 0, capacity = 0;
    uint64_t sum = 0;
    struct stat info;
    for (struct dirent *e; folder && (e = readdir(folder));) {
        if (!is_state(e->d_name))
            continue;
        if (memory_grow(&kept, &capacity, n + 1, sizeof *kept, "kept states") != OK)
            break;
        if (path_join(&kept[n].path, s->folder.text, e->d_name) != OK || stat(kept[n].path.text, &info) != 0)
            continue;
        kept[n].used = info.st_mtim;
        kept[n].size = (uint64_t)info.st_size;
        sum += kept[n++].size;
    }
    if (folder)
        closedir(folder);
    if (sum > STATES_BYTES)
        qsort(kept, n, sizeof *kept, by_use);
    for (size_t i = 0; i < n && sum > STATES_BYTES; i++) {
        unlink(kept[i].path.text);
        sum -= kept[i].size;
    }
    free(kept);
}
