/* The attributes of usd_points(), once: the crate writer and the declarations in stage and manifest go by it. */
#ifndef HOODOO_USD_POINTS_H
#define HOODOO_USD_POINTS_H

/* Of the crate's value types. */
enum usd_type { USD_INT = 3, USD_INT64 = 5, USD_FLOAT = 8, USD_DOUBLE = 9, USD_TOKEN = 11, USD_VEC3F = 24 };

/*    member        name                     type in text  value type  interpolation */
#define USD_POINT_ATTRIBUTES(X)                                                                              \
    X(EXTENT, "extent", "float3[]", USD_VEC3F, "")                                                           \
    X(IDS, "ids", "int64[]", USD_INT64, "")                                                                  \
    X(NORMALS, "normals", "normal3f[]", USD_VEC3F, "vertex")                                                 \
    X(POINTS, "points", "point3f[]", USD_VEC3F, "")                                                          \
    X(COLOR, "primvars:displayColor", "color3f[]", USD_VEC3F, "vertex")                                      \
    X(LAYER, "primvars:layer", "int[]", USD_INT, "vertex")                                                   \
    X(STRESS, "primvars:stress", "float[]", USD_FLOAT, "vertex")                                             \
    X(VIABILITY, "primvars:viability", "float[]", USD_FLOAT, "vertex")                                       \
    X(VON_MISES, "primvars:von_mises", "float[]", USD_FLOAT, "vertex")                                       \
    X(WIDTHS, "widths", "float[]", USD_FLOAT, "constant")

enum {
#define USD_POINT_ENUM(member, name, type, value, interpolation) USD_POINT_##member,
    USD_POINT_ATTRIBUTES(USD_POINT_ENUM)
#undef USD_POINT_ENUM
        N_USD_POINT_ATTRIBUTES
};

#endif
