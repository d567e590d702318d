#include "run/timing.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/log.h"
#include "base/path.h"
#include "base/version.h"
#include "text/json.h"
#include "text/text.h"

/* Rounds to milliseconds; more digits are noise. */
static double rounded(double seconds)
{
    return (double)(int64_t)(seconds * 1000 + 0.5) / 1000;
}

static void describe(const struct gpu *gpu, int first, int last, double started, struct text *t)
{
    const struct gpu_info *info = gpu_info(gpu);
    const struct gpu_time *times;
    const size_t n = gpu_stage_times(gpu, &times);
    char ended[32] = "";
    struct tm tm;
    time_t now = time(NULL);
    if (gmtime_r(&now, &tm))
        strftime(ended, sizeof ended, "%Y-%m-%dT%H:%M:%SZ", &tm);
    json_object(t, NULL);
    json_integer(t, "format", 1);
    json_text(t, "version", hoodoo_version);
    json_text(t, "commit", hoodoo_commit);
    json_text(t, "device", info->name);
    json_text(t, "driver", info->driver);
    json_text(t, "ended", ended);
    json_integer(t, "first_frame", first);
    json_integer(t, "last_frame", last);
    json_number(t, "wall_seconds", rounded(clock_seconds() - started));
    json_array(t, "stages");
    for (size_t i = 0; i < n; i++) {
        if (times[i].ns == 0)
            continue;
        json_object(t, NULL);
        json_text(t, "name", times[i].name);
        json_number(t, "device_seconds", rounded((double)times[i].ns / 1e9));
        json_integer(t, "dispatches", (int64_t)times[i].dispatches);
        json_end_object(t);
        log_note("device time: %-12s %8.2f s in %llu dispatches", times[i].name, (double)times[i].ns / 1e9,
                 (unsigned long long)times[i].dispatches);
    }
    json_end_array(t);
    json_end_object(t);
}

/* Appends the object in *t, as one line, and frees it. */
static void append(const char *root, const char *name, struct text *t)
{
    struct path path;
    int file = -1;
    if (text_status(t) != OK || path_join(&path, root, name) != OK) {
        log_note("%s: %s", name, status_message());
        goto done;
    }
    json_one_line(t);
    file = open(path.text, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file < 0 || write(file, t->data, t->size) != (ssize_t)t->size)
        log_note("%s: %s", path.text, strerror(errno));
done:
    if (file >= 0)
        close(file);
    text_free(t);
}

void timing_write(const char *root, const struct gpu *gpu, int first, int last, double started)
{
    struct text t = {0};
    describe(gpu, first, last, started, &t);
    append(root, "log/timing.jsonl", &t);
}

/* ---- frames */

static const char frames_log[] = "log/frames.jsonl";

void timing_add_frame(const char *root, int frame, double seconds)
{
    struct text t = {0};
    json_object(&t, NULL);
    json_integer(&t, "frame", frame);
    json_number(&t, "seconds", rounded(seconds));
    json_end_object(&t);
    append(root, frames_log, &t);
}

/* The end of the file as text; "" if there is none. */
static void read_end(const char *root, char *out, size_t size)
{
    struct path path;
    struct stat info;
    const int file =
        path_join(&path, root, frames_log) == OK ? open(path.text, O_RDONLY | O_CLOEXEC | O_NONBLOCK) : -1;
    ssize_t n = -1;
    if (file >= 0 && fstat(file, &info) == 0 && S_ISREG(info.st_mode))
        n = pread(file, out, size - 1, info.st_size > (off_t)size - 1 ? info.st_size - ((off_t)size - 1) : 0);
    out[n > 0 ? n : 0] = '\0';
    if (file >= 0)
        close(file);
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The seconds in a line, or -1: the first line may be cut, and the last if a machine died in it. */
static status seconds_of(const char *line, size_t length, double *seconds)
{
    struct json *json = NULL;
    const status st = json_read(NULL, line, length, &json);
    const struct json *s = st == OK ? json_member(json, "seconds") : NULL;
    *seconds = s && s->kind == JSON_NUMBER && s->number >= 0 && isfinite(s->number) ? s->number : -1;
    json_free(&json);
    return st == E_MEMORY ? st : OK;
}

status timing_frame_seconds(const char *root, double *seconds)
{
    enum { RECENT = 50, LEAST = 3, END = 4096 };
    status st = OK;
    char end[END];
    double each, recent[RECENT];
    size_t n = 0;
    *seconds = 0;
    read_end(root, end, sizeof end);
    for (const char *line = end; *line;) {
        const size_t length = strcspn(line, "\n");
        TRY(seconds_of(line, length, &each));
        if (each >= 0)
            recent[n++ % RECENT] = each;
        line += length + (line[length] == '\n');
    }
    if (n < LEAST)
        return OK;
    n = n < RECENT ? n : RECENT;
    qsort(recent, n, sizeof *recent, ascending);
    *seconds = recent[n / 2];
done:
    return st;
}
