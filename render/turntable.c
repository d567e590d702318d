#include "render/turntable.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/memory.h"
#include "output/folder.h"
#include "render/png.h"
#include "render/slate.h"
#include "system/atomic_file.h"

static const char FONT[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

/* A file below root, which is moved into place when the program that makes it has finished. */
struct sheet {
    const struct recipe *recipe;
    struct path temporary, path;
};

static status video_done(void *user)
{
    struct sheet *sheet = user;
    return product_adopt(sheet->recipe, sheet->temporary.text, sheet->path.text);
}

/* Remove the metadata of oiiotool: the date, and a command line with names of temporary files. */
static status sheet_done(void *user)
{
    enum { LARGEST = 1 << 30 };
    struct sheet *sheet = user;
    status st = OK;
    struct path from;
    void *bytes = NULL, *plain = NULL;
    size_t n = 0;
    TRY(path_join(&from, sheet->recipe->root, sheet->temporary.text));
    TRY(file_read(from.text, LARGEST, &bytes, &n));
    st = png_with_tag(bytes, n, "contact sheet", &plain, &n);
    if (st == E_INPUT) /* a file of our own, so not E_INPUT */
        st = fail(E_OUTPUT, "%s: the sheet is cut short; is the disk full?", from.text);
    TRY(st);
    TRY(product_write(sheet->recipe, sheet->path.text, plain, n));
    unlink(from.text);
done:
    free(bytes);
    free(plain);
    return st;
}

status turntable_video(struct preview *p, int frame, int views)
{
    status st = OK;
    struct path path, pattern;
    char filter[200], rate[32], count[16];
    struct preview_recipe made;
    struct sheet sheet = {.recipe = &made.recipe};
    TRY(preview_recipe(p, "--only=video", NULL, frame, &made));
    for (int view = 0; view < views; view++) {
        TRY(picture_view_path(p, frame, view, &path));
        TRY(path_join(&path, p->root, path.text));
        if (access(path.text, R_OK) != 0) {
            st = fail(E_INPUT, "%s: the view is not there; make it first", path.text);
            goto done;
        }
    }
    TRY(folder_name(&sheet.path, p->job->name, FILE_VIDEO, 0, picture_part(p)));
    TRY(atomic_file_temporary(sheet.path.text, "", &sheet.temporary));
    TRY(folder_views(&pattern, p->job->name, picture_part(p), frame));
    /* A full turn in this time, at 24 frames per second. */
    snprintf(filter, sizeof filter,
             "fps=24,scale=trunc(iw/2)*2:trunc(ih/2)*2:in_color_matrix=bt709:out_color_matrix=bt709");
    snprintf(rate, sizeof rate, "%d/%d", views, TURNTABLE_SECONDS);
    snprintf(count, sizeof count, "%d", 24 * TURNTABLE_SECONDS);
    const char *const argv[] = {
        "ffmpeg",    "-nostdin",      "-y",        "-loglevel",   "warning",    "-framerate",
        rate,        "-start_number", "0",         "-i",          pattern.text, "-frames:v",
        count,       "-vf",           filter,      "-c:v",        "libx264",    "-threads",
        "2",         "-preset",       "medium",    "-crf",        "18",         "-pix_fmt",
        "yuv420p",   "-color_range",  "tv",        "-colorspace", "bt709",      "-color_primaries",
        "bt709",     "-color_trc",    "bt709",     "-movflags",   "+faststart", "-fflags",
        "+bitexact", "-flags:v",      "+bitexact", "-f",          "mp4",        sheet.temporary.text,
        NULL};
    TRY(children_run(&p->children, argv, "the turntable's video", video_done, &sheet));
    TRY(children_wait(&p->children));
done:
    return st;
}

struct tile {
    struct path picture; /* relative to root */
    char label[96];      /* "": none */
};

/* A mosaic of pictures, some with a line of text. oiiotool takes pictures and operations on them in order:
 * IN --text ... IN --text ... --mosaic. */
static status mosaic(struct preview *p, struct recipe *recipe, const struct path *path,
                     const struct tile *tile, size_t n)
{
    enum { EACH = 4 };
    status st = OK;
    struct sheet sheet = {.recipe = recipe};
    struct shown_product *shows = NULL;
    struct path picture;
    uint64_t size;
    const char **argv = NULL;
    char shape[48], text_option[256];
    size_t k = 0, columns = (size_t)ceil(sqrt((double)n));
    TRY(memory_alloc(EACH * n + 8, sizeof *argv, "the contact sheet", &argv));
    TRY(memory_alloc(n, sizeof *shows, "the contact sheet", &shows));
    for (size_t i = 0; i < n; i++) {
        shows[i].path = tile[i].picture.text;
        TRY(path_join(&picture, p->root, shows[i].path));
        TRY(hash_file(picture.text, &shows[i].hash, &size));
    }
    recipe->shows = shows;
    recipe->n_shows = n;
    sheet.path = *path;
    TRY(atomic_file_temporary(path->text, "", &sheet.temporary));
    snprintf(text_option, sizeof text_option, "--text:x=10:y=26:size=18:color=1,1,1,1:shadow=2:font=%s",
             FONT);
    argv[k++] = "oiiotool";
    for (size_t i = 0; i < n; i++) {
        argv[k++] = tile[i].picture.text;
        if (!*tile[i].label)
            continue;
        argv[k++] = text_option;
        argv[k++] = tile[i].label;
    }
    snprintf(shape, sizeof shape, "%zux%zu", columns, (n + columns - 1) / columns);
    argv[k++] = "--mosaic:pad=4";
    argv[k++] = shape;
    argv[k++] = "-o:fileformatname=png";
    argv[k++] = sheet.temporary.text;
    TRY(children_run(&p->children, argv, "the contact sheet", sheet_done, &sheet));
    TRY(children_wait(&p->children));
done:
    recipe->shows = NULL;
    recipe->n_shows = 0;
    free(shows);
    free(argv);
    return st;
}

status turntable_contact(struct preview *p, const int *frames, size_t n, int views)
{
    status st = OK;
    struct tile *tile = NULL;
    struct path path;
    struct preview_recipe made;
    size_t n_pictures = views ? ((size_t)views + 2) / 3 : n;
    if (n_pictures == 0)
        return OK;
    TRY(memory_alloc(n_pictures, sizeof *tile, "the contact sheet", &tile));
    for (size_t i = 0; i < n_pictures; i++) {
        int frame = views ? frames[n - 1] : frames[i];
        TRY(views ? picture_view_path(p, frame, (int)(3 * i), &tile[i].picture)
                  : picture_still_path(p, frame, &tile[i].picture));
        if (!picture_has_slate(p, tile[i].picture.text))
            slate_when(p->job, frame, picture_years(p, frame), tile[i].label);
    }
    TRY(folder_name(&path, p->job->name, FILE_SHEET, 0, picture_part(p)));
    /* The sheet of views belongs to the video, and is made only if there is no other. */
    TRY(views ? preview_recipe(p, "--only=video", NULL, frames[n - 1], &made)
              : preview_recipe(p, "--only=sheet", p->sheet_frames, ALL_FRAMES, &made));
    TRY(mosaic(p, &made.recipe, &path, tile, n_pictures));
done:
    free(tile);
    return st;
}

/* oiiotool evaluates braces and interprets backslashes in text, so both are replaced. A label is cut at the end of a UTF-8
 * character. */
static void plain_label(const struct job *job, char out[96])
{
    char number[FRAME_TEXT];
    int n = snprintf(out, 96, "%s  ", wedge_text((int)job->wedge.index, number));
    for (const char *s = job->wedge.label; *s; s++) {
        if (n > 70 && (*s & 0xc0) != 0x80)
            break;
        if (n == 95)
            break;
        out[n++] = *s == '{' ? '(' : *s == '}' ? ')' : *s == '\\' ? '/' : (unsigned char)*s < 0x20 ? ' ' : *s;
    }
    out[n] = '\0';
}

status turntable_wedges(struct preview *p, const struct job *const *wedge, size_t n)
{
    status st = OK;
    struct tile *tile = NULL;
    struct path path;
    struct preview_recipe made;
    size_t k = 0;
    TRY(memory_alloc(n, sizeof *tile, "the contact sheet", &tile));
    for (size_t i = 0; i < n; i++) {
        const struct job *job = wedge[i];
        char number[FRAME_TEXT];
        TRY(folder_path(&tile[k].picture, wedge_text((int)job->wedge.index, number), job->name, FILE_STILL,
                        job->frames.last, NULL));
        plain_label(job, tile[k].label);
        TRY(path_join(&path, p->root, tile[k].picture.text));
        k += access(path.text, R_OK) == 0;
    }
    if (k == 0) {
        st = fail(E_INPUT, "%s holds no still of any wedge's last frame; make those first", p->root);
        goto done;
    }
    TRY(folder_name(&path, p->job->name, FILE_WEDGES, 0, NULL));
    TRY(preview_recipe(p, "--only=wedges", NULL, ALL_FRAMES, &made));
    TRY(mosaic(p, &made.recipe, &path, tile, k));
done:
    free(tile);
    return st;
}
