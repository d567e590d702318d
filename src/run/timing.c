#include "run/timing.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/log.h"
#include "base/path.h"
#include "base/version.h"
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

void timing_write(const char *root, const struct gpu *gpu, int first, int last, double started)
{
    struct path path;
    struct text t = {0};
    int file = -1;
    describe(gpu, first, last, started, &t);
    if (text_status(&t) != OK || path_join(&path, root, "log/timing.jsonl") != OK) {
        log_note("log/timing.jsonl: %s", status_message());
        goto done;
    }
    json_one_line(&t);
    file = open(path.text, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file < 0 || write(file, t.data, t.size) != (ssize_t)t.size)
        log_note("%s: %s", path.text, strerror(errno));
done:
    if (file >= 0)
        close(file);
    text_free(&t);
}
