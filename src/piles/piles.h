/* Piles of rocks that lie in contact, without simulating any (Arches 5).
 *
 * A cube of side `side` holds random points no nearer to each other than twice the rocks' radius, and repeats
 * in all directions. Their Voronoi cells fill space; each wears back from its faces, by a share of the radius
 * weighted with 1 - rho, where rho = exp(-(|p - c| / r)^2) around contact points c on the faces (the largest
 * where there are several). So rocks stay in their cells, never overlap, and touch at the contact points.
 * What lies far inside a pile is not placed.
 */
#ifndef HOODOO_PILES_H
#define HOODOO_PILES_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct pile_contact {
    double at[3];    /* m, from the rock's centre */
    size_t other;    /* the rock it touches */
    double shift[3]; /* that rock's centre there, from this one's */
};

struct pile_rock {
    double center[3]; /* m, in the tile */
    double reach;     /* m: no vertex is farther from the centre */
    size_t n_contacts, contacts_capacity;
    struct pile_contact *contact;
    /* A closed mesh around the centre, outward, and the same number of triangles for every rock. */
    size_t n_vertices;
    float *vertex, *normal; /* [n_vertices][3] m */
};

struct pile_tile {
    double side, radius, reach; /* m; reach: of its largest rock */
    size_t n;
    struct pile_rock *rock;
    size_t n_triangles;
    uint32_t *triangle; /* [n_triangles][3], of every rock */
};

struct pile_options {
    double radius;   /* m, of the spheres that hold the rocks apart; above 0 */
    size_t rocks;    /* wanted; there may be a few less */
    double erosion;  /* in radii, 0 to 0.6 */
    size_t contacts; /* on each face */
    int detail;      /* 0..5: 20 * 4^detail triangles */
    uint32_t seed;
};

MUST_USE status pile_tile_create(const struct pile_options *options, struct pile_tile *out);
void pile_tile_destroy(struct pile_tile *tile);

/* A rock where it lies. */
struct pile_place {
    double at[3];  /* m: its centre */
    uint32_t rock; /* of the tile */
    uint32_t id;   /* of the place: the same whenever a rock lies there */
};

/* Heights lo..hi of the layers of rocks over (x, y), ascending, into span[most][2]; how many. */
typedef size_t (*pile_layers)(void *user, double x, double y, double (*span)[2], size_t most);

/* The rocks of the repeated tile whose centres lie in layers of rocks over 0..size, no deeper below a layer's
 * top than twice the largest reach. In *out, freed with free(). Heights are 0 and more; ids are of 32 bits, so
 * that the tile's rocks times its repetitions in all three directions must be fewer. */
MUST_USE status pile_place_all(const struct pile_tile *tile, const double size[2], pile_layers layers,
                               void *user, struct pile_place **out, size_t *n);

#endif
