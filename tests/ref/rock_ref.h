/* Surface, normals, blocks and erodibility in plain C. Voxels are numbered (k ny + j) nx + i. */
#ifndef HOODOO_TESTS_ROCK_REF_H
#define HOODOO_TESTS_ROCK_REF_H

#include <stddef.h>
#include <stdint.h>

#include "particles/rock.h"

/* 1 for voxels with a particle; the caller's to free. */
uint8_t *rock_ref_voxels(const struct rock *rock, const int n[3], double h);

/* Has the voxel of a particle a bare face? The domain's sides and top are bare, the ground is not. */
int rock_ref_bare(const uint8_t *voxels, const int n[3], double h, const float *P);

/* The axis of least spread of particle i and its k nearest, pointing away from most of them (those up to two
 * voxels away on each axis). *margin: by how much the next neighbour's squared distance is larger, in h^2. */
void rock_ref_normal(const struct rock *rock, size_t i, size_t k, double h, double normal[3], double *margin);

/* 1 for each particle that nothing holds; the caller's to free. */
uint8_t *rock_ref_falls(const struct rock *rock, const int n[3], double h);

/* Retreat of bare rock at unit intensity, m/kyr. */
double rock_ref_retreat(double weak, double strong, double threshold, double factor, double stress,
                        double band);

#endif
