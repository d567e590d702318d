/* Checks and describes EXR files. Runs in hoodoo-read, because the files may be hostile. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <openexr.h>

#include "base/memory.h"
#include "exr/hash.h"
#include "exr/serve.h"
#include "reader/describe.h"
#include "system/atomic_file.h"

struct source {
    const char *path;
    char *bytes;
    size_t size;
    char message[256];
};

/* Reads as from a file, with fewer bytes at its end. The library reads headers ahead, and reports an error if it needed all bytes. */
static int64_t source_read(exr_const_context_t exr, void *user, void *bytes, uint64_t n, uint64_t at,
                           exr_stream_error_func_ptr_t error)
{
    const struct source *s = user;
    const uint64_t left = at < s->size ? s->size - at : 0, got = n < left ? n : left;
    (void)exr;
    (void)error;
    memcpy(bytes, s->bytes + (got ? at : 0), (size_t)got);
    return (int64_t)got;
}

static int64_t source_size(exr_const_context_t exr, void *user)
{
    (void)exr;
    return (int64_t)((const struct source *)user)->size;
}

static void source_complaint(exr_const_context_t exr, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (exr && exr_get_user_data(exr, &user) == EXR_ERR_SUCCESS && user)
        snprintf(((struct source *)user)->message, sizeof((struct source *)user)->message, "%s", message);
}

static status exr_status(exr_result_t code, const struct source *s)
{
    if (code == EXR_ERR_SUCCESS)
        return OK;
    return fail(E_INPUT, "%s: %s%s%s", s->path, exr_get_default_error_message(code), *s->message ? ": " : "",
                s->message);
}

#define TRY_EXR(call) TRY(exr_status((call), source))

static status read_chunk(exr_context_t exr, int part, int y, const struct source *source)
{
    status st = OK;
    exr_chunk_info_t info;
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    uint8_t *pixels = NULL;
    size_t want = 0;
    TRY_EXR(exr_read_scanline_chunk_info(exr, part, y, &info));
    TRY_EXR(exr_decoding_initialize(exr, part, &info, &pipe));
    for (int c = 0; c < pipe.channel_count; c++)
        want += (size_t)pipe.channels[c].width * (size_t)pipe.channels[c].height *
                (size_t)pipe.channels[c].bytes_per_element;
    TRY(memory_alloc(want, 1, source->path, &pixels));
    want = 0;
    for (int c = 0; c < pipe.channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipe.channels[c];
        channel->decode_to_ptr = pixels + want;
        channel->user_pixel_stride = channel->bytes_per_element;
        channel->user_line_stride = channel->bytes_per_element * channel->width;
        want += (size_t)channel->width * (size_t)channel->height * (size_t)channel->bytes_per_element;
    }
    TRY_EXR(exr_decoding_choose_default_routines(exr, part, &pipe));
    TRY_EXR(exr_decoding_run(exr, part, &pipe));
done:
    exr_decoding_destroy(exr, &pipe);
    free(pixels);
    return st;
}

static status read_part(exr_context_t exr, int part, const struct source *source)
{
    status st = OK;
    exr_storage_t storage;
    exr_attr_box2i_t window;
    int32_t lines = 0;
    TRY_EXR(exr_get_storage(exr, part, &storage));
    if (storage != EXR_STORAGE_SCANLINE) {
        st = fail(E_INPUT, "%s: part %d is tiled or deep, but hoodoo writes scan lines", source->path, part);
        goto done;
    }
    TRY_EXR(exr_get_data_window(exr, part, &window));
    TRY_EXR(exr_get_scanlines_per_chunk(exr, part, &lines));
    for (int64_t y = window.min.y; y <= window.max.y; y += lines)
        TRY(read_chunk(exr, part, (int)y, source));
done:
    return st;
}

static void describe_numbers(struct text *out, const char *key, const float *value, size_t n)
{
    json_array(out, key);
    for (size_t i = 0; i < n; i++)
        json_number(out, NULL, (double)value[i]);
    json_end_array(out);
}

static void describe_attribute(const exr_attribute_t *a, struct text *out)
{
    char line[64];
    switch (a->type) {
    case EXR_ATTR_INT:
        json_integer(out, a->name, a->i);
        break;
    case EXR_ATTR_FLOAT:
        json_number(out, a->name, (double)a->f);
        break;
    case EXR_ATTR_DOUBLE:
        json_number(out, a->name, a->d);
        break;
    case EXR_ATTR_STRING:
        json_text(out, a->name, a->string->str);
        break;
    case EXR_ATTR_RATIONAL:
        snprintf(line, sizeof line, "%d/%u", a->rational->num, a->rational->denom);
        json_text(out, a->name, line);
        break;
    case EXR_ATTR_TIMECODE:
        /* The bits between the digits are flags. */
        snprintf(line, sizeof line, "%02x:%02x:%02x:%02x", a->timecode->time_and_flags >> 24 & 0x3f,
                 a->timecode->time_and_flags >> 16 & 0x7f, a->timecode->time_and_flags >> 8 & 0x7f,
                 a->timecode->time_and_flags & 0x3f);
        json_text(out, a->name, line);
        break;
    case EXR_ATTR_M44F:
        describe_numbers(out, a->name, a->m44f->m, 16);
        break;
    case EXR_ATTR_CHROMATICITIES:
        describe_numbers(out, a->name, &a->chromaticities->red_x, 8);
        break;
    default: /* attributes described elsewhere, or not written by hoodoo */
        break;
    }
}

static status describe_part(exr_context_t exr, int part, const struct source *source, struct text *out)
{
    static const char *const compression[] = {"none",  "rle", "zips", "zip",  "piz",
                                              "pxr24", "b44", "b44a", "dwaa", "dwab"};
    static const char *const type[] = {"uint", "half", "float"};
    status st = OK;
    const char *name = NULL;
    exr_attr_box2i_t window;
    exr_compression_t how;
    const exr_attr_chlist_t *channels = NULL;
    int32_t n = 0;
    TRY_EXR(exr_get_data_window(exr, part, &window));
    TRY_EXR(exr_get_compression(exr, part, &how));
    TRY_EXR(exr_get_channels(exr, part, &channels));
    TRY_EXR(exr_get_attribute_count(exr, part, &n));
    json_object(out, NULL);
    if (exr_get_name(exr, part, &name) == EXR_ERR_SUCCESS && name)
        json_text(out, "name", name);
    json_integer(out, "width", (int64_t)window.max.x - window.min.x + 1);
    json_integer(out, "height", (int64_t)window.max.y - window.min.y + 1);
    json_text(out, "compression",
              (size_t)how < sizeof compression / sizeof *compression ? compression[how] : "?");
    json_array(out, "channels");
    for (int c = 0; c < channels->num_channels; c++) {
        json_object(out, NULL);
        json_text(out, "name", channels->entries[c].name.str);
        json_text(out, "type",
                  channels->entries[c].pixel_type < EXR_PIXEL_LAST_TYPE
                      ? type[channels->entries[c].pixel_type]
                      : "?");
        json_end_object(out);
    }
    json_end_array(out);
    json_object(out, "attributes");
    for (int32_t i = 0; i < n; i++) {
        const exr_attribute_t *a = NULL;
        TRY_EXR(exr_get_attribute_by_index(exr, part, EXR_ATTR_LIST_FILE_ORDER, i, &a));
        if (strcmp(a->name, "name") != 0)
            describe_attribute(a, out);
    }
    json_end_object(out);
    json_end_object(out);
done:
    return st;
}

/* Reads every pixel, and describes the file if `out` is not NULL. */
static status read_file(const char *path, struct text *out)
{
    status st = OK;
    struct source file = {.path = path}, *source = &file;
    exr_context_t exr = NULL;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = source_complaint;
    init.user_data = source;
    init.read_fn = source_read;
    init.size_fn = source_size;
    init.flags = EXR_CONTEXT_FLAG_STRICT_HEADER | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    int n = 0;
    TRY(file_read(path, SIZE_MAX / 2, &file.bytes, &file.size));
    TRY_EXR(exr_start_read(&exr, path, &init));
    TRY_EXR(exr_get_count(exr, &n));
    for (int part = 0; part < n; part++)
        TRY(read_part(exr, part, source));
    if (out) {
        json_array(out, "parts");
        for (int part = 0; part < n; part++)
            TRY(describe_part(exr, part, source, out));
        json_end_array(out);
    }
    if (!exr_hash_holds(file.bytes, file.size))
        st = fail(E_INPUT, "%s: damaged: its content does not match its hash", path);
done:
    if (exr)
        exr_finish(&exr);
    free(file.bytes);
    return st;
}

status exr_serve_check(const struct serve_question *question, struct serve_answer *answer)
{
    (void)answer;
    return read_file(question->path, NULL);
}

status exr_serve_describe(const struct serve_question *question, struct serve_answer *answer)
{
    struct text text;
    describe_begin(question, &text);
    status st = read_file(question->path, &text);
    if (st == OK)
        return describe_end(&text, answer);
    text_free(&text);
    return st;
}
