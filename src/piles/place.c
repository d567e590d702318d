#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "piles/piles.h"

enum { SPANS = 64 };

struct places {
    struct pile_place *at;
    size_t n, capacity;
};

/* Adds rock i of the tiles stacked at one position, wherever a layer contains its centre. `column` numbers the position
 * among `columns`. */
static status place_rock(const struct pile_tile *t, size_t i, double x, double y, size_t column,
                         size_t columns, double (*span)[2], size_t n, struct places *out)
{
    status st = OK;
    double z0 = t->rock[i].center[2];
    for (size_t k = 0; k < n; k++) {
        double lo = fmax(span[k][0], span[k][1] - 2 * t->reach), hi = span[k][1];
        for (double tile = fmax(ceil((lo - z0) / t->side), 0); z0 + tile * t->side < hi; tile++) {
            size_t id = (size_t)tile * columns + column;
            TRY(memory_grow(&out->at, &out->capacity, out->n + 1, sizeof *out->at, "rocks"));
            out->at[out->n++] = (struct pile_place){{x, y, z0 + tile * t->side}, (uint32_t)i, (uint32_t)id};
        }
    }
done:
    return st;
}

status pile_place_all(const struct pile_tile *t, const double size[2], pile_layers layers, void *user,
                      struct pile_place **out, size_t *n)
{
    status st = OK;
    struct places places = {0};
    double span[SPANS][2];
    size_t nx = (size_t)ceil(size[0] / t->side), ny = (size_t)ceil(size[1] / t->side);
    for (size_t b = 0; b < ny; b++)
        for (size_t a = 0; a < nx; a++)
            for (size_t i = 0; i < t->n; i++) {
                double x = (double)a * t->side + t->rock[i].center[0];
                double y = (double)b * t->side + t->rock[i].center[1];
                if (x >= size[0] || y >= size[1])
                    continue;
                TRY(place_rock(t, i, x, y, (b * nx + a) * t->n + i, nx * ny * t->n, span,
                               layers(user, x, y, span, SPANS), &places));
            }
    TRY(memory_grow(&places.at, &places.capacity, 1, sizeof *places.at,
                    "rocks")); /* so that an empty list is not NULL */
    *out = places.at;
    *n = places.n;
    places.at = NULL;
done:
    free(places.at);
    return st;
}
