#include "farm/describe.h"

#include <math.h>
#include <stdio.h>

#include "base/visible.h"
#include "farm/command.h"
#include "farm/needs.h"

enum { ROWS = 100 };

static void put_wedges(const struct farm *f, bool words, struct text *out)
{
    json_array(out, "wedges");
    for (size_t i = 0; i < f->n_wedges && !(words && i == ROWS); i++) {
        const struct job *job = f->wedge[i].job;
        json_object(out, NULL);
        json_integer(out, "wedge", job->wedge.index);
        json_text(out, "name", job->name);
        json_text(out, "values", job->wedge.label);
        json_end_object(out);
    }
    json_end_array(out);
}

/* Most tasks wait for one or two others; those that wait for many do so for all of a kind. */
static void put_after(const struct farm_graph *g, const struct farm_task *t, bool words, struct text *out)
{
    char text[256] = "-";
    if (words) {
        if (t->n_after == 1)
            snprintf(text, sizeof text, "%s", g->task[g->after[t->after]].name);
        else if (t->n_after > 1)
            snprintf(text, sizeof text, "%s and %zu more", g->task[g->after[t->after]].name, t->n_after - 1);
        json_text(out, "after", text);
        return;
    }
    json_array(out, "after");
    for (size_t k = 0; k < t->n_after; k++)
        json_text(out, NULL, g->task[g->after[t->after + k]].name);
    json_end_array(out);
}

static status put_output(void *user, const char *path)
{
    json_text(user, NULL, path);
    return OK;
}

/* What a farm needs to run the task. Paths are those of this machine. */
static status put_command(const struct farm *f, const struct farm_task *t, const char *device,
                          struct text *out)
{
    status st = OK;
    struct farm_command c;
    struct farm_needs needs;
    struct path log;
    char threads[16], delay[16];
    farm_needs(f, t, device, &needs);
    TRY(farm_command(f, t, device ? device : "auto", needs.cpus, &c));
    json_bool(out, "after_any", t->kind == FARM_END);
    json_array(out, "argv");
    for (size_t i = 0; i < c.n; i++)
        json_text(out, NULL, c.argv[i]);
    json_end_array(out);
    snprintf(threads, sizeof threads, "%d", needs.cpus);
    snprintf(delay, sizeof delay, "%d", VISIBLE_DELAY_S);
    json_object(out, "environment");
    json_text(out, "HOODOO_DISK_DELAY", delay);
    json_text(out, "OMP_NUM_THREADS", threads);
    if (!needs.gpu)
        json_text(out, "LP_NUM_THREADS", threads);
    json_end_object(out);
    json_integer(out, "cpus", needs.cpus);
    json_bool(out, "gpu", needs.gpu);
    json_integer(out, "gpu_memory_bytes", (int64_t)needs.gpu_bytes);
    json_integer(out, "memory_bytes", (int64_t)needs.memory_bytes);
    json_integer(out, "peak_bytes", (int64_t)needs.peak_bytes);
    json_integer(out, "time_limit_seconds", needs.limit_s);
    json_integer(out, "notice_seconds", needs.notice_s);
    json_array(out, "outputs");
    TRY(farm_task_outputs(f, t, put_output, out));
    json_end_array(out);
    TRY(farm_log_path(f, t, &log));
    json_text(out, "log", log.text);
done:
    return st;
}

status farm_describe(const struct farm *f, bool words, const char *device, struct text *out)
{
    const struct farm_graph *g = &f->graph;
    status st = OK;
    char frames[48];
    double seconds = 0;
    uint64_t disk = 0;
    if (f->wedge[0].job->wedge.index)
        put_wedges(f, words, out);
    json_array(out, "tasks");
    for (size_t i = 0; i < g->n; i++) {
        const struct farm_task *t = &g->task[i];
        seconds += t->seconds;
        disk += t->disk_bytes;
        if (words && i >= ROWS)
            continue;
        json_object(out, NULL);
        json_text(out, "name", t->name);
        json_text(out, "kind", farm_stage_name(t->kind));
        if (!words)
            json_integer(out, "wedge", t->wedge);
        json_text(out, "frames", range_text(t->frames, frames));
        put_after(g, t, words, out);
        json_number(out, "estimated_seconds", ceil(t->seconds));
        json_integer(out, "device_bytes", (int64_t)t->device_bytes);
        json_integer(out, "disk_bytes", (int64_t)t->disk_bytes);
        if (!words)
            TRY(put_command(f, t, device, out));
        json_end_object(out);
    }
    json_end_array(out);
    if (words && g->n > ROWS)
        json_text(out, "more_tasks", "--json lists them all");
    json_integer(out, "task_count", (int64_t)g->n);
    json_number(out, "tasks_seconds", ceil(seconds));
    json_integer(out, "tasks_disk_bytes", (int64_t)disk);
done:
    return st;
}
