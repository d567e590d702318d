#include "base/path.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

status path_format(struct path *out, const char *format, ...)
{
    struct path made; /* formatted here first, because an argument may be out->text */
    va_list args;
    va_start(args, format);
    const int n = vsnprintf(made.text, sizeof made.text, format, args);
    va_end(args);
    out->text[0] = '\0';
    if (n < 0)
        return fail(E_OUTPUT, "a path cannot be formatted");
    if (n >= PATH_BYTES)
        return fail(E_OUTPUT, "%.100s...: the path is %d bytes long; the limit is %d", made.text, n,
                    PATH_BYTES - 1);
    memcpy(out->text, made.text, (size_t)n + 1);
    return OK;
}

status path_join(struct path *out, const char *folder, const char *below)
{
    return path_format(out, "%s/%s", folder, below);
}

status path_folder(struct path *out, const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash)
        return path_format(out, ".");
    return path_format(out, "%.*s", slash == path ? 1 : (int)(slash - path), path);
}

status path_wedge(struct path *out, const char *root, int wedge)
{
    char number[FRAME_TEXT];
    return wedge ? path_join(out, root, wedge_text(wedge, number)) : path_format(out, "%s", root);
}

const char *path_last(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *frame_text(int frame, char out[FRAME_TEXT])
{
    snprintf(out, FRAME_TEXT, "%s%04u", frame < 0 ? "-" : "",
             frame < 0 ? 0U - (unsigned)frame : (unsigned)frame);
    return out;
}

bool frame_parse(const char *text, size_t n, int *frame)
{
    char number[FRAME_TEXT], again[FRAME_TEXT];
    if (n >= sizeof number)
        return false;
    memcpy(number, text, n);
    number[n] = '\0';
    const long value = strtol(number, NULL, 10);
    if (value < -99999999 || value > 99999999 || strcmp(frame_text((int)value, again), number) != 0)
        return false;
    *frame = (int)value;
    return true;
}

const char *wedge_text(int wedge, char out[FRAME_TEXT])
{
    snprintf(out, FRAME_TEXT, "w%04d", wedge);
    return out;
}
