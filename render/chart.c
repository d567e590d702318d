#include "render/chart.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/utf8.h"

/* ---- text */

void html_text(struct text *t, const char *value)
{
    for (const unsigned char *p = (const unsigned char *)value; *p;) {
        const size_t n = utf8_length(p, 4); /* a NUL ends the text */
        if (*p == '&')
            text_add(t, "&amp;");
        else if (*p == '<')
            text_add(t, "&lt;");
        else if (*p == '>')
            text_add(t, "&gt;");
        else if (*p == '"')
            text_add(t, "&quot;");
        else if (*p == '\'')
            text_add(t, "&#39;");
        else if (*p < 0x20 || *p == 0x7f)
            text_add(t, " ");
        else if (n == 0)
            text_add(t, "\xef\xbf\xbd");
        else
            text_add_bytes(t, p, n);
        p += n ? n : 1;
    }
}

const char *html_number(double value, char out[48])
{
    static const char thin[] = "\xe2\x80\xaf"; /* a no-break space */
    char digits[40];
    const double size = fabs(value);
    if (!isfinite(value)) {
        snprintf(out, 48, "\xe2\x80\x93");
        return out;
    }
    if (size >= 1e12 || (size > 0 && size < 1e-4)) {
        snprintf(out, 48, "%.3g", value);
        return out;
    }
    if (size >= 100) {
        snprintf(digits, sizeof digits, "%.0f", value);
    } else {
        snprintf(digits, sizeof digits, "%.*f", size >= 10 ? 1 : size >= 1 ? 2 : size >= 0.1 ? 3 : 4, value);
        /* Remove trailing zeros after the decimal point. */
        char *end = digits + strlen(digits);
        while (end[-1] == '0')
            *--end = '\0';
        if (end[-1] == '.')
            *--end = '\0';
    }
    size_t n = strlen(digits), k = 0, sign = digits[0] == '-';
    const bool grouped = !strchr(digits, '.') && n - sign > 4;
    for (size_t i = 0; i < n; i++) {
        if (grouped && i > sign && (n - i) % 3 == 0) {
            memcpy(out + k, thin, 3);
            k += 3;
        }
        out[k++] = digits[i];
    }
    out[k] = '\0';
    if (strcmp(out, "-0") == 0)
        strcpy(out, "0");
    return out;
}

/* ---- axes */

enum { WIDTH = 540, HEIGHT = 290, LEFT = 76, RIGHT = 18, TOP = 14, BOTTOM = 50 };

struct axis {
    double low, high, step; /* step: distance between ticks */
    int from, to;           /* px */
};

static double at(const struct axis *a, double value)
{
    return a->from + (value - a->low) / (a->high - a->low) * (a->to - a->from);
}

/* The step is 1, 2 or 5 times a power of ten. With `widen`, the axis is extended to a tick at both ends. */
static void set_axis(struct axis *a, double low, double high, int ticks, bool widen)
{
    if (!(high > low)) {
        const double about = fabs(low) > 0 ? 0.05 * fabs(low) : 1;
        low -= about;
        high += about;
    }
    const double raw = (high - low) / ticks, power = pow(10, floor(log10(raw))), part = raw / power;
    a->step = power * (part <= 1 ? 1 : part <= 2 ? 2 : part <= 5 ? 5 : 10);
    a->low = widen ? a->step * floor(low / a->step + 1e-9) : low;
    a->high = widen ? a->step * ceil(high / a->step - 1e-9) : high;
}

static void begin(struct text *t, const char *title, int height)
{
    text_add(t, "<figure class=\"chart\"><figcaption>");
    html_text(t, title);
    text_add(t, "</figcaption><svg viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"", WIDTH, height);
    html_text(t, title);
    text_add(t, "\">\n");
}

static void end(struct text *t)
{
    text_add(t, "</svg></figure>\n");
}

static void add_axes(struct text *t, const struct axis *x, const struct axis *y, const char *x_label,
                     const char *y_label)
{
    char number[48];
    for (double v = y->step * ceil(y->low / y->step - 1e-9); v <= y->high + 1e-9 * y->step; v += y->step)
        text_add(
            t,
            "<line class=\"grid\" x1=\"%d\" x2=\"%d\" y1=\"%.1f\" y2=\"%.1f\"/><text class=\"tick\" x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n",
            x->from, x->to, at(y, v), at(y, v), x->from - 8, at(y, v) + 4, html_number(v, number));
    for (double v = x->step * ceil(x->low / x->step - 1e-9); v <= x->high + 1e-9 * x->step; v += x->step)
        text_add(
            t,
            "<line class=\"axis\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\"/><text class=\"tick\" x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%s</text>\n",
            at(x, v), at(x, v), y->from, y->from + 5, at(x, v), y->from + 19, html_number(v, number));
    text_add(t, "<line class=\"axis\" x1=\"%d\" x2=\"%d\" y1=\"%d\" y2=\"%d\"/>\n", x->from, x->to, y->from,
             y->from);
    text_add(t, "<text class=\"label\" x=\"%d\" y=\"%d\" text-anchor=\"middle\">", (x->from + x->to) / 2,
             y->from + 40);
    html_text(t, x_label);
    text_add(
        t,
        "</text>\n<text class=\"label\" transform=\"translate(14 %d) rotate(-90)\" text-anchor=\"middle\">",
        (y->from + y->to) / 2);
    html_text(t, y_label);
    text_add(t, "</text>\n");
}

static void add_legend(struct text *t, const struct chart *c)
{
    text_add(t, "<p class=\"legend\">");
    for (size_t s = 0; s < c->n_series; s++) {
        text_add(t, "<span><i style=\"background:%s\"></i>", c->series[s].color);
        html_text(t, c->series[s].name);
        text_add(t, "</span>");
    }
    text_add(t, "</p>");
}

/* ---- charts */

static double sum(const struct chart *c, size_t i, size_t n_series)
{
    double total = 0;
    for (size_t s = 0; s < n_series; s++)
        total += c->series[s].y[i];
    return total;
}

static void add_area(struct text *t, const struct chart *c, const struct axis *x, const struct axis *y,
                     size_t s)
{
    text_add(t, "<polygon fill=\"%s\" points=\"", c->series[s].color);
    for (size_t i = 0; i < c->n; i++)
        text_add(t, "%.1f,%.1f ", at(x, c->x[i]), at(y, sum(c, i, s + 1)));
    for (size_t i = c->n; i-- > 0;)
        text_add(t, "%.1f,%.1f ", at(x, c->x[i]), at(y, sum(c, i, s)));
    text_add(t, "\"/>\n");
}

/* A NaN interrupts the line. */
static void add_line(struct text *t, const struct chart *c, const struct axis *x, const struct axis *y,
                     size_t s)
{
    bool drawing = false;
    text_add(t, "<path class=\"line\" stroke=\"%s\" d=\"", c->series[s].color);
    for (size_t i = 0; i < c->n; i++) {
        const double v = c->series[s].y[i];
        if (isfinite(v))
            text_add(t, "%c%.1f %.1f", drawing ? 'L' : 'M', at(x, c->x[i]), at(y, v));
        drawing = isfinite(v);
    }
    text_add(t, "\"/>\n");
}

/* Hovering anywhere in a frame's column shows its values. */
static void add_values(struct text *t, const struct chart *c, const struct axis *x, const struct axis *y)
{
    char number[48];
    for (size_t i = 0; i < c->n; i++) {
        const double before = i ? (c->x[i - 1] + c->x[i]) / 2 : c->x[i],
                     after = i + 1 < c->n ? (c->x[i] + c->x[i + 1]) / 2 : c->x[i];
        text_add(t, "<rect class=\"hit\" x=\"%.1f\" y=\"%d\" width=\"%.1f\" height=\"%d\"><title>",
                 at(x, before), y->to, fmax(at(x, after) - at(x, before), 0.5), y->from - y->to);
        html_text(t, c->x_label);
        text_add(t, ": %s", html_number(c->x[i], number));
        for (size_t s = 0; s < c->n_series; s++) {
            text_add(t, "\n");
            html_text(t, c->series[s].name);
            text_add(t, ": %s", html_number(c->series[s].y[i], number));
        }
        text_add(t, "</title></rect>\n");
    }
}

void chart_lines(const struct chart *c, struct text *t)
{
    double low = c->from_zero || c->stacked ? 0 : HUGE_VAL, high = c->from_zero || c->stacked ? 0 : -HUGE_VAL;
    for (size_t i = 0; i < c->n; i++)
        for (size_t s = 0; s < c->n_series; s++) {
            const double v = c->stacked ? sum(c, i, s + 1) : c->series[s].y[i];
            if (isfinite(v)) {
                low = fmin(low, v);
                high = fmax(high, v);
            }
        }
    if (low > high)
        low = high = 0;
    struct axis x = {.from = LEFT, .to = WIDTH - RIGHT}, y = {.from = HEIGHT - BOTTOM, .to = TOP};
    set_axis(&x, c->x[0], c->x[c->n - 1], 7, false);
    set_axis(&y, low, high, 5, true);
    begin(t, c->title, HEIGHT);
    for (size_t s = c->n_series; c->stacked && s-- > 0;)
        add_area(t, c, &x, &y, s);
    add_axes(t, &x, &y, c->x_label, c->y_label);
    for (size_t s = 0; !c->stacked && s < c->n_series; s++)
        add_line(t, c, &x, &y, s);
    if (c->mark && *c->mark >= x.low && *c->mark <= x.high)
        text_add(t, "<line class=\"mark\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\"/>\n", at(&x, *c->mark),
                 at(&x, *c->mark), y.from, y.to);
    add_values(t, c, &x, &y);
    text_add(t, "</svg>");
    if (c->n_series > 1)
        add_legend(t, c);
    text_add(t, "</figure>\n");
}

void chart_histogram(const struct histogram *h, struct text *t)
{
    char low[48], high[48], share[48];
    double most = 0;
    for (size_t i = 0; i < h->n; i++)
        most = fmax(most, h->share[i]);
    struct axis x = {.from = LEFT, .to = WIDTH - RIGHT}, y = {.from = HEIGHT - BOTTOM, .to = TOP + 16};
    set_axis(&x, h->low, h->high, 8, false);
    set_axis(&y, 0, most, 5, true);
    begin(t, h->title, HEIGHT);
    add_axes(t, &x, &y, h->x_label, h->y_label);
    const double width = (h->high - h->low) / (double)h->n;
    for (size_t i = 0; i < h->n; i++) {
        const double from = h->low + width * (double)i, to = from + width;
        text_add(
            t,
            "<rect class=\"bar\" x=\"%.2f\" width=\"%.2f\" y=\"%.1f\" height=\"%.1f\"><title>%s to %s: %s %%</title></rect>\n",
            at(&x, from) + 0.5, at(&x, to) - at(&x, from) - 1, at(&y, h->share[i]),
            y.from - at(&y, h->share[i]), html_number(from, low), html_number(to, high),
            html_number(h->share[i], share));
    }
    for (size_t i = 0; i < h->n_marks; i++) {
        const double m = at(&x, h->mark[i].x);
        const bool left = m > (x.from + x.to) / 2.0;
        text_add(
            t,
            "<line class=\"mark\" x1=\"%.1f\" x2=\"%.1f\" y1=\"%d\" y2=\"%d\"/><text class=\"tick\" x=\"%.1f\" y=\"%zu\" text-anchor=\"%s\">",
            m, m, y.from, TOP, m + (left ? -5 : 5), TOP + 8 + 14 * i, left ? "end" : "start");
        html_text(t, h->mark[i].name);
        text_add(t, "</text>\n");
    }
    end(t);
}

void chart_rows(const char *title, const char *x_label, const struct row *row, size_t n, double full,
                struct text *t)
{
    enum { ROW = 26, NAMES = 150, NOTES = 126 };
    const int height = TOP + ROW * (int)n + 26;
    begin(t, title, height);
    for (size_t i = 0; i < n; i++) {
        const int y = TOP + ROW * (int)i;
        const double width = full > 0 ? fmax(row[i].value / full, 0) * (WIDTH - NAMES - NOTES) : 0;
        text_add(t, "<text class=\"name\" x=\"%d\" y=\"%d\" text-anchor=\"end\">", NAMES - 10, y + 16);
        html_text(t, row[i].name);
        text_add(
            t,
            "</text><rect class=\"rail\" x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/><rect x=\"%d\" y=\"%d\" width=\"%.1f\" height=\"%d\" fill=\"%s\"/><text class=\"tick\" x=\"%d\" y=\"%d\">",
            NAMES, y + 4, WIDTH - NAMES - NOTES, ROW - 9, NAMES, y + 4, width, ROW - 9, row[i].color,
            WIDTH - NOTES + 8, y + 16);
        html_text(t, row[i].note);
        text_add(t, "</text>\n");
    }
    text_add(t, "<text class=\"label\" x=\"%d\" y=\"%d\" text-anchor=\"middle\">",
             (NAMES + WIDTH - NOTES) / 2, height - 6);
    html_text(t, x_label);
    text_add(t, "</text>\n");
    end(t);
}
