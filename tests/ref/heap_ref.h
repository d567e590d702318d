/* The surface of heaps as it is shown, in plain C over all voxels: heights of columns, what slides, and the share of space that is
 * filled (shaders/field/heap.glsl). */
#ifndef HOODOO_TESTS_HEAP_REF_H
#define HOODOO_TESTS_HEAP_REF_H

/* loose: how much of each voxel is filled, by deposits, or below 0 by rock. The share of each, in an array the caller frees. */
float *heap_ref_share(const float *loose, const int voxels[3], double repose_deg, int sweeps);

#endif
