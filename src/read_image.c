/* hoodoo-read-image: one image for hoodoo (scene/image.h). */
#include "base/begin.h"
#include "scene/image_serve.h"

int main(int argc, char **argv)
{
    process_begin();
    return image_serve_main(argc, argv);
}
