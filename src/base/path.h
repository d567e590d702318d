/* Paths, and numbers in file names.
 *
 * Ownership          A path is a plain value of 4,096 bytes including its NUL, the longest that Linux opens; nothing
 *                    needs to be freed. All paths are composed here, so that a path that does not fit is an error and
 *                    is never truncated, which would name another file.
 * Numbers in names   A frame number has at least four digits and a sign if negative ("1001", "0007", "-0012"); a wedge
 *                    is "w0001".
 * Errors             E_OUTPUT, with the path's length and the limit; *out is then "".
 */
#ifndef HOODOO_PATH_H
#define HOODOO_PATH_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum {
    PATH_BYTES = 4096, /* PATH_MAX of Linux, including the NUL */
    FRAME_TEXT = 16,   /* buffer size for the number of a frame or a wedge as text */
    WEDGE_MAX = 9999
};

struct path {
    char text[PATH_BYTES];
};

/* Formats a path like printf. The arguments may point into *out. */
MUST_USE status path_format(struct path *out, const char *format, ...) PRINTF_LIKE(2, 3);

/* folder/below. `below` may itself contain folders, and `folder` may point into *out. */
MUST_USE status path_join(struct path *out, const char *folder, const char *below);

/* The folder part of `path`: "." if it has none, "/" for files in the root folder. */
MUST_USE status path_folder(struct path *out, const char *path);

/* The folder of a wedge's frames: root/w0001, or `root` itself for wedge 0. */
MUST_USE status path_wedge(struct path *out, const char *root, int wedge);

/* The part of `path` after the last '/'. */
const char *path_last(const char *path);

/* "1001", "0007", "-0012" in `out`; returns out. */
const char *frame_text(int frame, char out[FRAME_TEXT]);

/* Parses the first `n` bytes of `text` as written by frame_text(). Any other form is refused: "12", "-012", "+0012", "-0000". */
bool frame_parse(const char *text, size_t n, int *frame);

/* "w0001" in `out`; returns out. */
const char *wedge_text(int wedge, char out[FRAME_TEXT]);

#endif
