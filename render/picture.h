/* Pictures of frames, rendered by POV-Ray. A picture appears complete under its name, or not at all.
 *
 * Reuse         The PNG file records its options (size, preset, camera, colours, slate) as text. A picture is made again only if its
 *               options differ, if it does not match its record (output/product.h), or if its frame has changed.
 * Concurrency   Any number of processes may make different pictures in the same folder; temporary files have unique names.
 */
#ifndef HOODOO_PICTURE_H
#define HOODOO_PICTURE_H

#include <stdbool.h>

#include "base/path.h"
#include "job/job.h"
#include "output/product.h"
#include "render/povray.h"
#include "system/child.h"
#include "system/progress.h"
#include "text/ranges.h"

/* The Debian packages of the programs that this and turntable.h run. */
#define PICTURE_PACKAGES "povray, ffmpeg and openimageio-tools"

enum { PREVIEW_OPTIONS = 16 };

/* What to make. */
struct preview {
    const char *root;
    const struct job *job;
    struct children children;
    struct progress *progress; /* updated when a picture is begun */
    enum preset preset;
    int width, height;  /* px; 0: those of the preset */
    const char *camera; /* a camera of the job; NULL: its first, or an orbit view if it has none */
    bool keep_scenes;
    bool no_slate;
    bool figure; /* a person stands in the scene */
    /* The command-line arguments that determine the pictures, and --frames for the sheet (NULL: all frames). */
    const char *option[PREVIEW_OPTIONS];
    size_t n_options;
    const char *sheet_frames;
    enum value_id show;        /* VALUE_NONE: the rock as it looks */
    struct show_range range;   /* of the shown value */
    struct picture *under_way; /* list of pictures in progress */
};

/* The command that makes one part: `preview --only=PART` with the options of the preview. The struct points into itself, so it must
 * not be copied. */
struct preview_recipe {
    struct recipe recipe;
    const char *word[PREVIEW_OPTIONS + 3];
};
/* For one frame or ALL_FRAMES. `only` is the argument --only=PART, `more` a further argument or NULL. E_MEMORY. */
MUST_USE status preview_recipe(const struct preview *p, const char *only, const char *more, int frame,
                               struct preview_recipe *out);

/* Starts preview/NAME.FRAME.png, or NAME.stress.FRAME.png; children_wait() waits for it. Does nothing if the picture exists with the
 * same options. */
MUST_USE status picture_still(struct preview *p, int frame);

/* Makes the views in `which` of a full orbit of `views` pictures, turntable/NAME.FRAME.000.png and so on, and waits for them. */
MUST_USE status picture_orbit(struct preview *p, int frame, int views, struct frame_range which);

/* Removes the temporary files of unfinished pictures. Call after children_end(). */
void pictures_end(struct preview *p);

/* The common range of the shown value on the surfaces of n frames, without outliers (show_data_range()). */
MUST_USE status picture_data_range(const struct preview *p, const int *frames, size_t n,
                                   struct show_range *out);

/* The years since the first frame: as the frame's manifest says, or the job if there is none. */
double picture_years(const struct preview *p, int frame);

/* Paths of a still and of a view, relative to root. E_OUTPUT: too long. */
MUST_USE status picture_still_path(const struct preview *p, int frame, struct path *out);
MUST_USE status picture_view_path(const struct preview *p, int frame, int view, struct path *out);

/* The part of file names after the job's name (folder_name()): the shown value, or NULL. */
const char *picture_part(const struct preview *p);

/* Does the picture at root/`path` have a strip with name, frame and age? */
bool picture_has_slate(const struct preview *p, const char *path);

#endif
