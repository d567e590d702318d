/* Pictures of frames, through POV-Ray: each whole under its name, or absent.
 *
 * Done once     A picture holds what was asked for (size, care, camera, colours, slate) as text in the file. It is made again
 *               when that differs, when it is not what its record says (output/product.h) or was made of another frame than
 *               is there, and else left as it is.
 * Side by side  Any number of processes may make different pictures of one folder: what is not finished has
 *               names of its own.
 */
#ifndef HOODOO_PICTURE_H
#define HOODOO_PICTURE_H

#include <stdbool.h>

#include "base/child.h"
#include "base/path.h"
#include "base/progress.h"
#include "base/ranges.h"
#include "job/job.h"
#include "output/product.h"
#include "render/povray.h"

/* Where what this and the turntable run comes from. */
#define PICTURE_PACKAGES "povray, ffmpeg and openimageio-tools"

enum { PREVIEW_OPTIONS = 16 };

/* What is asked for. */
struct preview {
    const char *root;
    const struct job *job;
    struct children children;
    struct progress *progress; /* told of every picture that is begun */
    enum preset preset;
    int width, height;  /* 0: the preset's */
    const char *camera; /* of the job, or NULL: its first, or an orbit if it has none */
    bool keep_scenes;
    bool no_slate;
    bool figure; /* a person stands in the scene */
    /* The options that decide what is made, as words of the command, and --frames of the sheet (NULL: all). */
    const char *option[PREVIEW_OPTIONS];
    size_t n_options;
    const char *sheet_frames;
    enum value_id show;        /* VALUE_NONE: the rock as it looks */
    struct show_range range;   /* of what is shown */
    struct picture *under_way; /* pictures that are being made */
};

/* How a part of it is made: `preview --only=PART` with these options. `more` is one more word, or NULL. The recipe points into
 * itself. */
struct preview_recipe {
    struct recipe recipe;
    const char *word[PREVIEW_OPTIONS + 3];
};
/* Of a frame, or of ALL_FRAMES. E_MEMORY. */
MUST_USE status preview_recipe(const struct preview *p, const char *only, const char *more, int frame,
                               struct preview_recipe *out);

/* preview/NAME.FRAME.png, or NAME.stress.FRAME.png. Starts it (children_wait() ends it), or skips it if it is
 * there as asked for. */
MUST_USE status picture_still(struct preview *p, int frame);

/* turntable/NAME.FRAME.000.png and so on: those of `views` of a full orbit that `which` holds. Waits. */
MUST_USE status picture_orbit(struct preview *p, int frame, int views, struct frame_range which);

/* Removes what pictures that did not come about have left. After children_end(). */
void pictures_end(struct preview *p);

/* The range of what p->show shows on these frames' surfaces together. */
MUST_USE status picture_data_range(const struct preview *p, const int *frames, size_t n,
                                   struct show_range *out);

/* Their paths, relative to root. E_OUTPUT if they are too long. */
MUST_USE status picture_still_path(const struct preview *p, int frame, struct path *out);
MUST_USE status picture_view_path(const struct preview *p, int frame, int view, struct path *out);

/* What the names of files have after the job's (folder_name()): the value that is shown, or NULL. */
const char *picture_part(const struct preview *p);

/* Does the picture at root/`path` say itself what it shows? */
bool picture_has_slate(const struct preview *p, const char *path);

#endif
