#include <errno.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

#include "image/formats/whole.h"
#include "image/hints.h"

struct manager {
    struct jpeg_error_mgr standard; /* first: libjpeg knows only this */
    jmp_buf back;
    struct whole *out;
};

static void on_error(j_common_ptr jpeg)
{
    struct manager *m = (struct manager *)jpeg->err;
    char text[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, text);
    snprintf(m->out->error, sizeof m->out->error, "%s", text);
    longjmp(m->back, 1);
}

/* libjpeg fills in grey for what is missing, and warns. */
static void on_message(j_common_ptr jpeg, int level)
{
    if (level < 0)
        on_error(jpeg);
}

static bool read_head(struct jpeg_decompress_struct *jpeg, struct whole *out)
{
    jpeg_save_markers(jpeg, JPEG_APP0 + 1, 0xffff);
    jpeg_read_header(jpeg, TRUE);
    if (jpeg->num_components == 4) {
        snprintf(out->error, sizeof out->error,
                 "its colours are inks (CMYK); convert it to grey or to red, green and blue");
        return false;
    }
    for (jpeg_saved_marker_ptr m = jpeg->marker_list; m; m = m->next)
        if (m->data_length > 6 && memcmp(m->data, "Exif\0\0", 6) == 0)
            out->orientation = image_exif_orientation(m->data + 6, m->data_length - 6);
    out->width = (int)jpeg->image_width;
    out->height = (int)jpeg->image_height;
    out->channels = jpeg->num_components;
    out->bytes = 1;
    return true;
}

static bool read_data(struct jpeg_decompress_struct *jpeg, struct whole *out)
{
    const size_t row = (size_t)out->width * (size_t)out->channels, n = (size_t)out->height;
    out->data = malloc(row * n);
    if (!out->data)
        return false;
    jpeg_start_decompress(jpeg);
    while (jpeg->output_scanline < jpeg->output_height) {
        JSAMPROW to = out->data + jpeg->output_scanline * row;
        jpeg_read_scanlines(jpeg, &to, 1);
    }
    jpeg_finish_decompress(jpeg);
    return true;
}

bool whole_jpeg(const char *path, bool with_data, struct whole *out)
{
    struct jpeg_decompress_struct jpeg = {0};
    struct manager m = {.out = out};
    volatile bool good = false; /* survives longjmp() */
    *out = (struct whole){0};
    FILE *f = fopen(path, "rb");
    if (!f) {
        snprintf(out->error, sizeof out->error, "%s", strerror(errno));
        return false;
    }
    jpeg.err = jpeg_std_error(&m.standard);
    m.standard.error_exit = on_error;
    m.standard.emit_message = on_message;
    snprintf(out->error, sizeof out->error, "out of memory");
    if (setjmp(m.back) == 0) {
        jpeg_create_decompress(&jpeg);
        jpeg_stdio_src(&jpeg, f);
        good = read_head(&jpeg, out) && (!with_data || read_data(&jpeg, out));
    }
    jpeg_destroy_decompress(&jpeg);
    fclose(f);
    if (!good) {
        free(out->data);
        out->data = NULL;
    }
    return good;
}
