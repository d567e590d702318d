#include "render/turntable.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/memory.h"
#include "render/slate.h"

static const char FONT[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

/* A file under root, moved into place when its program has made it. */
struct sheet {
    const struct preview *preview;
    char temporary[512], path[512];
};

static status sheet_done(void *user)
{
    struct sheet *sheet = user;
    char from[4700], to[4700];
    snprintf(from, sizeof from, "%s/%s", sheet->preview->root, sheet->temporary);
    snprintf(to, sizeof to, "%s/%s", sheet->preview->root, sheet->path);
    int fd = access(from, R_OK) == 0 && rename(from, to) == 0;
    return fd ? OK : fail(E_OUTPUT, "%s could not be made", to);
}

status turntable_video(struct preview *p, int frame, int views)
{
    status st = OK;
    char name[256], path[512], pattern[512], filter[200], count[16];
    struct sheet sheet = {.preview = p};
    picture_name(p, name);
    for (int view = 0; view < views; view++) {
        char full[4700];
        picture_view_path(p, frame, view, path);
        snprintf(full, sizeof full, "%s/%s", p->root, path);
        if (access(full, R_OK) != 0) {
            st = fail(E_INPUT, "%s: the view is not there; make it first", full);
            goto done;
        }
    }
    snprintf(sheet.path, sizeof sheet.path, "%s.turntable.mp4", name);
    TRY(atomic_file_temporary(sheet.path, sheet.temporary, sizeof sheet.temporary - 4));
    strcat(sheet.temporary, ".mp4"); /* programs go by the ending */
    /* Names hold letters, digits, _ and - alone: no '%' but ours. */
    snprintf(pattern, sizeof pattern, "turntable/%s.%04d.%%03d.png", name, frame);
    /* Three turns: a video of one and a half seconds is over before one has looked. */
    snprintf(
        filter, sizeof filter,
        "loop=loop=2:size=%d,scale=trunc(iw/2)*2:trunc(ih/2)*2:in_color_matrix=bt709:out_color_matrix=bt709",
        views);
    snprintf(count, sizeof count, "%d", 3 * views);
    const char *const argv[] = {"ffmpeg",     "-nostdin",
                                "-y",         "-loglevel",
                                "warning",    "-framerate",
                                "24",         "-start_number",
                                "0",          "-i",
                                pattern,      "-frames:v",
                                count,        "-vf",
                                filter,       "-c:v",
                                "libx264",    "-threads",
                                "2",          "-preset",
                                "medium",     "-crf",
                                "18",         "-pix_fmt",
                                "yuv420p",    "-color_range",
                                "tv",         "-colorspace",
                                "bt709",      "-color_primaries",
                                "bt709",      "-color_trc",
                                "bt709",      "-movflags",
                                "+faststart", "-fflags",
                                "+bitexact",  "-flags:v",
                                "+bitexact",  sheet.temporary,
                                NULL};
    TRY(children_run(&p->children, argv, "the turntable's video", sheet_done, &sheet));
    TRY(children_wait(&p->children));
done:
    return st;
}

/* Pictures side by side, a line of text on each that has one. oiiotool takes its pictures and what is done to
 * each in order: IN --text ... IN --text ... --mosaic. */
static status mosaic(struct preview *p, const char *path, char (*word)[600], size_t n)
{
    enum { EACH = 4 };
    status st = OK;
    struct sheet sheet = {.preview = p};
    const char **argv = NULL;
    char shape[48], text_option[256];
    size_t k = 0, columns = (size_t)ceil(sqrt((double)n));
    TRY(memory_alloc(EACH * n + 8, sizeof *argv, "the contact sheet", &argv));
    snprintf(sheet.path, sizeof sheet.path, "%s", path);
    TRY(atomic_file_temporary(sheet.path, sheet.temporary, sizeof sheet.temporary - 4));
    strcat(sheet.temporary, ".png");
    snprintf(text_option, sizeof text_option, "--text:x=10:y=26:size=18:color=1,1,1,1:shadow=2:font=%s",
             FONT);
    argv[k++] = "oiiotool";
    for (size_t i = 0; i < n; i++) {
        argv[k++] = word[2 * i];
        if (!*word[2 * i + 1])
            continue;
        argv[k++] = text_option;
        argv[k++] = word[2 * i + 1];
    }
    snprintf(shape, sizeof shape, "%zux%zu", columns, (n + columns - 1) / columns);
    argv[k++] = "--mosaic:pad=4";
    argv[k++] = shape;
    argv[k++] = "-o";
    argv[k++] = sheet.temporary;
    TRY(children_run(&p->children, argv, "the contact sheet", sheet_done, &sheet));
    TRY(children_wait(&p->children));
done:
    free(argv);
    return st;
}

status turntable_contact(struct preview *p, const int *frames, size_t n, int views)
{
    status st = OK;
    char(*word)[600] = NULL, path[512], name[256];
    size_t n_pictures = views ? ((size_t)views + 2) / 3 : n;
    if (n_pictures == 0)
        return OK;
    TRY(memory_alloc(2 * n_pictures, sizeof *word, "the contact sheet", &word));
    for (size_t i = 0; i < n_pictures; i++) {
        int frame = views ? frames[n - 1] : frames[i];
        if (views)
            picture_view_path(p, frame, (int)(3 * i), word[2 * i]);
        else
            picture_still_path(p, frame, word[2 * i]);
        if (!picture_has_slate(p, word[2 * i]))
            slate_when(p->job, frame, word[2 * i + 1]);
    }
    picture_name(p, name);
    snprintf(path, sizeof path, "%s.contact.png", name);
    TRY(mosaic(p, path, word, n_pictures));
done:
    free(word);
    return st;
}

/* oiiotool evaluates what is in braces, and drawn text knows backslashes; a label is cut where a character
 * ends. */
static void plain_label(const struct job *job, char out[96])
{
    int n = snprintf(out, 96, "w%04d  ", (int)job->wedge.index);
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
    char(*word)[600] = NULL, path[512], full[4700];
    size_t k = 0;
    TRY(memory_alloc(2 * n, sizeof *word, "the contact sheet", &word));
    for (size_t i = 0; i < n; i++) {
        snprintf(word[2 * k], sizeof word[0], "w%04d/preview/%.200s.%04d.png", (int)wedge[i]->wedge.index,
                 wedge[i]->name, wedge[i]->frames.last);
        plain_label(wedge[i], word[2 * k + 1]);
        snprintf(full, sizeof full, "%s/%s", p->root, word[2 * k]);
        k += access(full, R_OK) == 0;
    }
    if (k == 0) {
        st = fail(E_INPUT, "%s holds no still of any wedge's last frame; make those first", p->root);
        goto done;
    }
    snprintf(path, sizeof path, "%.200s.wedges.png", p->job->name);
    TRY(mosaic(p, path, word, k));
done:
    free(word);
    return st;
}
