/* What is burnt into a picture: a strip that says what it is, and the legend of its colours. */
#ifndef HOODOO_SLATE_H
#define HOODOO_SLATE_H

#include "base/status.h"
#include "field/camera.h"
#include "render/show.h"

/* Lower pictures have no room for words: they stay as they are. */
enum { SLATE_LEAST_HEIGHT = 120 };

struct slate {
    int width, height;
    char left[200], right[160]; /* the strip's; both "": no strip */
    double px_per_m;            /* where the rock is; 0: no scale bar */
    enum value_id show;         /* VALUE_NONE: no legend */
    struct show_range range;
    size_t n_marks; /* values that the legend names */
    double mark[2];
    const char *mark_name;
};

/* The words of a command. Their texts live in it. */
enum { SLATE_WORDS = 128 };
struct slate_command {
    const char *argv[SLATE_WORDS];
    size_t n, n_own;
    char own[SLATE_WORDS][200];
};

/* The scale bar: the longest of 1, 2 or 5 times a power of ten metres that is no longer than a sixth of the picture; its text is "20 m" or
 * "5 cm". */
double slate_bar_m(const struct slate *s, char text[24]);

/* Is there anything to draw? */
bool slate_draws(const struct slate *s);

/* The colour bar as a picture file (PPM): one of oiiotool's inputs. */
MUST_USE status slate_write_bar(const struct slate *s, const char *path);

/* oiiotool's words that draw what there is to draw on the picture `from`, a PPM in sRGB, and write the PNG `to`; `bar` is what
 * slate_write_bar() wrote. */
void slate_command(const struct slate *s, const char *from, const char *bar, const char *to,
                   struct slate_command *out);

/* Fills in all but its size: the legend of what is shown, with the job's thresholds of interlocking where that is stress; and with `right`
 * (NULL: neither strip nor scale) what the strip says at its ends, and the scale in the middle of the domain. */
void slate_describe(const struct job *job, int frame, const struct camera *camera, enum value_id show,
                    struct show_range range, const char *right, struct slate *out);

/* "frame 1061   55.2 kyr"; days where it is less than a year, seconds of a shot in real time, no time of terrain. */
void slate_when(const struct job *job, int frame, char out[96]);

#endif
