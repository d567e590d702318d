#include "system/progress.h"

#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/log.h"

/* The bar on screen. Log lines come from any thread, so the lock is held while one is printed. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct progress *shown;

const char *duration_text(double seconds, char out[32])
{
    double s = isfinite(seconds) && seconds > 0 ? fmin(round(seconds), 1e9) : 0;
    long whole = (long)s;
    if (whole >= 86400)
        snprintf(out, 32, "%ld d %ld h", whole / 86400, whole / 3600 % 24);
    else if (whole >= 3600)
        snprintf(out, 32, "%ld h %ld min", whole / 3600, whole / 60 % 60);
    else if (whole >= 60)
        snprintf(out, 32, "%ld min %ld s", whole / 60, whole % 60);
    else
        snprintf(out, 32, "%ld s", whole);
    return out;
}

/* ---- the bar */

static int terminal_width(void)
{
    struct winsize size;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
        return size.ws_col;
    return 80;
}

/* Adds a part to the bar's line if all of it fits. */
static void add_part(char *line, size_t width, const char *format, ...) PRINTF_LIKE(3, 4);
static void add_part(char *line, size_t width, const char *format, ...)
{
    char part[400];
    const size_t n = strlen(line);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(part, sizeof part, format, arguments);
    va_end(arguments);
    if (n + strlen(part) <= width)
        strcpy(line + n, part);
}

/* A meter, and the parts that fit, the most important first. */
static void draw(struct progress *p)
{
    enum { LONGEST = 300, METER = 20 };
    char line[LONGEST + 1] = "", left[32];
    const int columns = terminal_width() - 1; /* because a full line wraps on some terminals */
    const size_t width = (size_t)(columns < 0 ? 0 : columns < LONGEST ? columns : LONGEST);
    const size_t cells = width < 60 ? METER / 2 : METER, filled = p->total ? p->done * cells / p->total : 0;
    char meter[METER + 1] = "";
    memset(meter, '.', cells);
    memset(meter, '#', filled);
    add_part(line, width, "[%s] ", meter);
    add_part(line, width, "%zu/%zu", p->done, p->total);
    if (p->notes) {
        snprintf(line + strlen(line), sizeof line - strlen(line), ", %.*s",
                 (int)(width > strlen(line) + 2 ? width - strlen(line) - 2 : 0), p->line);
    } else {
        if (p->seconds_per_frame > 0)
            add_part(line, width, ", %s to go",
                     duration_text((double)(p->total - p->done) * p->seconds_per_frame, left));
        if (*p->stage)
            add_part(line, width, ", %s", p->stage);
        if (p->share >= 0 && p->frame_done)
            add_part(line, width, ", %.1f%% left", 100 * p->share);
        if (p->seconds_per_frame > 0)
            add_part(line, width, ", %.3g frames/s", 1 / p->seconds_per_frame);
        if (*p->note)
            add_part(line, width, ", %s", p->note);
    }
    line[width] = '\0';
    fprintf(stderr, "\r%s\033[K", line);
    fflush(stderr);
    p->drawn_s = clock_seconds();
}

static void step_aside(bool before)
{
    /* The guard may have been set between the two calls of another thread. */
    static _Thread_local bool held;
    if (before) {
        pthread_mutex_lock(&lock);
        held = true;
        if (shown)
            fputs("\r\033[K", stderr);
    } else if (held) {
        if (shown)
            draw(shown);
        held = false;
        pthread_mutex_unlock(&lock);
    }
}

/* ---- the line that the other styles share */

static void printable(char *text)
{
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = ' ';
}

static void compose(struct progress *p, const char *note)
{
    char left[32];
    size_t size = sizeof p->line;
    int n = snprintf(p->line, size, "frame %d, %zu/%zu", p->frame, p->done, p->total);
    if (p->share >= 0)
        n += snprintf(p->line + n, size - (size_t)n, ", %.1f%% of the rock left", 100 * p->share);
    if (p->seconds_per_frame > 0 && n > 0 && (size_t)n < size) {
        double rate = 1 / p->seconds_per_frame;
        n += snprintf(p->line + n, size - (size_t)n, ", %.*f frames/s, %s to go", rate < 0.1 ? 4 : 2, rate,
                      duration_text((double)(p->total - p->done) * p->seconds_per_frame, left));
    }
    if (note && *note && n > 0 && (size_t)n < size)
        snprintf(p->line + n, size - (size_t)n, ", %s", note);
    /* Farm managers interpret lines of stdout, so a note must not be able to start a new line. */
    printable(p->line);
}

static void print_openjd(struct progress *p)
{
    double percent = p->total ? 100 * (double)p->done / (double)p->total : 100;
    p->percent_reported = fmax(p->percent_reported, fmin(percent, 100));
    printf("openjd_progress: %.1f\nopenjd_status: %s\n", p->percent_reported, p->line);
    fflush(stdout);
}

static void show(struct progress *p)
{
    if (p->style == PROGRESS_BAR) {
        pthread_mutex_lock(&lock);
        draw(p);
        pthread_mutex_unlock(&lock);
    } else if (p->style == PROGRESS_OPENJD) {
        print_openjd(p);
    } else if (p->style == PROGRESS_PLAIN) {
        log_info("%s", p->line);
    }
}

/* Resolves `auto`, and starts the bar if that is the style. */
static void attach(struct progress *p, enum progress_style style)
{
    const char *terminal = getenv("TERM");
    p->style = style;
    p->last_s = clock_seconds();
    if (style == PROGRESS_AUTO) {
        bool capable = isatty(STDERR_FILENO) && terminal && strcmp(terminal, "dumb") != 0;
        p->style = capable ? PROGRESS_BAR : PROGRESS_PLAIN;
    }
    if (p->style == PROGRESS_BAR) {
        pthread_mutex_lock(&lock);
        shown = p;
        pthread_mutex_unlock(&lock);
        log_set_guard(step_aside);
    }
}

void progress_begin(struct progress *p, enum progress_style style, struct frame_range frames, size_t done)
{
    char range[48];
    *p = (struct progress){.frames = frames, .total = range_count(frames), .share = 1};
    p->done = done < p->total ? done : p->total;
    snprintf(p->line, sizeof p->line, "frames %s, %zu/%zu", range_text(frames, range), p->done, p->total);
    attach(p, style);
    show(p);
}

void progress_begin_notes(struct progress *p, enum progress_style style)
{
    *p = (struct progress){.share = 1, .notes = true};
    attach(p, style);
}

void progress_stage(struct progress *p, int frame, const char *stage)
{
    if (p->style != PROGRESS_BAR)
        return;
    pthread_mutex_lock(&lock);
    /* Stages of small scenes take less time than drawing. */
    const bool now = !*p->stage || clock_seconds() - p->drawn_s > 0.1;
    snprintf(p->stage, sizeof p->stage, "%d %s", frame, stage);
    if (now)
        draw(p);
    pthread_mutex_unlock(&lock);
}

void progress_frame(struct progress *p, int frame, double volume_share, const char *note)
{
    /* Exponential smoothing with a factor of 0.2, started with the first frame. */
    double now = clock_seconds(), took = now - p->last_s;
    p->seconds_per_frame =
        p->seconds_per_frame > 0 ? 0.8 * p->seconds_per_frame + 0.2 * took : fmax(took, 1e-6);
    p->last_s = now;
    pthread_mutex_lock(&lock);
    p->frame = frame;
    p->share = volume_share;
    p->done += p->done < p->total;
    p->frame_done = true;
    p->stage[0] = '\0';
    compose(p, note);
    snprintf(p->note, sizeof p->note, "%s", note ? note : "");
    printable(p->note);
    pthread_mutex_unlock(&lock);
    show(p);
}

void progress_note(struct progress *p, size_t done, size_t total, const char *line)
{
    pthread_mutex_lock(&lock);
    p->done = done;
    p->total = total;
    snprintf(p->line, sizeof p->line, "%s", line);
    pthread_mutex_unlock(&lock);
    if (p->style != PROGRESS_PLAIN)
        show(p);
}

void progress_end(struct progress *p)
{
    if (p->style != PROGRESS_BAR || shown != p)
        return;
    /* The guard stays set; without a bar it has no effect. */
    pthread_mutex_lock(&lock);
    shown = NULL;
    pthread_mutex_unlock(&lock);
    fputc('\n', stderr);
}
