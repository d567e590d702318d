/* A file of voxels, under a hash that is right. */
#include "fuzz/fuzz.h"

#include "base/hash.h"
#include "shape/voxel_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    struct voxel_grid grid;
    uint8_t *whole = malloc(n + 8);
    if (!whole)
        abort();
    memcpy(whole, bytes, n);
    n = n >= 8 ? n - 8 : n;
    const uint64_t hash = hash_bytes(whole, n);
    memcpy(whole + n, &hash, sizeof hash);
    const status st = voxel_file_read(fuzz_file("v.voxels", whole, n + 8), &grid);
    free(whole);
    fuzz_refused(st);
    free(grid.parts);
    return 0;
}
