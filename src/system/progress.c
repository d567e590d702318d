#include "system/progress.h"

#include <math.h>
#include <pthread.h>
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

static void draw(const struct progress *p)
{
    char line[512], meter[21];
    /* One column less than the width, because a full line wraps on some terminals. */
    int width = terminal_width() - 1;
    size_t filled = p->total ? p->done * (sizeof meter - 1) / p->total : 0;
    memset(meter, '.', sizeof meter - 1);
    memset(meter, '#', filled);
    meter[sizeof meter - 1] = '\0';
    snprintf(line, sizeof line, "%s%s%s%s%s%s", width > 100 ? "[" : "", width > 100 ? meter : "",
             width > 100 ? "] " : "", p->line, *p->stage ? " | " : "", p->stage);
    fprintf(stderr, "\r%.*s\033[K", width > 0 ? width : 0, line);
    fflush(stderr);
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

/* ---- the line that all styles share */

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
    for (char *c = p->line; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = ' ';
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
    *p = (struct progress){.share = 1};
    attach(p, style);
}

void progress_stage(struct progress *p, int frame, const char *stage)
{
    if (p->style != PROGRESS_BAR)
        return;
    pthread_mutex_lock(&lock);
    snprintf(p->stage, sizeof p->stage, "%d %s", frame, stage);
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
    p->stage[0] = '\0';
    compose(p, note);
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
