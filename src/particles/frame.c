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
    free(frame->deep.bits);
    for (size_t v = 0; v < DEEP_VALUES; v++)
        free(frame->deep.value[v]);
    rock_free(&frame->rocks.at);
    free(frame->rocks.box);
    free(frame->stacks.bytes);
    free(frame->voxels.bytes);
    frame_grids_free(&frame->grids);
    frame_grids_free(&frame->air);
    for (size_t i = 0; i < frame->n_images; i++)
        aov_image_free(&frame->image[i]);
    free(frame->image);
    *frame = (struct frame){0};
}
