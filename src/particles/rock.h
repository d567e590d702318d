/* The rock in host memory, one array per field. Scenes make it, checkpoints store it, files show it. */
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

/* The field (enum rock_field) that a value of values.def shows; -1: none. */
extern const int value_field[VALUES];

/* n particles. Arrays have n * components items; NULL: the field is not set. */
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

/* Is the field only kept if the job needs it? Otherwise its arrays are NULL. */
static inline bool rock_field_is_optional(int field)
{
    return field == ROCK_exposed_kyr || field == ROCK_seepage;
}

/* Zeroed arrays for n particles, for fields with keep <= `keep` (STATE, or DERIVED for all), without optional ones, of which rock_keep()
 * adds one. Free with rock_free(). E_MEMORY. */
MUST_USE status rock_alloc(struct rock *rock, size_t n, int keep);
MUST_USE status rock_keep(struct rock *rock, enum rock_field field);
void rock_free(struct rock *rock);

/* The size of a field's value of one particle, bytes. */
size_t rock_field_size(enum rock_field field);

#endif
