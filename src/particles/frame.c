#include "particles/frame.h"

#include <stdlib.h>
#include <string.h>

void aov_image_free(struct aov_image *image)
{
    free(image->channel);
    free(image->memory);
    for (size_t i = 0; i < image->n_notes; i++)
        free(image->note[i].value);
    free(image->note);
    *image = (struct aov_image){0};
}

void frame_free(struct frame *frame)
{
    rock_free(&frame->rock);
    rock_free(&frame->rocks.at);
    free(frame->rocks.box);
    free(frame->stacks.bytes);
    for (size_t g = 0; g < frame->grids.n_grids; g++)
        free(frame->grids.grid[g].value);
    for (size_t i = 0; i < frame->n_images; i++)
        aov_image_free(&frame->image[i]);
    free(frame->image);
    *frame = (struct frame){0};
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
                                .components = v->kind == KIND_VECTOR ? 3 : 1};
    return OK;
}
