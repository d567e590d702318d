#include "image/image.h"

#include <inttypes.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/log.h"
#include "base/memory.h"
#include "image/convert.h"
#include "image/fill.h"
#include "image/protocol.h"
#include "reader/reader.h"
#include "text/text.h"

#define SAME_CHOICES(S)                                                                                      \
    _Static_assert(                                                                                          \
        (int)S##_NODATA_REFUSE == (int)IMAGE_REFUSE && (int)S##_NODATA_EMPTY == (int)IMAGE_EMPTY &&          \
            (int)S##_NODATA_FILL == (int)IMAGE_FILL && (int)S##_ALPHA_COVERAGE == (int)IMAGE_COVERAGE &&     \
            (int)S##_ALPHA_IGNORE == (int)IMAGE_IGNORE,                                                      \
        "the choices of PIXELS in job/keys.def and of image.h differ")
SAME_CHOICES(HEIGHTFIELD);
SAME_CHOICES(JOINTMAP);
SAME_CHOICES(IMAGE);
SAME_CHOICES(COVER);

/* ---- messages about files */

void image_log(bool warn, const char *file, const char *what)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static uint64_t logged[256];
    static size_t n;
    const uint64_t hash = hash_bytes(file, strlen(file)) ^ hash_bytes(what, strlen(what)) * 3;
    bool again = false;
    pthread_mutex_lock(&lock);
    for (size_t i = 0; i < n && i < 256; i++)
        again |= logged[i] == hash;
    if (!again)
        logged[n++ % 256] = hash;
    pthread_mutex_unlock(&lock);
    if (again)
        return;
    if (warn)
        log_warn("%s: %s", file, what);
    else
        log_info("%s: %s", file, what);
}

static void log_lines(const char *file, char *lines)
{
    for (char *line = lines, *end; line && *line; line = end) {
        end = strchr(line, '\n');
        if (end)
            *end++ = '\0';
        image_log(*line == 'w', file, line + 1);
    }
}

/* ---- pixels without a value */

static const char *why_missing(uint32_t why)
{
    switch ((enum image_missing_why)why) {
    case WHY_FILE:
        return "which the file declares as no data";
    case WHY_JOB:
        return "which is the job's nodata_value";
    case WHY_ALPHA:
        return "where alpha is 0";
    case WHY_MASK:
        return "which the file's mask excludes";
    case WHY_NOT_FINITE:
        break;
    }
    return "which is not a finite number";
}

static status refuse(const struct image_request *w, const struct image_answer *p)
{
    return fail(
        E_INPUT,
        "%s: pixel (%" PRIu64 ", %" PRIu64 ") from the top left is %.9g, %s; of %" PRIu64 " pixels %" PRIu64
        " have no value: set nodata: empty (nothing is there) or nodata: fill (from the pixels around them)%s",
        w->file, p->first_x, p->first_y, p->first_value, why_missing(p->why), p->width * p->height,
        p->n_missing, p->why == WHY_ALPHA ? ", or set alpha: ignore" : "");
}

static status handle_missing(const struct image_request *w, const struct image_answer *p, struct image *out)
{
    status st = OK;
    const size_t n = out->width * out->height;
    size_t missing = 0;
    char what[200];
    for (size_t i = 0; i < n; i++)
        missing += isfinite(out->value[i]) ? 0 : 1;
    if (missing == 0)
        return OK;
    if (w->nodata == IMAGE_REFUSE)
        return refuse(w, p);
    if (missing == n)
        return fail(E_INPUT, "%s: none of its %zu pixels has a value: see nodata_value, alpha and channel",
                    w->file, n);
    snprintf(what, sizeof what, "%zu of %zu pixels have no value and are %s", missing, n,
             w->nodata == IMAGE_FILL ? "filled from the pixels around them" : "left empty");
    image_log(false, w->file, what);
    if (w->nodata == IMAGE_EMPTY && w->height)
        TRY(memory_alloc(n, 1, "an image", &out->has));
    for (size_t i = 0; i < n; i++) {
        const bool has = isfinite(out->value[i]);
        if (out->has)
            out->has[i] = has;
        if (!has)
            out->value[i] = w->nodata == IMAGE_EMPTY && !w->height ? 0 : NAN;
    }
    TRY(image_fill(out->width, out->height, out->value));
done:
    return st;
}

/* ---- request and answer */

static const char *or_empty(const char *text)
{
    return text ? text : "";
}

static status ask(const struct image_request *w, const struct converted *c, struct reader_answer *answer)
{
    static const char *const values[] = {
        [IMAGE_UNIT] = "unit", [IMAGE_STORED] = "stored", [IMAGE_METRES] = "metres"};
    char scale[32], offset[32], width[32], height[32];
    snprintf(scale, sizeof scale, "%.17g", w->scale);
    snprintf(offset, sizeof offset, "%.17g", w->offset);
    snprintf(width, sizeof width, "%.0f", w->size_px ? w->size_px[0] : 0);
    snprintf(height, sizeof height, "%.0f", w->size_px ? w->size_px[1] : 0);
    const char *const word[ASK_COUNT + 1] = {
        [ASK_FORM] = c->form,
        [ASK_CHANNEL] = or_empty(w->channel),
        [ASK_PART] = or_empty(w->part),
        [ASK_NODATA_VALUE] = or_empty(w->nodata_value),
        [ASK_ALPHA] = w->alpha == IMAGE_COVERAGE ? "coverage" : "ignore",
        [ASK_OUTSIDE] = w->nodata == IMAGE_REFUSE ? "black" : "none",
        [ASK_USE] = w->height ? "height" : "mask",
        [ASK_VALUES] = values[w->values],
        [ASK_SCALE] = scale,
        [ASK_OFFSET] = offset,
        [ASK_WIDTH] = width,
        [ASK_HEIGHT] = height,
    };
    return reader_ask(&(struct reader_question){.program = "hoodoo-read-image",
                                                .kind = "image",
                                                .path = w->file,
                                                .argument = word,
                                                .input = c->bytes,
                                                .n_input = c->size},
                      answer);
}

status image_take(const struct image_request *w, struct reader_answer *answer, struct image *out)
{
    status st = OK;
    struct image_answer p;
    struct text lines = {0};
    *out = (struct image){0};
    TRY(reader_take(answer, &p, sizeof p));
    if (p.width < 1 || p.height < 1 || p.width > IMAGE_MAX_PIXELS / p.height || p.map > IMAGE_MAP_TURNED) {
        st = reader_bad_answer(answer);
        goto done;
    }
    TRY(reader_take_text(answer, &lines));
    TRY(reader_take_array(answer, (size_t)(p.width * p.height), sizeof *out->value, &out->value));
    out->width = (size_t)p.width;
    out->height = (size_t)p.height;
    out->map = (enum image_map)p.map;
    out->map_named = p.named != 0;
    for (int a = 0; a < 2; a++) {
        out->pixel[a] = p.pixel[a];
        out->corner[a] = p.corner[a];
        if (out->map == IMAGE_MAP_METRES && !(p.pixel[a] > 0 && p.pixel[a] < 1e9 && fabs(p.corner[a]) < 1e15))
            out->map = IMAGE_NO_MAP;
    }
    log_lines(w->file, lines.data);
    TRY(handle_missing(w, &p, out));
done:
    text_free(&lines);
    if (st != OK)
        image_free(out);
    return st;
}

status image_read(const struct image_request *w, struct image *out)
{
    status st = OK;
    struct reader_answer answer = {0};
    struct converted c = {0};
    *out = (struct image){0};
    TRY(image_convert(w->file, &c));
    TRY(ask(w, &c, &answer));
    TRY(image_take(w, &answer, out));
done:
    reader_end(&answer);
    converted_free(&c);
    return st;
}

void image_free(struct image *image)
{
    free(image->value);
    free(image->has);
    *image = (struct image){0};
}
