#include "render/png.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/text.h"

static char keyword[] = "hoodoo";

struct source {
    const png_byte *at;
    size_t left;
};

/* All resources, so that a failure anywhere can release them. */
struct copy {
    struct source from;
    struct text to;
    png_structp read, write;
    png_infop info;
    char message[200];
};

static void take(png_structp png, png_bytep to, size_t n)
{
    struct source *from = png_get_io_ptr(png);
    if (n > from->left)
        png_error(png, "it is cut short");
    memcpy(to, from->at, n);
    from->at += n;
    from->left -= n;
}

static void put(png_structp png, png_bytep from, size_t n)
{
    text_add_bytes(png_get_io_ptr(png), from, n);
}

static void flush(png_structp png)
{
    (void)png;
}

static _Noreturn void on_error(png_structp png, png_const_charp message)
{
    char *out = png_get_error_ptr(png);
    if (out)
        snprintf(out, sizeof((struct copy *)0)->message, "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static bool begin(struct copy *c)
{
    c->read = png_create_read_struct(PNG_LIBPNG_VER_STRING, c->message, on_error, on_warning);
    c->write = png_create_write_struct(PNG_LIBPNG_VER_STRING, c->message, on_error, on_warning);
    c->info = c->read ? png_create_info_struct(c->read) : NULL;
    return c->write && c->info;
}

/* Passes ownership of the written bytes to the caller on success. */
static status end(struct copy *c, status st, void **out, size_t *n_out)
{
    png_destroy_read_struct(&c->read, &c->info, NULL);
    png_destroy_write_struct(&c->write, NULL);
    if (st != OK)
        text_free(&c->to);
    *out = c->to.data;
    *n_out = c->to.size;
    return st;
}

/* False: it cannot be read, or there is no memory. Between setjmp() and longjmp() only *c changes. */
static bool read_picture(struct copy *c)
{
    if (setjmp(png_jmpbuf(c->read)))
        return false;
    png_set_read_fn(c->read, &c->from, take);
    png_read_png(c->read, c->info, PNG_TRANSFORM_IDENTITY, NULL);
    return true;
}

static bool write_picture(struct copy *c, png_textp text)
{
    if (setjmp(png_jmpbuf(c->write)))
        return false;
    png_free_data(c->read, c->info, PNG_FREE_TEXT, -1);
    png_set_invalid(c->read, c->info, PNG_INFO_tIME);
    png_set_text(c->write, c->info, text, 1);
    png_set_write_fn(c->write, &c->to, put, flush);
    png_write_png(c->write, c->info, PNG_TRANSFORM_IDENTITY, NULL);
    return true;
}

status png_with_tag(const void *bytes, size_t n, const char *tag, void **out, size_t *n_out)
{
    status st = OK;
    struct copy c = {.from = {bytes, n}};
    char shorter[PNG_TAG];
    snprintf(shorter, sizeof shorter, "%s", tag);
    png_text text = {.compression = PNG_TEXT_COMPRESSION_NONE,
                     .key = keyword,
                     .text = shorter,
                     .text_length = strlen(shorter)};
    if (!begin(&c))
        st = fail(E_MEMORY, "no memory for a picture");
    else if (!read_picture(&c) || !write_picture(&c, &text))
        st = fail(E_INPUT, "the picture is damaged: %s", c.message);
    else
        st = text_status(&c.to);
    return end(&c, st, out, n_out);
}

static bool write_rows(struct copy *c, const unsigned char *rgb, png_uint_32 width, png_uint_32 height)
{
    if (setjmp(png_jmpbuf(c->write)))
        return false;
    png_set_write_fn(c->write, &c->to, put, flush);
    png_set_IHDR(c->write, c->info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(c->write, c->info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(c->write, c->info);
    for (png_uint_32 y = 0; y < height; y++)
        png_write_row(c->write, rgb + (size_t)y * 3 * width);
    png_write_end(c->write, NULL);
    return true;
}

status png_encode(const unsigned char *rgb, int width, int height, void **out, size_t *n_out)
{
    status st = OK;
    struct copy c = {0};
    if (!begin(&c))
        st = fail(E_MEMORY, "no memory for a picture");
    else if (!write_rows(&c, rgb, (png_uint_32)width, (png_uint_32)height))
        st = fail(E_MEMORY, "a picture of %d x %d pixels cannot be made: %s", width, height, c.message);
    else
        st = text_status(&c.to);
    return end(&c, st, out, n_out);
}

static bool read_head(struct copy *c, FILE *file)
{
    if (setjmp(png_jmpbuf(c->read)))
        return false;
    png_init_io(c->read, file);
    png_read_info(c->read, c->info);
    return true;
}

void png_tag(const char *path, char out[PNG_TAG])
{
    struct copy c = {0};
    png_textp text = NULL;
    int n = 0;
    out[0] = '\0';
    FILE *file = fopen(path, "rb");
    if (!file)
        return;
    if (begin(&c) && read_head(&c, file))
        png_get_text(c.read, c.info, &text, &n);
    for (int i = 0; i < n; i++)
        if (strcmp(text[i].key, keyword) == 0)
            snprintf(out, PNG_TAG, "%s", text[i].text);
    png_destroy_read_struct(&c.read, &c.info, NULL);
    png_destroy_write_struct(&c.write, NULL);
    fclose(file);
}
