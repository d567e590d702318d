#include "particles/grids.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

size_t grid_bricks_of(const int n[3], int out[3])
{
    size_t total = 1;
    for (int a = 0; a < 3; a++) {
        out[a] = (n[a] + BRICK_SIDE - 1) / BRICK_SIDE;
        total *= (size_t)out[a];
    }
    return total;
}

status frame_grids_begin(const struct grid_lattice *lattice, struct frame_grids *out)
{
    *out = (struct frame_grids){.lattice = *lattice};
    const size_t n = grid_bricks_of(lattice->n, out->bricks.n);
    return memory_alloc(n, sizeof *out->bricks.slot, "bricks", &out->bricks.slot);
}

void frame_grids_choose(struct frame_grids *grids, uint32_t **numbers, size_t n)
{
    struct grid_bricks *b = &grids->bricks;
    b->number = *numbers;
    b->count = n;
    *numbers = NULL;
    for (size_t i = 0; i < n; i++)
        b->slot[b->number[i]] = (uint32_t)i + 1;
}

status frame_grids_add(struct frame_grids *grids, enum value_id value, struct frame_grid **out)
{
    const struct value *v = &value_table[value];
    bool again = false;
    for (size_t g = 0; g < grids->n_grids; g++)
        again |= strcmp(grids->grid[g].name, v->name) == 0;
    if (again || grids->n_grids == sizeof grids->grid / sizeof *grids->grid)
        return fail(E_OUTPUT, "grid '%s' cannot be added to a frame's %zu grids%s", v->name, grids->n_grids,
                    again ? ": it is there already" : "");
    *out = &grids->grid[grids->n_grids++];
    **out = (struct frame_grid){.name = v->name,
                                .unit = v->unit,
                                .kind = v->from == FROM_DISTANCE ? GRID_LEVEL_SET
                                        : v->from == FROM_SHARE  ? GRID_FOG
                                                                 : GRID_PLAIN,
                                .components = v->kind == KIND_VECTOR ? 3 : 1,
                                /* Deep inside, terrain is bedrock. */
                                .inside = v->from == FROM_SHARE || value == VALUE_bedrock ? 1 : 0};
    return OK;
}

status frame_grid_read(const struct frame_grids *grids, struct frame_grid *grid)
{
    return grid->value ? OK : grids->source.read(grids->source.user, grid, &grid->value);
}

const struct frame_grid *frame_grid_named(const struct frame_grids *grids, const char *name)
{
    for (size_t g = 0; g < grids->n_grids; g++)
        if (strcmp(grids->grid[g].name, name) == 0)
            return &grids->grid[g];
    return NULL;
}

void frame_grids_free(struct frame_grids *grids)
{
    for (size_t g = 0; g < grids->n_grids; g++) {
        free(grids->grid[g].value);
        free(grids->grid[g].deep);
    }
    free(grids->bricks.number);
    free(grids->bricks.slot);
    *grids = (struct frame_grids){0};
}
