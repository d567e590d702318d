/* hoodoo-read-image: reads one image in a sandbox, on behalf of hoodoo (image/image.h). */
#include <string.h>

#include "image/serve.h"
#include "reader/translate.h"
#include "system/begin.h"

int main(int argc, char **argv)
{
    process_begin();
    if (argc == 4 && strcmp(argv[1], TRANSLATE_WORD) == 0)
        return translate(argv[2], argv[3]);
    return image_serve_main(argc, argv);
}
