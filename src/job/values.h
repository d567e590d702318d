/* The values that frames show: values.def as data, for all code that writes, reads, draws or names values. */
#ifndef HOODOO_VALUES_H
#define HOODOO_VALUES_H

#include <stdbool.h>
#include <stddef.h>

#include "text/text.h"

enum value_id {
    VALUE_NONE, /* the rock in its natural colours */
#define VALUE(name, unit, symbol, of, from, kind, has, where, bits, layer, channels, legend, meaning)        \
    VALUE_##name,
#include "job/values.def"
    VALUES
};

enum value_from {
    FROM_NOWHERE,
    FROM_SKIN,
    FROM_NEAREST,
    FROM_MEANS,
    FROM_AROUND,
    FROM_DISTANCE,
    FROM_SHARE,
    FROM_COLOR,
    FROM_DEPTH,
    FROM_PLACE,
    FROM_FACING,
    FROM_MOTION,
    FROM_AIR,
    FROM_TERRAIN,
    FROM_POINTS
};
enum value_kind { KIND_SCALAR, KIND_VECTOR, KIND_ID };
enum value_has {
    HAS_ALWAYS = 1,
    HAS_WATER = 2,
    HAS_PLANTS = 4,
    HAS_DEPOSITS = 8,
    HAS_WIND = 16,
    HAS_TERRAIN = 32,
    HAS_MOTION = 64,
    HAS_EXPOSED = 128,
    HAS_SEEPAGE = 256
};
enum value_where {
    IN_VOLUMES = 1,
    IN_MESHES = 2,
    IN_PICTURES = 4,
    IN_SHOW = 8,
    IN_USD = 16,
    IN_AIR = 32,
    EVERYWHERE = IN_VOLUMES | IN_MESHES | IN_PICTURES | IN_SHOW | IN_USD
};
enum value_bits { BITS_EXACT, BITS_HALF, BITS_SHARE, BITS_DIRECTION };
enum value_axis { AXIS_LINEAR, AXIS_LOG, AXIS_DIVERGING };
enum value_span { SPAN_FIXED, SPAN_STRESS, SPAN_WEIGHT, SPAN_WATER, SPAN_RATES, SPAN_LAYERS };

enum { VALUE_CHANNELS = 4, VALUE_NAME = 15 }; /* most channels of a value, and letters of a name */

struct value_legend {
    const char *unit; /* NULL: the value has no legend */
    double scale;
    enum value_axis axis;
    enum value_span span;
    double low, high; /* SPAN_FIXED */
    const char *above, *below;
};

struct value {
    const char *name, *unit, *symbol, *meaning;
    enum value_from from;
    enum value_kind kind;
    enum value_has has;
    unsigned where; /* IN_* */
    enum value_bits bits;
    const char *layer;                   /* "": not in pictures */
    const char *channel[VALUE_CHANNELS]; /* full names, NULL after the last */
    struct value_legend legend;
};

#ifdef __cplusplus
extern "C" {
#endif

extern const struct value value_table[VALUES];

/* The value by name; VALUE_NONE if there is none. */
enum value_id value_of_name(const char *name);

/* The names of the values in any of these places (IN_*), in the table's order. Returns their number. */
size_t value_names(unsigned where, const char *out[VALUES]);

/* The names of the layers of pictures. Returns their number. */
size_t value_layers(const char *out[VALUES]);

/* The number of grids in the volumes of a frame with the features `has` (HAS_*); a grid of vectors counts as three. */
size_t value_grids(unsigned has);

/* The table as Markdown. */
void value_reference(struct text *out);

#ifdef __cplusplus
}
#endif
#endif
