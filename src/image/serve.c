#include "image/serve.h"

#include <stdlib.h>
#include <string.h>

#include "image/decode.h"
#include "image/image.h"
#include "image/plain.h"
#include "reader/serve.h"

/* Bytes. Decoders hold several channels, in several formats, at a time. */
#define MEMORY ((uint64_t)4 << 30)

static status decode(struct image_decoding *m)
{
    const bool raw = image_argument_is(m, ASK_FORM, "r16") || image_argument_is(m, ASK_FORM, "r32");
    if (!raw && (!image_argument_is(m, ASK_WIDTH, "0") || !image_argument_is(m, ASK_HEIGHT, "0")))
        return fail(E_USAGE, "%s: size_px is only for raw values (.r16, .r32): this file states its own size",
                    m->path);
    if (raw)
        return image_decode_raw(m);
    return image_is_pgm(m->open_path) ? image_decode_pgm(m) : image_decode(m);
}

static status read_image(const struct serve_question *question, struct serve_answer *answer)
{
    status st = OK;
    struct image_decoding m = {.path = question->path,
                               .open_path = question->path,
                               .argument = question->argument,
                               .max_pixels = IMAGE_MAX_PIXELS};
    if (question->n_arguments != ASK_COUNT)
        return fail(E_INPUT,
                    "%s: hoodoo-read-image got %zu arguments: hoodoo and its readers are of different builds",
                    question->path, question->n_arguments);
    if (image_argument_is(&m, ASK_FORM, "tiff"))
        m.open_path = READER_INPUT_PATH;
    TRY(decode(&m));
    if (m.answer.n_outside)
        image_note(&m, false, "%llu of %llu pixels are outside of its data window and %s",
                   (unsigned long long)m.answer.n_outside, (unsigned long long)(m.width * m.height),
                   m.drops_outside && m.is_height ? "have no value" : "are black");
    TRY(serve_add_part(answer, &m.answer, sizeof m.answer));
    TRY(serve_add_part(answer, m.messages, strlen(m.messages)));
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
