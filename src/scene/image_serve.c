#include "scene/image_serve.h"

#include <stdlib.h>

#include "scene/image.h"
#include "scene/image_shim.h"

/* Decoders hold more than a channel, and in more than one form. */
#define MEMORY ((uint64_t)4 << 30)

static status read_image(const struct serve_question *question, struct serve_answer *answer)
{
    status st = OK;
    struct image_part part;
    size_t width = 0, height = 0;
    float *value = NULL;
    TRY(image_decode(question->path, IMAGE_MAX_PIXELS, &width, &height, &value));
    part = (struct image_part){width, height};
    TRY(serve_put(answer, &part, sizeof part));
    TRY(serve_put(answer, value, width * height * sizeof *value));
done:
    free(value);
    return st;
}

int image_serve_main(int argc, char **argv)
{
    static const struct serve_kind kinds[] = {{"image", MEMORY, read_image}};
    return serve(argc, argv, kinds, sizeof kinds / sizeof *kinds);
}
