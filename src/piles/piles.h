/* Piles of rocks in contact, without a simulation (Arches 5).
 *
 * A cube of side `side`, repeated in all directions, contains random points at least twice the rocks' radius apart. Their Voronoi cells
 * fill space. A rock is its cell, eroded from the faces by `erosion` radii times 1 - rho, where rho = exp(-(|p - c| / r)^2) around contact
 * points c on the faces (the largest, if there are several). So rocks stay in their cells, never overlap, and touch at contact points.
 * Rocks deep inside of a pile are not placed.
 */
#ifndef HOODOO_PILES_H
#define HOODOO_PILES_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct pile_contact {
    double at[3];    /* m, from the rock's centre */
    size_t other;    /* the rock that it touches */
    double shift[3]; /* m, from this rock's centre to the other's, in its periodic image */
};

struct pile_rock {
    double center[3]; /* m, in the tile */
    double reach;     /* m: largest distance of a vertex from the centre */
    size_t n_contacts, contacts_capacity;
    struct pile_contact *contact;
    /* A closed mesh around the centre, oriented outwards; all rocks share the triangles of struct pile_tile. */
    size_t n_vertices;
    float *vertex, *normal; /* [n_vertices][3] m */
};

struct pile_tile {
    double side, radius, reach; /* m; reach: the largest of its rocks */
    size_t n;
    struct pile_rock *rock;
    size_t n_triangles;
    uint32_t *triangle; /* [n_triangles][3], for all rocks */
};

struct pile_options {
    double radius;   /* m: half the smallest distance between centres; above 0 */
    size_t rocks;    /* requested number; the tile may have a few less */
    double erosion;  /* in radii, 0 to 0.6 */
    size_t contacts; /* on each face */
    int detail;      /* 0..5: 20 * 4^detail triangles */
    uint32_t seed;
};

/* The same options give the same bits. Free with pile_tile_destroy(). E_MEMORY. */
MUST_USE status pile_tile_create(const struct pile_options *options, struct pile_tile *out);
void pile_tile_destroy(struct pile_tile *tile);

/* A placed rock. */
struct pile_place {
    double at[3];  /* m: its centre */
    uint32_t rock; /* of the tile */
    uint32_t id;   /* of the position: the same in all frames in which a rock is there */
};

/* Writes the height ranges lo..hi of the layers of rocks above (x, y), ascending, to span[most][2] and returns their number. */
typedef size_t (*pile_layers)(void *user, double x, double y, double (*span)[2], size_t most);

/* The rocks of the repeated tile whose centres are in layers of rocks over 0..size (m), at most twice the largest reach below the layer's
 * top. The caller frees *out. Heights must not be negative. Ids have 32 bits, which limits the number of the tile's rocks times its
 * repetitions. E_MEMORY. */
MUST_USE status pile_place_all(const struct pile_tile *tile, const double size[2], pile_layers layers,
                               void *user, struct pile_place **out, size_t *n);

#endif
