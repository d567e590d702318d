/* Paths, and the numbers in the names of files.
 *
 * What it is         A path is a value: 4,096 bytes with its NUL, which is the most that Linux opens. Nothing is to
 *                    be freed. Paths are made here alone, so that what does not fit is an error and never a
 *                    shorter path, which would name another file.
 * Numbers in names   A frame has its sign and at least four digits ("1001", "0007", "-0012"), a wedge "w0001".
 * Error handling     E_OUTPUT with the bytes wanted and the limit; *out is then "".
 */
#ifndef HOODOO_PATH_H
#define HOODOO_PATH_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum {
    PATH_BYTES = 4096, /* PATH_MAX of Linux, its NUL counted */
    FRAME_TEXT = 16,   /* bytes of a frame's or a wedge's number as text */
    WEDGE_MAX = 9999
};

struct path {
    char text[PATH_BYTES];
};

/* The path that printf would write. The arguments may point into *out. */
MUST_USE status path_format(struct path *out, const char *format, ...) PRINTF_LIKE(2, 3);

/* folder/below; `below` may hold folders too, and `folder` may point into *out. */
MUST_USE status path_join(struct path *out, const char *folder, const char *below);

/* The folder that `path` lies in: "." if it names none, "/" for what lies there. */
MUST_USE status path_folder(struct path *out, const char *path);

/* The folder of a wedge's frames: root/w0001, or `root` itself for wedge 0. */
MUST_USE status path_wedge(struct path *out, const char *root, int wedge);

/* What comes after the last '/' of `path`. */
const char *path_last(const char *path);

/* "1001", "0007", "-0012" in `out`; returns out. */
const char *frame_text(int frame, char out[FRAME_TEXT]);

/* Reads what frame_text() writes, and nothing else: not "12", "-012", "+0012" or "-0000". `n`: how many bytes
 * of `text` are the number. */
bool frame_parse(const char *text, size_t n, int *frame);

/* "w0001" in `out`; returns out. */
const char *wedge_text(int wedge, char out[FRAME_TEXT]);

#endif
