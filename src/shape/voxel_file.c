#include "shape/voxel_file.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "shape/probes.h"
#include "system/atomic_file.h"

static const char MAGIC[12] = "hoodoo.voxl";
enum { VERSION = 1, MAX_BYTES = 1 << 30, LONGEST = (1 << 24) - 1 };
static const double MAX_VOXELS = 1 << 30;

struct header {
    char magic[12];
    uint32_t version;
    int32_t n[3];
    uint32_t spare;
    uint64_t n_runs;
    double h;
};
_Static_assert(sizeof(struct header) == 48, "the header has no padding");

static size_t count_of(const int32_t n[3])
{
    return (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
}

/* The runs of equal voxels into `run`, or if NULL only their number. */
static size_t find_runs(const float *share, size_t n, uint32_t *run)
{
    size_t n_runs = 0;
    uint32_t last = UINT32_MAX, length = 0;
    for (size_t v = 0; v < n; v++) {
        const uint32_t parts = (uint32_t)lrint(fmin(fmax((double)share[v], 0), 1) * PROBES);
        if (parts != last || length == LONGEST) {
            n_runs++;
            length = 0;
        }
        last = parts;
        length++;
        if (run)
            run[n_runs - 1] = length << 8 | parts;
    }
    return n_runs;
}

status voxel_file_encode(const int n[3], double h, const float *share, void **bytes, size_t *size)
{
    status st = OK;
    struct header header = {.version = VERSION, .n = {n[0], n[1], n[2]}, .h = h};
    char *file;
    memcpy(header.magic, MAGIC, sizeof MAGIC);
    header.n_runs = find_runs(share, count_of(header.n), NULL);
    *size = sizeof header + 4 * header.n_runs + sizeof(uint64_t);
    TRY(memory_alloc(*size, 1, "voxels", &file));
    memcpy(file, &header, sizeof header);
    find_runs(share, count_of(header.n), (uint32_t *)(void *)(file + sizeof header));
    const uint64_t hash = hash_bytes(file, *size - sizeof hash);
    memcpy(file + *size - sizeof hash, &hash, sizeof hash);
    *bytes = file;
done:
    return st;
}

/* Is the header valid and consistent with a file of `size` bytes? */
static bool is_sane(const struct header *h, size_t size)
{
    if (memcmp(h->magic, MAGIC, sizeof MAGIC) != 0 || h->version != VERSION || h->n[0] < 1 || h->n[1] < 1 ||
        h->n[2] < 1)
        return false;
    if (h->n_runs > MAX_BYTES / 4)
        return false;
    return h->h > 1e-6 && h->h < 1e6 && size == sizeof *h + 4 * h->n_runs + sizeof(uint64_t);
}

/* False: the runs do not fill the n voxels exactly. */
static bool unpack(const uint32_t *run, size_t n_runs, size_t n, uint8_t *parts)
{
    size_t at = 0;
    for (size_t r = 0; r < n_runs; r++) {
        const size_t length = run[r] >> 8;
        if (length == 0 || length > n - at || (run[r] & 0xff) > PROBES)
            return false;
        memset(parts + at, (int)(run[r] & 0xff), length);
        at += length;
    }
    return at == n;
}

/* The number of voxels that the runs claim. So a small file cannot ask for much memory. */
static uint64_t claimed(const uint32_t *run, size_t n_runs)
{
    uint64_t sum = 0;
    for (size_t r = 0; r < n_runs; r++)
        sum += run[r] >> 8;
    return sum;
}

status voxel_file_read(const char *path, struct voxel_grid *out)
{
    status st = OK;
    void *bytes = NULL;
    size_t size = 0;
    struct header header;
    uint64_t hash;
    *out = (struct voxel_grid){0};
    TRY(file_read(path, MAX_BYTES, &bytes, &size));
    if (size < sizeof header + sizeof hash) {
        st = fail(E_INPUT, "%s: not a .voxels file: it has %zu bytes, fewer than a header", path, size);
        goto done;
    }
    memcpy(&header, bytes, sizeof header);
    memcpy(&hash, (char *)bytes + size - sizeof hash, sizeof hash);
    if (memcmp(header.magic, MAGIC, sizeof MAGIC) != 0) {
        st = fail(E_INPUT, "%s: not a .voxels file, which goblins write into voxels/ (goblins.voxels)", path);
        goto done;
    }
    if (hash != hash_bytes(bytes, size - sizeof hash) || !is_sane(&header, size)) {
        st = fail(E_INPUT, "%s: damaged: its %zu bytes are not those that its header and hash tell", path,
                  size);
        goto done;
    }
    const uint32_t *run = (const uint32_t *)(void *)((char *)bytes + sizeof header);
    const size_t n = count_of(header.n);
    if ((double)header.n[0] * header.n[1] * header.n[2] > MAX_VOXELS) {
        st = fail(E_INPUT, "%s: its %d x %d x %d voxels are more than 2^30", path, header.n[0], header.n[1],
                  header.n[2]);
        goto done;
    }
    if (claimed(run, header.n_runs) != n) {
        st = fail(E_INPUT, "%s: damaged: its %llu runs have %llu voxels, but its header %zu", path,
                  (unsigned long long)header.n_runs, (unsigned long long)claimed(run, header.n_runs), n);
        goto done;
    }
    *out = (struct voxel_grid){.n = {header.n[0], header.n[1], header.n[2]}, .h = header.h};
    TRY(memory_alloc(n, 1, "voxels", &out->parts));
    if (!unpack(run, header.n_runs, n, out->parts))
        st = fail(E_INPUT, "%s: damaged: a run is empty, or has more than %d parts of a voxel", path, PROBES);
done:
    free(bytes);
    if (st != OK) {
        free(out->parts);
        *out = (struct voxel_grid){0};
    }
    return st;
}
