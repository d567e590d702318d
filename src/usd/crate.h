/* One prim and its attributes, with a sample at one frame each, as a USD crate file of version 0.8.0: values,
 * then the sections TOKENS STRINGS FIELDS FIELDSETS PATHS SPECS, then where they are. Little endian, as this
 * machine is. Sections are in the compressed forms that readers want, of which the plainest is used: they are a
 * kilobyte beside megabytes of values.
 *
 * A table says once what a prim has: the crate's writer and the declarations in stage and manifest go by it.
 */
#ifndef HOODOO_USD_CRATE_H
#define HOODOO_USD_CRATE_H

#include "vdb/vdb.h"

/* Of the crate's value types. */
enum usd_type {
    USD_INT = 3,
    USD_INT64 = 5,
    USD_FLOAT = 8,
    USD_DOUBLE = 9,
    USD_TOKEN = 11,
    USD_QUATH = 18,
    USD_VEC3F = 24
};

struct usd_attribute {
    const char *name, *type; /* as in text */
    enum usd_type value;
    size_t size; /* bytes of an item */
    const char *interpolation;
};

enum { USD_ATTRIBUTES_MAX = 10 + VALUES };

struct usd_prim {
    const char *name, *type;
    const char *folder; /* of its files and their manifest */
    size_t n;
    struct usd_attribute attribute[USD_ATTRIBUTES_MAX]; /* by name */
};

/* One more attribute, in its place; which[], of each attribute, gets `is` there: readers of crates look for them by name. */
void usd_prim_add(struct usd_prim *prim, int which[USD_ATTRIBUTES_MAX], struct usd_attribute attribute,
                  int is);

/* A value as a primvar of vertices or points. */
struct usd_attribute usd_primvar(enum value_id value);

const struct usd_prim *usd_points_prim(bool moves); /* points.c */
extern const struct usd_prim usd_rocks_prim;        /* rocks.c */

/* An attribute's array. */
struct usd_items {
    const void *at;
    size_t n;
};

/* The file of the prim; items[prim->n] in its attributes' order. Equal input gives equal bytes. out->bytes is
 * freed with free(). */
MUST_USE status usd_crate(const struct usd_prim *prim, const struct usd_items *items, int up, int frame,
                          double fps, struct vdb_bytes *out);

#endif
