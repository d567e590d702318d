/* The generalised winding number of a triangle mesh: 1 inside of a closed mesh, 0 outside, 2 where two parts overlap. Around holes it
 * varies smoothly, so that 1/2 still separates inside from outside.
 *
 * w(x) = sum over triangles of their signed solid angle seen from x, divided by 4 pi (Jacobson et al., Robust Inside-Outside Segmentation
 * using Generalized Winding Numbers, SIGGRAPH 2013). Distant groups of triangles are evaluated together, by the first two terms of their
 * multipole series (Barill et al., Fast Winding Numbers for Soups and Clouds, SIGGRAPH 2018).
 */
#ifndef HOODOO_MESHINPUT_WINDING_H
#define HOODOO_MESHINPUT_WINDING_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct winding;

/* Positive inside of faces that are counter-clockwise from outside. `far`: a group is evaluated together beyond this many of its radii;
 * at 2 the error is at most 0.05, at 1.5 at most 0.1 in half the time. The mesh is not used after the call. E_MEMORY. */
MUST_USE status winding_create(const double (*vertex)[3], size_t n_vertices, const uint32_t (*triangle)[3],
                               size_t n_triangles, double far, struct winding **out);
void winding_destroy(struct winding **winding);

/* The same point gives the same bits. Thread-safe. */
float winding_number(const struct winding *winding, const double x[3]);

/* number[i] = winding_number(x[i]) for n points, in parallel. */
void winding_numbers(const struct winding *winding, const double (*x)[3], size_t n, float *number);

#endif
