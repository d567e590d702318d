/* What lies and grows around the rock, by which its size is seen: stones from pebbles to boulders, shrubs and grass, and a person.
 * Where each stands and how large it is (m) is a hash of its place, so it stays from frame to frame, unless the ground below it goes. */
#ifndef HOODOO_SCATTER_H
#define HOODOO_SCATTER_H

#include "particles/rock.h"
#include "piles/piles.h"
#include "render/ground.h"
#include "vdb/vdb.h"

/* Adds the shapes that others refer to: Stone_0 and so on, Plant_0 and so on. */
enum { SCATTER_STONES = 9, SCATTER_PLANTS = 3 };
MUST_USE status scatter_shapes(struct text *out);

/* Adds stones and plants on the ground that the cameras see, as far as each is two pixels large. */
void scatter_ground(const struct ground *g, const struct camera *camera, size_t n_cameras, struct text *out);

/* Adds plants where the mesh's value `cover` (0..1, one a vertex) has them. */
void scatter_plants(const struct vdb_mesh *mesh, const float *cover, struct text *out);

/* Adds angular blocks where the mesh's value `loose` (0..1, one a vertex) has scree: about one in a square metre, most of them small. Those
 * below two pixels (m each) are left out. */
void scatter_scree(const struct vdb_mesh *mesh, const float *loose, double pixel, struct text *out);

/* Adds the rocks of piles: angular, of many sizes around their tile's, of the beds' colours. Theirs is the texture array
 * Rubble_Bed[Layers]. */
void scatter_rocks(const struct job *job, const struct rock *at, double radius, struct text *out);

/* Adds a person of 1.75 m who stands low on the rock or before it, on the camera's side. */
void scatter_figure(const struct ground *g, const struct camera *camera, struct text *out);

#endif
