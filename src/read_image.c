/* hoodoo-read-image: one image for hoodoo (scene/image.h). */
#include "scene/image_serve.h"

int main(int argc, char **argv)
{
    return image_serve_main(argc, argv);
}
