/* The rock as host memory: one array a field, as scenes make it, checkpoints keep it and files show it. */
#ifndef HOODOO_ROCK_H
#define HOODOO_ROCK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "job/values.h"

enum { STATE, DERIVED };

enum rock_field {
#define FIELD(name, type, components, keep, vdb, unit, meaning) ROCK_##name,
#include "particles/particles.def"
    ROCK_FIELDS
};

struct rock_field_info {
    const char *name, *vdb, *unit, *meaning;
    int components; /* 1 or 4 */
    int is_float;   /* else uint32_t */
    int keep;       /* STATE or DERIVED */
};

extern const struct rock_field_info rock_field_table[ROCK_FIELDS];

/* The field (enum rock_field) that a value of values.def is; -1 if it is none. */
extern const int value_field[VALUES];

/* n particles. Arrays have n * components items; a field nobody has filled yet is NULL. */
struct rock {
    size_t n;
    union {
        struct {
#define FIELD(name, type, components, keep, vdb, unit, meaning) type *name;
#include "particles/particles.def"
        };
        void *field[ROCK_FIELDS];
    };
};

/* Does only some rock have the field: where the job asks for it? Its arrays are NULL elsewhere. */
static inline bool rock_field_asked(int field)
{
    return field == ROCK_exposed_kyr || field == ROCK_seepage;
}

/* Zeroed arrays for n particles, for fields with keep <= `keep` (STATE, or DERIVED for all), but for those that only some rock
 * has: rock_keep() adds one of these. */
MUST_USE status rock_alloc(struct rock *rock, size_t n, int keep);
MUST_USE status rock_keep(struct rock *rock, enum rock_field field);
void rock_free(struct rock *rock);

/* Bytes of one particle's value of a field. */
size_t rock_field_size(enum rock_field field);

#endif
