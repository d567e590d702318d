#include "particles/frame.h"

#include <stdlib.h>

void frame_free(struct frame *frame)
{
    rock_free(&frame->rock);
    rock_free(&frame->rocks.at);
    free(frame->stacks.bytes);
    for (size_t g = 0; g < frame->grids.n_grids; g++)
        free(frame->grids.grid[g].value);
    for (size_t i = 0; i < frame->n_images; i++) {
        free(frame->image[i].channel);
        free(frame->image[i].memory);
    }
    free(frame->image);
    *frame = (struct frame){0};
}
