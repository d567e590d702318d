#include "particles/rock.h"

#include <stdlib.h>

#include "base/memory.h"

const struct rock_field_info rock_field_table[ROCK_FIELDS] = {
#define FIELD(name, type, components, keep, vdb, unit, meaning)                                              \
    {#name, vdb, unit, meaning, components, _Generic((type)0, float : 1, default : 0), keep},
#include "particles/particles.def"
};

#define OF_FIELD(field) ROCK_##field
#define OF_MATERIAL(material) (-1)
#define OF_NOTHING (-1)
const int value_field[VALUES] = {
    OF_NOTHING,
#define VALUE(name, unit, symbol, of, from, kind, has, where, bits, layer, channels, legend, meaning) of,
#include "job/values.def"
};

size_t rock_field_size(enum rock_field field)
{
    return (size_t)rock_field_table[field].components * 4;
}

status rock_alloc(struct rock *rock, size_t n, int keep)
{
    status st = OK;
    *rock = (struct rock){.n = n};
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (rock_field_table[f].keep <= keep && !rock_field_is_optional(f))
            TRY(memory_alloc(n, rock_field_size((enum rock_field)f), rock_field_table[f].name,
                             &rock->field[f]));
done:
    if (st != OK)
        rock_free(rock);
    return st;
}

status rock_keep(struct rock *rock, enum rock_field f)
{
    return rock->field[f]
               ? OK
               : memory_alloc(rock->n, rock_field_size(f), rock_field_table[f].name, &rock->field[f]);
}

void rock_free(struct rock *rock)
{
    for (int f = 0; f < ROCK_FIELDS; f++)
        free(rock->field[f]);
    *rock = (struct rock){0};
}
