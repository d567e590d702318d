/* Images in their reader. Its one kind, "image", answers with struct image_part and the first channel, floats, top row
 * first. */
#ifndef HOODOO_IMAGE_SERVE_H
#define HOODOO_IMAGE_SERVE_H

#include <stdint.h>

#include "reader/serve.h"

struct image_part {
    uint64_t width, height;
};

/* The main() of hoodoo-read-image. */
int image_serve_main(int argc, char **argv);

#endif
