/* The pictures of the page: small copies in report/, so that the folder can be moved or mailed. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/cores.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/memory.h"
#include "render/report.h"
#include "system/atomic_file.h"

enum { CONTACT = 24 /* upper limit of thumbnails */, MAX_VIEWS = 72, LARGEST_VIDEO = 1 << 30 };

/* A conversion in progress. */
struct conversion {
    struct recipe recipe;
    struct path source, temporary, path; /* relative to root */
    bool *made;
};

struct recipe report_recipe(const char *root)
{
    static const char *const command[] = {"report"};
    return (struct recipe){.root = root, .word = command, .n_words = 1, .frame = ALL_FRAMES};
}

/* The recipe of a picture that is made from root/`source`. */
static status recipe_of(const struct report *r, const char *source, struct recipe *out)
{
    status st = OK;
    struct path full;
    uint64_t size;
    *out = report_recipe(r->root);
    TRY(path_join(&full, r->root, source));
    TRY(hash_file(full.text, &out->source, &size));
done:
    return st;
}

static status converted(void *user)
{
    struct conversion *c = user;
    const status st = product_adopt(&c->recipe, c->temporary.text, c->path.text);
    *c->made = st == OK;
    return st;
}

/* Pictures are optional: a failure becomes a note, and the report continues. */
static status forgive(struct report *r, status st)
{
    if (st != E_OUTPUT && st != E_INPUT)
        return st;
    report_note(r, "A picture is missing: %s", status_message());
    log_warn("%s", status_message());
    return OK;
}

/* Starts converting c->source to report/..., at most `width` px wide (0: unchanged). Sets *c->made on success. */
static status convert(struct report *r, struct children *children, struct conversion *c, int width)
{
    status st = OK;
    char resize[32];
    const char *argv[32];
    size_t k = 0;
    const char *ending = strrchr(path_last(c->source.text), '.');
    const bool linear = ending && strcmp(ending, ".exr") == 0;
    TRY(recipe_of(r, c->source.text, &c->recipe));
    TRY(product_done(&c->recipe, c->path.text, true, c->made));
    if (*c->made)
        return OK;
    TRY(atomic_file_temporary(c->path.text, "", &c->temporary));
    argv[k++] = "oiiotool";
    argv[k++] = "--threads";
    argv[k++] = "1";
    argv[k++] = c->source.text;
    if (linear) { /* an AOV picture: without a background */
        static const char *const steps[] = {
            "--subimage", "0",      "--ch",    "R,G,B,A", "--colorconvert",   "linear", "sRGB",
            "--dup",      "--mulc", "0,0,0,0", "--addc",  "0.85,0.83,0.79,1", "--over"};
        for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
            argv[k++] = steps[i];
    }
    argv[k++] = "--ch";
    argv[k++] = "R,G,B";
    if (width) {
        snprintf(resize, sizeof resize, "%dx0", width);
        argv[k++] = "--resize";
        argv[k++] = resize;
    }
    const char *const last[] = {
        "-d", "uint8", "--quality", "88", "--nosoftwareattrib", "-o:fileformatname=jpeg", c->temporary.text};
    for (size_t i = 0; i < sizeof last / sizeof *last; i++)
        argv[k++] = last[i];
    argv[k] = NULL;
    TRY(children_run(children, argv, c->source.text, converted, c));
done:
    return st;
}

/* Ends unfinished conversions if one has failed, and removes what they and failed ones have left; frees the n conversions. */
static void end_conversions(const struct report *r, struct children *children, status st,
                            struct conversion *c, size_t n)
{
    struct path full;
    if (st != OK)
        children_end(children);
    for (size_t i = 0; i < n; i++)
        if (*c[i].temporary.text && path_join(&full, r->root, c[i].temporary.text) == OK)
            unlink(full.text); /* no longer there if it was adopted */
    free(c);
}

static status wait_all(struct report *r, struct children *children)
{
    status st = OK;
    while (children->n > 0 && st == OK)
        st = forgive(r, children_wait(children));
    return st;
}

/* ---- the turntable */

/* Finds the frame of the newest orbit in turntable/. */
static status find_orbit(const struct report *r, int *frame, bool *found)
{
    int *frames = NULL;
    size_t n = 0;
    status st = folder_orbits(r->root, r->name, &frames, &n);
    *found = st == OK && n > 0;
    if (*found)
        *frame = frames[n - 1];
    free(frames);
    return st;
}

/* Copied, since a link would break when the folder is mailed. */
static status copy_video(struct report *r)
{
    status st = OK;
    struct path source, from;
    struct recipe recipe;
    bool there;
    void *bytes = NULL;
    size_t n = 0;
    TRY(folder_name(&source, r->name, FILE_VIDEO, 0, NULL));
    TRY(path_join(&from, r->root, source.text));
    if (access(from.text, R_OK) != 0)
        return OK;
    TRY(recipe_of(r, source.text, &recipe));
    TRY(product_done(&recipe, "report/turntable.mp4", true, &there));
    if (!there) {
        TRY(file_read(from.text, LARGEST_VIDEO, &bytes, &n));
        TRY(product_write(&recipe, "report/turntable.mp4", bytes, n));
    }
    r->video = true;
done:
    free(bytes);
    return forgive(r, st);
}

static status make_views(struct report *r, struct children *children)
{
    status st = OK;
    struct conversion *c = NULL;
    bool made[MAX_VIEWS] = {false}, found = false;
    struct path full;
    int n = 0;
    TRY(forgive(r, find_orbit(r, &r->turntable_frame, &found)));
    if (!found)
        return OK;
    TRY(memory_alloc(MAX_VIEWS, sizeof *c, "pictures", &c));
    /* A video needs one picture, which is shown until it plays. */
    for (; n < (r->video ? 1 : MAX_VIEWS); n++) {
        c[n].made = &made[n];
        TRY(folder_view(&c[n].source, r->name, NULL, r->turntable_frame, n));
        TRY(path_format(&c[n].path, "report/view.%03d.jpg", n));
        TRY(path_join(&full, r->root, c[n].source.text));
        if (access(full.text, R_OK) != 0)
            break;
        TRY(forgive(r, convert(r, children, &c[n], 0)));
    }
    TRY(wait_all(r, children));
    while (r->n_views < n && made[r->n_views])
        r->n_views++;
done:
    end_conversions(r, children, st, c, c ? MAX_VIEWS : 0);
    return st;
}

/* ---- stills */

static status make_stills(struct report *r, struct children *children)
{
    status st = OK;
    size_t n = 0, k = 0;
    struct report_frame **frame = NULL;
    struct conversion *c = NULL;
    TRY(memory_alloc(r->n_frames, sizeof *frame, "pictures", &frame));
    for (size_t i = 0; i < r->n_frames; i++)
        if (*r->frame[i].source.text)
            frame[n++] = &r->frame[i];
    TRY(memory_alloc(CONTACT + 2, sizeof *c, "pictures", &c));
    const size_t n_thumbs = n < CONTACT ? n : CONTACT;
    for (size_t i = 0; i < n_thumbs + 2 && n > 0; i++) {
        const bool thumb = i < n_thumbs;
        /* Evenly spaced thumbnails that include the first and the last frame; then these two at full size. */
        const size_t which = !thumb         ? (i == n_thumbs ? 0 : n - 1)
                             : n_thumbs > 1 ? i * (n - 1) / (n_thumbs - 1)
                                            : 0;
        struct report_frame *f = frame[which];
        if (!thumb && i > n_thumbs && n == 1)
            continue;
        c[k].made = thumb ? &f->thumb : &f->pictured;
        c[k].source = f->source;
        TRY(path_format(&c[k].path, "report/%s.%d.jpg", thumb ? "thumb" : "frame", f->manifest.frame));
        TRY(forgive(r, convert(r, children, &c[k++], thumb ? 320 : 0)));
    }
    TRY(wait_all(r, children));
done:
    end_conversions(r, children, st, c, k);
    free(frame);
    return st;
}

status report_pictures(struct report *r)
{
    status st = OK;
    struct children children;
    struct path path;
    TRY(path_join(&path, r->root, "log"));
    TRY(folder_make(path.text));
    children_begin(&children, r->root, "log/report.log", "ffmpeg and openimageio-tools", cores());
    st = copy_video(r);
    if (st == OK)
        st = make_views(r, &children);
    if (st == OK)
        st = make_stills(r, &children);
    children_end(&children);
done:
    return st;
}
