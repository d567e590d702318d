#include "image/serve.h"

#include <stdlib.h>
#include <string.h>

#include "image/decode.h"
#include "image/image.h"
#include "image/plain.h"
#include "reader/serve.h"

/* Decoders hold more than a channel, and in more than one form. */
#define MEMORY ((uint64_t)4 << 30)

static status decode(struct image_made *m)
{
    const bool raw = image_asks(m, ASK_FORM, "r16") || image_asks(m, ASK_FORM, "r32");
    if (!raw && (!image_asks(m, ASK_WIDTH, "0") || !image_asks(m, ASK_HEIGHT, "0")))
        return fail(E_USAGE, "%s: size_px is for raw values (.r16, .r32); this file says its size itself",
                    m->path);
    if (raw)
        return image_decode_raw(m);
    return image_is_pgm(m->open) ? image_decode_pgm(m) : image_decode(m);
}

static status read_image(const struct serve_question *question, struct serve_answer *answer)
{
    status st = OK;
    struct image_made m = {.path = question->path,
                           .open = question->path,
                           .word = question->argument,
                           .max_pixels = IMAGE_MAX_PIXELS};
    if (question->n_arguments != ASK_WORDS)
        return fail(E_INPUT, "%s: its reader is asked in %zu words", question->path, question->n_arguments);
    if (image_asks(&m, ASK_FORM, "tiff"))
        m.open = READER_INPUT_PATH;
    TRY(decode(&m));
    if (m.part.n_outside)
        image_note(&m, false, "%llu of %llu pixels are outside of its data window: %s",
                   (unsigned long long)m.part.n_outside, (unsigned long long)(m.width * m.height),
                   m.drops_outside && m.is_height ? "they have no value" : "black");
    TRY(serve_add_part(answer, &m.part, sizeof m.part));
    TRY(serve_add_part(answer, m.said, strlen(m.said)));
    TRY(serve_add_part(answer, m.value, m.width * m.height * sizeof *m.value));
done:
    free(m.value);
    return st;
}

int image_serve_main(int argc, char **argv)
{
    static const struct serve_kind kinds[] = {{"image", MEMORY, read_image}};
    return serve(argc, argv, kinds, sizeof kinds / sizeof *kinds);
}
