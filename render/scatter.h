/* Stones, shrubs, grass and a person around the rock, which show its size. The position and size (m) of each is a hash of its cell, so it
 * stays the same from frame to frame unless the ground below it changes. */
#ifndef HOODOO_SCATTER_H
#define HOODOO_SCATTER_H

#include "particles/rock.h"
#include "piles/piles.h"
#include "render/ground.h"
#include "vdb/vdb.h"

/* Declares the shapes Stone_0 to Stone_8 and Plant_0 to Plant_2. Call before the functions below. */
enum { SCATTER_STONES = 9, SCATTER_PLANTS = 3 };
MUST_USE status scatter_shapes(struct text *out);

/* Adds stones and plants on the ground that the cameras see, unless they are smaller than two pixels. */
void scatter_ground(const struct ground *g, const struct camera *camera, size_t n_cameras, struct text *out);

/* Adds plants where the mesh has plant cover; `cover` is [n_vertices], 0..1. */
void scatter_plants(const struct vdb_mesh *mesh, const float *cover, struct text *out);

/* Adds angular blocks where the mesh is scree; `loose` is [n_vertices], 0..1. There is about one block per square metre, most of them small.
 * Blocks smaller than two pixels are omitted; `pixel` is the size of a pixel in m. */
void scatter_scree(const struct vdb_mesh *mesh, const float *loose, double pixel, struct text *out);

/* Adds the rocks of piles: angular, of various sizes around `radius` (m), in the colours of the beds. Uses the texture array
 * Rubble_Bed[Layers]. */
void scatter_rocks(const struct job *job, const struct rock *at, double radius, struct text *out);

/* Adds a person of 1.75 m in front of the rock or low on it, on the side of the camera. */
void scatter_figure(const struct ground *g, const struct camera *camera, struct text *out);

#endif
