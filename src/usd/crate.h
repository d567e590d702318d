/* USD crate files (version 0.8.0) of one prim whose attributes each have one sample, at one frame. The file has the values, then the
 * sections TOKENS STRINGS FIELDS FIELDSETS PATHS SPECS, then a table of sections; all little endian. Sections use the simplest of the
 * compressed forms that readers accept, because they take a kilobyte beside megabytes of values.
 *
 * struct usd_prim describes a prim for both the crate writer and the declarations in the stage and the clips' manifest.
 */
#ifndef HOODOO_USD_CRATE_H
#define HOODOO_USD_CRATE_H

#include "vdb/vdb.h"

/* Value types, with the numbers of the crate format. */
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
    const char *name, *type; /* as in .usda */
    enum usd_type value;
    size_t size; /* bytes of an item */
    const char *interpolation;
};

enum { USD_ATTRIBUTES_MAX = 10 + VALUES };

struct usd_prim {
    const char *name, *type;
    const char *folder; /* of its files and the clips' manifest */
    size_t n;
    struct usd_attribute attribute[USD_ATTRIBUTES_MAX]; /* sorted by name */
};

/* Inserts an attribute; readers of crates expect them sorted by name. which[], parallel to prim->attribute, gets `is` at its index. */
void usd_prim_add(struct usd_prim *prim, int which[USD_ATTRIBUTES_MAX], struct usd_attribute attribute,
                  int is);

/* The primvar attribute for a value, with one item per vertex or point. */
struct usd_attribute usd_primvar(enum value_id value);

const struct usd_prim *usd_points_prim(bool moves); /* points.c */
extern const struct usd_prim usd_rocks_prim;        /* rocks.c */

/* The array of an attribute: in memory at `at`, or made a few items at a time. */
struct usd_items {
    const void *at;
    size_t n;
    /* Writes n items, from item `first` on, to `out`; NULL: they are in memory. */
    void (*make)(const void *user, size_t first, size_t n, void *out);
    const void *user;
};

/* Encodes the file into an empty draft; items[prim->n] are in the order of the attributes. Equal input gives equal bytes. On an error the
 * caller drops the draft. */
MUST_USE status usd_crate(const struct usd_prim *prim, const struct usd_items *items, int up, int frame,
                          double fps, struct draft *out);

#endif
