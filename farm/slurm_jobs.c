#include "farm/slurm_jobs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "farm/argv.h"
#include "system/atomic_file.h"
#include "system/child.h"
#include "text/json.h"

enum { FILE_MAX = 64 << 20 };

static status file_path(const struct farm *f, struct path *out)
{
    return path_join(out, f->root.text, "farm/slurm.json");
}

static bool is_id(const char *text)
{
    return *text && strlen(text) < SLURM_ID && text[strspn(text, "0123456789_")] == '\0';
}

/* The ids in the file; a task that it does not list has "". */
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
        /* The file is in the graph's order, except for tasks of another range of frames. */
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

/* Adds the jobs in squeue's answer. */
static status read_queue(char *answer, struct slurm_job **out, size_t *n, size_t *capacity)
{
    status st = OK;
    for (char *line = answer; line && *line;) {
        char *next = strchr(line, '\n');
        struct slurm_job j = {0};
        char *const field[] = {j.id, j.state, j.node, j.elapsed, j.reason};
        const size_t size[] = {sizeof j.id, sizeof j.state, sizeof j.node, sizeof j.elapsed, sizeof j.reason};
        if (next)
            *next++ = '\0';
        for (size_t i = 0; i < sizeof size / sizeof *size && line; i++) {
            char *bar = strchr(line, '|');
            if (bar)
                *bar++ = '\0';
            snprintf(field[i], size[i], "%s", line);
            line = bar;
        }
        if (is_id(j.id) && *j.state) {
            TRY(memory_grow(out, capacity, *n + 1, sizeof **out, "the queue"));
            (*out)[(*n)++] = j;
        }
        line = next;
    }
done:
    return st;
}

/* Asks about the jobs in `ids`, which commas separate. squeue fails if it is asked for a single job that it no longer knows. */
static status ask_some(const char *ids, struct slurm_job **out, size_t *n, size_t *capacity)
{
    status st = OK;
    struct argv_list a = {0};
    struct text answer = {0};
    char said[512];
    int code = 0;
    argv_add(&a, "squeue");
    argv_add(&a, "--noheader");
    argv_add(&a, "--array");
    argv_add(&a, "--states=all");
    argv_add(&a, "--format=%%i|%%T|%%N|%%M|%%r");
    argv_add(&a, "--jobs=%s", ids);
    TRY(argv_status(&a));
    TRY(child_ask((const char *const *)a.argv, SLURM_ANSWER_S, &answer, said, &code));
    if (code != 0 && !strstr(said, "Invalid job id")) {
        st = fail(E_INPUT, code == 127 ? "squeue is not installed here%.0s" : "squeue: %s", said);
        goto done;
    }
    TRY(read_queue(answer.data, out, n, capacity));
done:
    argv_free(&a);
    text_free(&answer);
    return st;
}

/* What Slurm knows of the tasks' jobs, sorted by id; an array is asked for once. */
static status ask_squeue(const struct slurm_job *jobs, size_t n_jobs, struct slurm_job **out, size_t *n)
{
    enum { AT_ONCE = 60000 }; /* bytes */
    status st = OK;
    struct text ids = {0};
    size_t capacity = 0;
    const char *last = "";
    *out = NULL;
    *n = 0;
    for (size_t i = 0; i < n_jobs; i++) {
        const size_t length = strcspn(jobs[i].id, "_");
        if (length == 0 || (strncmp(last, jobs[i].id, length) == 0 && strcspn(last, "_") == length))
            continue;
        last = jobs[i].id;
        text_add(&ids, "%s%.*s", ids.size ? "," : "", (int)length, last);
        if (ids.size > AT_ONCE) {
            TRY(text_status(&ids));
            TRY(ask_some(ids.data, out, n, &capacity));
            text_free(&ids);
        }
    }
    TRY(text_status(&ids));
    if (ids.size)
        TRY(ask_some(ids.data, out, n, &capacity));
    if (*n)
        qsort(*out, *n, sizeof **out, by_id);
done:
    text_free(&ids);
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
    TRY(ask_squeue(jobs, f->graph.n, &queue, &n));
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

status slurm_cancel(const char (*job)[SLURM_ID], size_t n)
{
    enum { AT_ONCE = 500 };
    status st = OK;
    struct argv_list a = {0};
    struct text answer = {0};
    char said[512];
    int code = 0;
    for (size_t i = 0; i < n;) {
        argv_free(&a);
        argv_add(&a, "scancel");
        for (; i < n && a.n <= AT_ONCE; i++)
            if (*job[i])
                argv_add(&a, "%s", job[i]);
        if (a.n == 1)
            continue;
        TRY(argv_status(&a));
        TRY(child_ask((const char *const *)a.argv, SLURM_ANSWER_S, &answer, said, &code));
        if (code != 0) {
            st = fail(code == 127 ? E_INPUT : E_OUTPUT,
                      code == 127 ? "scancel is not installed here%.0s" : "scancel: %s", said);
            goto done;
        }
    }
done:
    argv_free(&a);
    text_free(&answer);
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
    json_integer(&t, "format", 1);
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
