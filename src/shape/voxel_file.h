/* Files voxels/NAME.1001.voxels, which the shape `voxels` reads: how many 64ths of each voxel are rock. src/voxels/FORMAT.md has the
 * layout. */
#ifndef HOODOO_SHAPE_VOXEL_FILE_H
#define HOODOO_SHAPE_VOXEL_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct voxel_grid {
    int n[3];
    double h;       /* m: side of a voxel */
    uint8_t *parts; /* [n[0] n[1] n[2]]: 0..64 at (z ny + y) nx + x; owned */
};

/* Encodes n voxels of h m, of each of which `share` is rock, 0..1; the caller frees *bytes. E_MEMORY. */
MUST_USE status voxel_file_encode(const int n[3], double h, const float *share, void **bytes, size_t *size);

/* Free out->parts. E_INPUT: the file is missing, damaged or hostile. E_MEMORY. */
MUST_USE status voxel_file_read(const char *path, struct voxel_grid *out);

#endif
