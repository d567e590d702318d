#include "farm/slurm_jobs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/child.h"
#include "base/json.h"
#include "base/memory.h"

enum { FILE_MAX = 64 << 20 };

static status file_path(const struct farm *f, struct path *out)
{
    return path_join(out, f->root.text, "farm/slurm.json");
}

static bool is_id(const char *text)
{
    return *text && strlen(text) < SLURM_ID && text[strspn(text, "0123456789_")] == '\0';
}

/* The ids of the file, per task; tasks it does not know have "". */
static status read_ids(const struct farm *f, struct slurm_job *out, bool *there)
{
    status st = OK;
    struct path path;
    char *bytes = NULL;
    size_t n, at = 0;
    struct json *json = NULL;
    TRY(file_path(f, &path));
    *there = access(path.text, F_OK) == 0;
    if (!*there)
        return OK;
    TRY(file_read(path.text, FILE_MAX, &bytes, &n));
    TRY(json_read(path.text, bytes, n, &json));
    const struct json *list = json_member(json, "tasks");
    for (const struct json *row = list ? list->first : NULL; row; row = row->next) {
        const char *name = json_to_text(json_member(row, "task")),
                   *id = json_to_text(json_member(row, "job"));
        if (!name || !id || !is_id(id))
            continue;
        /* Both are in the graph's order, but for tasks of another range of frames. */
        for (size_t k = 0; k < f->graph.n; k++) {
            size_t i = (at + k) % f->graph.n;
            if (strcmp(f->graph.task[i].name, name) != 0)
                continue;
            snprintf(out[i].id, sizeof out[i].id, "%s", id);
            at = i + 1;
            break;
        }
    }
done:
    json_free(&json);
    free(bytes);
    return st;
}

static int by_id(const void *a, const void *b)
{
    return strcmp(((const struct slurm_job *)a)->id, ((const struct slurm_job *)b)->id);
}

/* Every job there is, by id. */
static status ask_squeue(struct slurm_job **out, size_t *n)
{
    status st = OK;
    static const char *const argv[] = {"squeue",       "--noheader",        "--array",
                                       "--states=all", "--format=%i %T %r", NULL};
    struct text answer = {0};
    char said[512];
    int code = 0;
    size_t capacity = 0;
    *out = NULL;
    *n = 0;
    TRY(child_ask(argv, SLURM_ANSWER_S, &answer, said, &code));
    if (code != 0) {
        st = fail(E_INPUT, code == 127 ? "squeue is not installed here%.0s" : "squeue: %s", said);
        goto done;
    }
    for (char *line = answer.data; line && *line;) {
        char *next = strchr(line, '\n');
        struct slurm_job j = {0};
        if (next)
            *next++ = '\0';
        if (sscanf(line, "%63s %31s %63s", j.id, j.state, j.reason) >= 2 && is_id(j.id)) {
            TRY(memory_grow(out, &capacity, *n + 1, sizeof **out, "the queue"));
            (*out)[(*n)++] = j;
        }
        line = next;
    }
    if (*n)
        qsort(*out, *n, sizeof **out, by_id);
done:
    text_free(&answer);
    return st;
}

status slurm_jobs(const struct farm *f, struct slurm_job **out)
{
    status st = OK;
    struct slurm_job *jobs = NULL, *queue = NULL;
    size_t n = 0;
    bool there = false;
    *out = NULL;
    TRY(memory_alloc(f->graph.n, sizeof *jobs, "the jobs", &jobs));
    TRY(read_ids(f, jobs, &there));
    if (!there)
        goto done;
    TRY(ask_squeue(&queue, &n));
    for (size_t i = 0; i < f->graph.n && n > 0; i++) {
        const struct slurm_job *found = bsearch(&jobs[i], queue, n, sizeof *queue, by_id);
        if (found && *jobs[i].id)
            jobs[i] = *found;
    }
    *out = jobs;
    jobs = NULL;
done:
    free(jobs);
    free(queue);
    return st;
}

status slurm_active(const struct farm *f, char (*job)[SLURM_ID])
{
    static const char *const active[] = {"PENDING",   "RUNNING",  "CONFIGURING",  "COMPLETING",
                                         "SUSPENDED", "REQUEUED", "REQUEUE_HOLD", "RESIZING",
                                         "STAGE_OUT", "STOPPED",  "SPECIAL_EXIT"};
    struct slurm_job *jobs = NULL;
    status st = slurm_jobs(f, &jobs);
    for (size_t i = 0; st == OK && jobs && i < f->graph.n; i++)
        for (size_t k = 0; k < sizeof active / sizeof *active; k++)
            if (strcmp(jobs[i].state, active[k]) == 0)
                snprintf(job[i], SLURM_ID, "%s", jobs[i].id);
    free(jobs);
    return st;
}

status slurm_remember(const struct farm *f, char (*job)[SLURM_ID])
{
    status st = OK;
    struct path path;
    struct slurm_job *before = NULL;
    struct text t = {0};
    bool there;
    TRY(memory_alloc(f->graph.n, sizeof *before, "the jobs", &before));
    TRY(read_ids(f, before, &there));
    json_object(&t, NULL);
    json_array(&t, "tasks");
    for (size_t i = 0; i < f->graph.n; i++) {
        const char *id = *job[i] ? job[i] : before[i].id;
        if (!*id)
            continue;
        json_object(&t, NULL);
        json_text(&t, "task", f->graph.task[i].name);
        json_text(&t, "job", id);
        json_end_object(&t);
    }
    json_end_array(&t);
    json_end_object(&t);
    TRY(text_status(&t));
    TRY(file_path(f, &path));
    TRY(atomic_file_write(path.text, t.data, t.size));
done:
    free(before);
    text_free(&t);
    return st;
}
