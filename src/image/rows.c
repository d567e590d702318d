#include "image/rows.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/image.h"

void image_note(struct image_decoding *m, bool warn, const char *format, ...)
{
    const size_t at = strlen(m->messages);
    va_list args;
    if (sizeof m->messages - at < 3)
        return;
    m->messages[at] = warn ? 'w' : 'i';
    va_start(args, format);
    vsnprintf(m->messages + at + 1, sizeof m->messages - at - 2, format, args);
    va_end(args);
    strcat(m->messages, "\n");
}

/* ---- the meaning of stored numbers */

static status set_nodata(struct image_decoding *m)
{
    const char *text = m->argument[ASK_NODATA_VALUE];
    char *end;
    if (*text) {
        m->nodata[m->n_nodata++] = strtod(text, &end);
        if (end == text || *end)
            return fail(E_USAGE, "%s: nodata_value: '%.40s' is not a number", m->path, text);
    }
    if (m->hints.has_nodata)
        m->nodata[m->n_nodata++] = m->hints.nodata;
    return OK;
}

static status set_values(struct image_decoding *m)
{
    struct image_answer *p = &m->answer;
    p->factor = strtod(m->argument[ASK_SCALE], NULL);
    p->offset = strtod(m->argument[ASK_OFFSET], NULL);
    if (image_argument_is(m, ASK_VALUES, "unit") && m->is_integer)
        p->factor /= m->white;
    if (image_argument_is(m, ASK_VALUES, "unit"))
        return OK;
    const bool metres = image_argument_is(m, ASK_VALUES, "metres");
    const double up = metres && m->hints.height_unit > 0 ? m->hints.height_unit : 1;
    if (m->hints.damaged_scale && metres)
        return fail(E_INPUT, "%s: the scale or offset in its metadata is not a number: set scale_m", m->path);
    if (m->hints.damaged_scale)
        image_note(m, true, "the scale or offset in its metadata is not a number and is ignored");
    if (m->hints.has_scale && !m->hints.damaged_scale) {
        image_note(m, false, "its metadata says that values are %.10g + %.10g times the stored numbers",
                   m->hints.offset, m->hints.scale);
        p->offset += p->factor * up * m->hints.offset;
        p->factor *= m->hints.scale;
    }
    if (up < 1)
        image_note(m, false, "its heights are in feet of %.10g m", up);
    p->factor *= up;
    return OK;
}

/* The map position of a file, if it has one, overrides its orientation. */
static void set_orientation(struct image_decoding *m)
{
    const struct image_hints *h = &m->hints;
    struct image_answer *p = &m->answer;
    int orientation = m->orientation >= 1 && m->orientation <= 8 ? m->orientation : 1;
    p->map = (uint32_t)h->map;
    p->named = h->has_system;
    if (h->map == IMAGE_MAP_METRES || h->map == IMAGE_MAP_DEGREES) {
        if (orientation != 1)
            image_note(m, true, "its orientation (%d) is ignored: its map position says which way is north",
                       orientation);
        orientation = h->pixel[0] < 0 ? (h->pixel[1] < 0 ? 3 : 2) : (h->pixel[1] < 0 ? 4 : 1);
        p->corner[0] = fmin(h->corner[0], h->corner[0] + h->pixel[0] * (double)m->width);
        p->corner[1] = fmin(h->corner[1], h->corner[1] - h->pixel[1] * (double)m->height);
        p->pixel[0] = fabs(h->pixel[0]);
        p->pixel[1] = fabs(h->pixel[1]);
    } else if (orientation != 1) {
        image_note(m, false, "it is rotated as its metadata says (orientation %d)", orientation);
    }
    /* Orientations 5 to 8 transpose: columns become rows. */
    static const int right[] = {0, 1, -1, -1, 1, 1, 1, -1, -1}, down[] = {0, 1, 1, -1, -1, 1, -1, -1, 1};
    const int64_t w = (int64_t)m->width, high = (int64_t)m->height;
    const int64_t step_x = orientation > 4 ? high : 1, step_y = orientation > 4 ? 1 : w;
    p->width = orientation > 4 ? m->height : m->width;
    p->height = orientation > 4 ? m->width : m->height;
    m->by_x = right[orientation] * step_x;
    m->by_y = down[orientation] * step_y;
    m->first =
        (right[orientation] < 0 ? (w - 1) * step_x : 0) + (down[orientation] < 0 ? (high - 1) * step_y : 0);
}

status image_begin(struct image_decoding *m)
{
    status st = OK;
    if (m->width < 1 || m->height < 1)
        return fail(E_INPUT, "%s: the image has no pixels", m->path);
    if (m->width > m->max_pixels / m->height)
        return fail(E_INPUT, "%s: %llu x %llu pixels are more than the limit of %llu million", m->path,
                    (unsigned long long)m->width, (unsigned long long)m->height,
                    (unsigned long long)m->max_pixels / 1000000);
    m->is_height = image_argument_is(m, ASK_USE, "height");
    m->uses_alpha = image_argument_is(m, ASK_ALPHA, "coverage");
    m->drops_outside = image_argument_is(m, ASK_OUTSIDE, "none");
    TRY(set_nodata(m));
    TRY(set_values(m));
    set_orientation(m);
    TRY(memory_alloc(m->width * m->height, sizeof *m->value, "an image", &m->value));
    m->answer.n_outside = m->width * m->height;
    m->answer.first_y = UINT64_MAX;
    const float outside =
        m->drops_outside && m->is_height ? NAN : (float)(m->is_height ? m->answer.offset : 0);
    for (uint64_t i = 0; i < m->width * m->height; i++)
        m->value[i] = outside;
done:
    return st;
}

/* GDAL_NODATA is text: floats are compared within its rounding, which is coarser for the largest numbers. */
static bool is_equal(const struct image_decoding *m, double stored, double nodata)
{
    const double rounding = fabs(nodata) > 1e30 ? 1e-4 : 4e-7;
    return stored == nodata || (!m->is_integer && fabs(stored - nodata) <= rounding * fabs(nodata));
}

static bool is_missing(const struct image_decoding *m, double stored, const double *alpha, const double *mask,
                       enum image_missing_why *why)
{
    *why = WHY_NOT_FINITE;
    if (!isfinite(stored))
        return true;
    for (unsigned i = 0; i < m->n_nodata; i++)
        if (is_equal(m, stored, m->nodata[i])) {
            *why = i == 0 && *m->argument[ASK_NODATA_VALUE] ? WHY_JOB : WHY_FILE;
            return true;
        }
    *why = WHY_MASK;
    if (mask && *mask == 0)
        return true;
    *why = WHY_ALPHA;
    return alpha && m->uses_alpha && m->is_height && *alpha == 0;
}

static void mark_missing(struct image_decoding *m, uint64_t to, double stored, enum image_missing_why why)
{
    struct image_answer *p = &m->answer;
    const uint64_t x = to % p->width, y = to / p->width;
    p->n_missing++;
    m->value[to] = NAN;
    if (y > p->first_y || (y == p->first_y && x > p->first_x))
        return;
    p->first_x = x;
    p->first_y = y;
    p->first_value = stored;
    p->why = why;
}

void image_row(struct image_decoding *m, int64_t x, int64_t y, size_t n, const double *stored,
               const double *alpha, const double *mask)
{
    y += m->top;
    if (y < 0 || y >= (int64_t)m->height)
        return;
    for (size_t i = 0; i < n; i++) {
        const int64_t column = x + m->left + (int64_t)i;
        enum image_missing_why why;
        if (column < 0 || column >= (int64_t)m->width)
            continue;
        const uint64_t to = (uint64_t)(m->first + column * m->by_x + y * m->by_y);
        double v = stored[i];
        m->answer.n_outside--;
        if (is_missing(m, v, alpha ? alpha + i : NULL, mask ? mask + i : NULL, &why)) {
            mark_missing(m, to, v, why);
            continue;
        }
        if (alpha && m->uses_alpha) {
            if (m->is_height && m->premultiplied)
                v /= alpha[i];
            else if (!m->is_height && !m->premultiplied)
                v *= alpha[i];
        }
        m->value[to] = (float)(m->answer.offset + m->answer.factor * v);
        if (!isfinite(m->value[to]))
            mark_missing(m, to, stored[i], WHY_NOT_FINITE);
    }
}
