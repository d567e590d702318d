/* Drawn by oiiotool in DejaVu Sans Mono, so that the width of a text is known. Names of jobs and cameras consist of letters,
 * digits, _ and -, so they contain no characters that are special to oiiotool. */
#include "render/slate.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "system/atomic_file.h"

static const char FONT[] = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf";
static const double LETTER = 0.602; /* in units of the font size */

static int font_size(const struct slate *s)
{
    return (int)fmin(fmax(round(s->height / 36.0), 9), 48);
}

/* ---- placement of the legend: a panel at the right edge, above the strip */

struct panel {
    int font, left, top, bottom;
    int bar_x, bar_y, bar_w, bar_h, text_x;
};

static struct panel panel_of(const struct slate *s)
{
    struct panel p = {.font = font_size(s)};
    int letters = 12; /* the bar and the text "interlock" next to it */
    p.bar_w = (int)lrint(1.1 * p.font);
    p.bar_h = (int)lrint(0.5 * s->height);
    p.left = s->width - (int)ceil((letters * LETTER + 1.2) * p.font);
    p.top = (int)lrint(0.08 * s->height);
    p.bar_x = p.left + (int)lrint(0.6 * p.font);
    p.bar_y = p.top + (int)lrint((*value_table[s->show].legend.above ? 4.5 : 3.4) * p.font);
    p.text_x = p.bar_x + p.bar_w + (int)lrint(0.6 * p.font);
    p.bottom = p.bar_y + p.bar_h + (int)lrint(2.0 * p.font);
    return p;
}

bool slate_draws(const struct slate *s)
{
    return s->height >= SLATE_LEAST_HEIGHT && (*s->left || *s->right || s->show != VALUE_NONE);
}

status slate_write_bar(const struct slate *s, const char *path)
{
    status st = OK;
    struct panel p = panel_of(s);
    unsigned char *bytes = NULL;
    char head[64];
    size_t n_head = (size_t)snprintf(head, sizeof head, "P6\n%d %d\n255\n", p.bar_w, p.bar_h);
    size_t n = n_head + 3 * (size_t)p.bar_w * (size_t)p.bar_h;
    TRY(memory_alloc(n, 1, "the legend", &bytes));
    memcpy(bytes, head, n_head);
    unsigned char *at = bytes + n_head;
    for (int y = 0; y < p.bar_h; y++)
        for (int x = 0; x < p.bar_w; x++, at += 3)
            show_color(s->show, s->range, 1 - (y + 0.5) / p.bar_h, at);
    TRY(atomic_file_write(path, bytes, n));
done:
    free(bytes);
    return st;
}

/* ---- arguments */

static void add_argument(struct slate_command *c, const char *text)
{
    if (c->n + 1 < SLATE_WORDS) {
        c->argv[c->n++] = text;
        c->argv[c->n] = NULL;
    }
}

static void add_formatted(struct slate_command *c, const char *format, ...) PRINTF_LIKE(2, 3);
static void add_formatted(struct slate_command *c, const char *format, ...)
{
    va_list args;
    if (c->n_own == SLATE_WORDS)
        return;
    va_start(args, format);
    vsnprintf(c->own[c->n_own], sizeof c->own[0], format, args);
    va_end(args);
    add_argument(c, c->own[c->n_own++]);
}

static void add_text(struct slate_command *c, int x, int baseline, int size, const char *text)
{
    add_formatted(c, "--text:x=%d:y=%d:size=%d:color=0.93,0.93,0.93,1:font=%s", x, baseline, size, FONT);
    add_formatted(c, "%s", text);
}

/* Both corners are inside the rectangle. */
static void add_box(struct slate_command *c, const char *color, int x0, int y0, int x1, int y1)
{
    add_formatted(c, "--box:color=%s:fill=1", color);
    add_formatted(c, "%d,%d,%d,%d", x0, y0, x1, y1);
}

static int row_of(const struct panel *p, double position)
{
    return p->bar_y + (int)lrint((1 - position) * (p->bar_h - 1));
}

static void add_marks(struct slate_command *c, const struct slate *s, const struct panel *p, int row[2],
                      size_t *n)
{
    *n = 0;
    for (size_t i = 0; i < s->n_marks; i++) {
        if (s->mark[i] <= s->range.low || s->mark[i] >= s->range.high)
            continue;
        int y = row_of(p, show_position(s->show, s->range, s->mark[i]));
        if (*n && abs(y - row[0]) < p->font)
            continue;
        add_box(c, "0,0,0,1", p->bar_x, y, p->bar_x + p->bar_w - 1, y + (p->font > 15));
        add_text(c, p->text_x, y + (int)lrint(0.36 * p->font), p->font, s->mark_name);
        row[(*n)++] = y;
    }
}

static void add_legend(struct slate_command *c, const struct slate *s)
{
    const struct value_legend *legend = &value_table[s->show].legend;
    struct panel p = panel_of(s);
    struct show_tick tick[SHOW_TICKS];
    char name[48], *under;
    int marked[2];
    size_t n_marked;
    snprintf(name, sizeof name, "%s", value_table[s->show].name);
    while ((under = strchr(name, '_')))
        *under = ' ';
    add_text(c, p.bar_x, p.top + (int)lrint(1.4 * p.font), p.font, name);
    if (*legend->unit)
        add_text(c, p.bar_x, p.top + (int)lrint(2.6 * p.font), p.font, legend->unit);
    if (*legend->above) {
        int small = (int)lrint(0.85 * p.font);
        add_text(c, p.bar_x, p.bar_y - (int)lrint(0.6 * p.font), small, legend->above);
        if (s->range.low < 0)
            add_text(c, p.bar_x, p.bar_y + p.bar_h + (int)lrint(1.3 * p.font), small, legend->below);
    }
    add_marks(c, s, &p, marked, &n_marked);
    size_t n = show_ticks(s->show, s->range, tick);
    for (size_t i = 0; i < n; i++) {
        int y = row_of(&p, tick[i].position);
        bool free = true;
        for (size_t k = 0; k < n_marked; k++)
            free = free && abs(y - marked[k]) > p.font;
        add_box(c, "0.93,0.93,0.93,1", p.bar_x + p.bar_w, y, p.bar_x + p.bar_w + p.font / 4, y);
        if (free)
            add_text(c, p.text_x, y + (int)lrint(0.36 * p.font), p.font, tick[i].text);
    }
}

static void add_strip(struct slate_command *c, const struct slate *s)
{
    int font = font_size(s), margin = (int)lrint(0.6 * font), high = (int)lrint(1.7 * font);
    int letters = (int)((s->width - 2 * margin) / (LETTER * font)), left = (int)strlen(s->left),
        right = (int)strlen(s->right), baseline = s->height - (int)lrint(0.5 * font);
    add_box(c, "0.05,0.05,0.055,0.62", 0, s->height - high, s->width - 1, s->height - 1);
    if (left <= letters) {
        add_text(c, margin, baseline, font, s->left);
    } else {
        /* The end of the text has the frame, so the name is shortened. */
        char cut[160];
        int keep = letters > 4 ? letters - 2 : 2;
        snprintf(cut, sizeof cut, "..%s", s->left + (left > keep ? left - keep : 0));
        add_text(c, margin, baseline, font, cut);
    }
    if (left + right + 3 <= letters)
        add_text(c, s->width - margin - (int)ceil(right * LETTER * font), baseline, font, s->right);
}

double slate_bar_m(const struct slate *s, char text[24])
{
    double most = s->width / 6.0 / s->px_per_m, unit = pow(10, floor(log10(most) + 1e-9)),
           length = unit * (most >= 5 * unit   ? 5
                            : most >= 2 * unit ? 2
                                               : 1);
    if (length >= 1000)
        snprintf(text, 24, "%g km", length / 1000);
    else if (length >= 0.9)
        snprintf(text, 24, "%.0f m", length);
    else if (length >= 0.009)
        snprintf(text, 24, "%.0f cm", 100 * length);
    else
        snprintf(text, 24, "%g mm", 1000 * length);
    return length;
}

/* Above the left end of the strip: a bar with feet, as long as its length in metres at the distance of the rock. */
static void add_scale(struct slate_command *c, const struct slate *s)
{
    char text[24];
    int font = font_size(s), margin = (int)lrint(0.6 * font), line = font > 15 ? 2 : 1,
        y = s->height - (int)lrint(2.5 * font);
    double length = slate_bar_m(s, text) * s->px_per_m;
    const int x[2] = {margin, margin + (int)lrint(length)};
    const char *white = "0.93,0.93,0.93,1", *dark = "0.05,0.05,0.055,0.62";
    add_box(c, dark, x[0] - line, y - line, x[1] + line, y + 2 * line - 1);
    add_box(c, white, x[0], y, x[1], y + line - 1);
    for (int end = 0; end < 2; end++)
        add_box(c, white, x[end], y - font / 3, x[end] + line - 1, y + line - 1);
    add_text(c, x[0] + font / 2, y - font / 3, font, text);
}

void slate_command(const struct slate *s, const char *from, const char *bar, const char *to,
                   struct slate_command *c)
{
    const bool draws = slate_draws(s), legend = draws && s->show != VALUE_NONE;
    c->n = c->n_own = 0;
    add_argument(c, "oiiotool");
    if (legend)
        add_argument(c, bar);
    add_argument(c, from);
    add_argument(c, "--iscolorspace"); /* a PPM file does not state its colour space */
    add_argument(c, "sRGB");
    if (legend) {
        struct panel p = panel_of(s);
        add_argument(c, "--paste");
        add_formatted(c, "+%d+%d", p.bar_x, p.bar_y);
        /* Four panels around the bar, so that the bar keeps its colours. */
        const char *dark = "0.05,0.05,0.055,0.62";
        add_box(c, dark, p.left, p.top, s->width - 1, p.bar_y - 1);
        add_box(c, dark, p.left, p.bar_y, p.bar_x - 1, p.bar_y + p.bar_h - 1);
        add_box(c, dark, p.bar_x + p.bar_w, p.bar_y, s->width - 1, p.bar_y + p.bar_h - 1);
        add_box(c, dark, p.left, p.bar_y + p.bar_h, s->width - 1, p.bottom);
        add_legend(c, s);
    }
    if (draws && (*s->left || *s->right))
        add_strip(c, s);
    if (draws && s->px_per_m > 0)
        add_scale(c, s);
    add_argument(c, "-o:fileformatname=png"); /* the file name has no suffix */
    add_argument(c, to);
}

void slate_when(const struct job *job, int frame, double years, char out[96])
{
    const double frames = frame - job->frames.first;
    if (job_model(job)->terrain) /* the time that tools take is undefined */
        snprintf(out, 96, "frame %d", frame);
    else if (job->clock.seconds_per_frame > 0)
        snprintf(out, 96, "frame %d   %.2f s", frame, frames * job->clock.seconds_per_frame);
    else if (years >= 1000)
        snprintf(out, 96, "frame %d   %.1f kyr", frame, years / 1000);
    else if (years > 0 && years < 1)
        snprintf(out, 96, "frame %d   %.0f days", frame, 365.25 * years);
    else
        snprintf(out, 96, "frame %d   %.*f yr", frame, years > 0 && years < 10 ? 1 : 0, years);
}

static void mark_interlocking(const struct job *job, int frame, struct slate *s)
{
    s->n_marks = 2;
    s->mark_name = "interlock";
    s->mark[0] = INFINITY;
    s->mark[1] = -INFINITY;
    for (size_t i = 0; i < job->n_strata; i++) {
        double at = job_interlock(job, i, frame);
        s->mark[0] = fmin(s->mark[0], at);
        s->mark[1] = fmax(s->mark[1], at);
    }
}

void slate_describe(const struct job *job, int frame, double years, const struct camera *camera,
                    enum value_id show, struct show_range range, const char *right, struct slate *s)
{
    char when[96];
    double to_middle[3];
    s->show = show;
    s->range = range;
    if (show == VALUE_stress && job->n_strata)
        mark_interlocking(job, frame, s);
    if (!right)
        return;
    for (int k = 0; k < 3; k++)
        to_middle[k] = 0.5 * job->domain.size_m[k] - camera->eye[k];
    double depth = dot3(to_middle, camera->ahead);
    if (depth > 0)
        s->px_per_m = 0.5 * camera->width / sqrt(dot3(camera->right, camera->right)) / depth;
    slate_when(job, frame, years, when);
    snprintf(s->left, sizeof s->left, "%.64s   %s", job->name, when);
    snprintf(s->right, sizeof s->right, "%s", right);
}
