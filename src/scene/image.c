#include "scene/image.h"

#include "reader/reader.h"
#include "scene/image_serve.h"

status image_read(const char *path, size_t *width, size_t *height, float **value)
{
    status st = OK;
    struct reader_answer answer = {0};
    struct image_part part;
    *value = NULL;
    TRY(reader_ask(&(struct reader_question){.program = "hoodoo-read-image", .kind = "image", .path = path},
                   &answer));
    TRY(reader_take(&answer, &part, sizeof part));
    if (part.width < 1 || part.height < 1 || part.width > IMAGE_MAX_PIXELS / part.height) {
        st = reader_nonsense(&answer);
        goto done;
    }
    TRY(reader_take_array(&answer, (size_t)(part.width * part.height), sizeof **value, value));
    *width = (size_t)part.width;
    *height = (size_t)part.height;
done:
    reader_end(&answer);
    return st;
}
