/* The slate: a strip with name, frame and age, a scale bar, and the legend of colours, drawn into pictures. */
#ifndef HOODOO_SLATE_H
#define HOODOO_SLATE_H

#include "base/status.h"
#include "field/camera.h"
#include "render/show.h"

/* px: lower pictures are too small for text and get no slate. */
enum { SLATE_LEAST_HEIGHT = 120 };

struct slate {
    int width, height;
    char left[200], right[160]; /* texts of the strip; both "": no strip */
    double px_per_m;            /* at the distance of the rock; 0: no scale bar */
    enum value_id show;         /* VALUE_NONE: no legend */
    struct show_range range;
    size_t n_marks; /* marked values in the legend */
    double mark[2];
    const char *mark_name;
};

/* The arguments of a command; `own` stores their texts. */
enum { SLATE_WORDS = 128 };
struct slate_command {
    const char *argv[SLATE_WORDS];
    size_t n, n_own;
    char own[SLATE_WORDS][200];
};

/* The length of the scale bar (m): the largest 1, 2 or 5 times a power of ten that takes at most a sixth of the picture's width. *text is
 * "20 m" or "5 cm". */
double slate_bar_m(const struct slate *s, char text[24]);

/* Is there anything to draw? */
bool slate_draws(const struct slate *s);

/* Writes the colour bar as a picture (PPM), an input of oiiotool. */
MUST_USE status slate_write_bar(const struct slate *s, const char *path);

/* The oiiotool command that draws the slate on the picture `from` (a PPM in sRGB) and writes the PNG `to`. `bar` is the file of
 * slate_write_bar(). */
void slate_command(const struct slate *s, const char *from, const char *bar, const char *to,
                   struct slate_command *out);

/* Fills in everything but the size: the legend of the shown value, with the job's interlocking stresses as marks if it is stress; the texts of
 * the strip, with `right` at its right end (NULL: neither strip nor scale bar); and the scale in the middle of the domain. */
void slate_describe(const struct job *job, int frame, double years, const struct camera *camera,
                    enum value_id show, struct show_range range, const char *right, struct slate *out);

/* "frame 1061   55.2 kyr"; in days below a year, in seconds for shots in real time, without a time for model arches. `years`: those of the
 * frame's manifest, which in a branch count from the first frame of the run that it left. */
void slate_when(const struct job *job, int frame, double years, char out[96]);

#endif
