#include "text/ranges.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAME_MIN = -999999, FRAME_MAX = 9999999 };

static bool number(const char **p, int *out)
{
    const char *s = *p;
    bool minus = *s == '-';
    long value = 0;
    s += minus;
    if (!isdigit((unsigned char)*s))
        return false;
    for (; isdigit((unsigned char)*s); s++)
        if ((value = value * 10 + (*s - '0')) > FRAME_MAX)
            return false;
    *out = (int)(minus ? -value : value);
    *p = s;
    return *out >= FRAME_MIN;
}

status range_parse(const char *text, struct frame_range *out)
{
    struct frame_range r = {0, 0, 1};
    const char *p = text;
    bool good = number(&p, &r.first);
    r.last = r.first;
    if (good && *p == '-') {
        p++;
        good = number(&p, &r.last);
        if (good && (*p == 'x' || *p == ':')) {
            p++;
            good = number(&p, &r.step) && r.step >= 1;
        }
    }
    if (!good || *p)
        return fail(E_USAGE,
                    "'%.40s' is not a frame range; write FIRST-LAST or FIRST-LASTxSTEP, such as 1001-1110x2",
                    text);
    if (r.last < r.first)
        return fail(E_USAGE, "the frame range '%.40s' ends before it begins", text);
    r.last -= (r.last - r.first) % r.step;
    *out = r;
    return OK;
}

const char *range_text(struct frame_range r, char out[48])
{
    if (r.first == r.last)
        snprintf(out, 48, "%d", r.first);
    else if (r.step == 1)
        snprintf(out, 48, "%d-%d", r.first, r.last);
    else
        snprintf(out, 48, "%d-%dx%d", r.first, r.last, r.step);
    return out;
}

size_t range_count(struct frame_range r)
{
    return (size_t)((r.last - r.first) / r.step) + 1;
}

bool range_holds(struct frame_range r, int frame)
{
    return frame >= r.first && frame <= r.last && (frame - r.first) % r.step == 0;
}
