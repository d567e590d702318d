#include "farm/slurm.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/log.h"
#include "base/memory.h"
#include "farm/argv.h"
#include "farm/command.h"
#include "farm/needs.h"
#include "farm/slurm_jobs.h"
#include "farm/slurm_script.h"
#include "farm/tries.h"
#include "system/atomic_file.h"
#include "system/child.h"

/* Slurm counts memory in MiB and time limits in minutes. */
enum { MIB = 1 << 20, MINUTE_S = 60 };

/* Tasks of one kind from one block: an array, unless it is one task. */
struct batch {
    size_t first, n;
    const struct farm_task *task; /* the first */
    char name[80];                /* "w0001.still.1001-1050": of the block */
    struct path script;
};

static const char *device_of(const struct slurm_options *o)
{
    return o->device ? o->device : "slurm";
}

static status write_script(const struct farm *f, const struct slurm_options *o, const struct batch *b)
{
    status st = OK;
    struct text t = {0};
    TRY(slurm_script(f, b->task, b->n, device_of(o), &t));
    TRY(atomic_file_write(b->script.text, t.data, t.size));
done:
    text_free(&t);
    return st;
}

/* ---- sbatch's arguments */

/* A path for --output, where % begins a pattern. A backslash would switch patterns off and change the path. */
static void put_pattern(struct text *t, const char *root)
{
    if (strchr(root, '\\')) {
        text_add(t, "/dev/null");
        return;
    }
    for (const char *s = root; *s; s++)
        text_add(t, *s == '%' ? "%%%%" : "%c", *s);
    text_add(t, "/log/farm/slurm.out");
}

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* The user's arguments. Those about mail are for the job that ends the others: one mail, not one for every task. */
static void add_extra(const struct slurm_options *o, bool end, struct argv_list *a)
{
    for (size_t i = 0; i < o->n_extra; i++) {
        const char *text = o->extra[i];
        const bool mail = begins(text, "--mail-type") || begins(text, "--mail-user");
        const bool pair = mail && !strchr(text, '=') && i + 1 < o->n_extra;
        if (!mail || end) {
            argv_add(a, "%s", text);
            if (pair)
                argv_add(a, "%s", o->extra[i + 1]);
        }
        i += pair;
    }
}

static status sbatch_arguments(const struct farm *f, const struct slurm_options *o, const struct batch *b,
                               const char *dependency, struct argv_list *a)
{
    status st = OK;
    struct text output = {0};
    struct farm_needs needs;
    const bool end = b->task->kind == FARM_END;
    const struct job_tasks *keys = farm_requests(farm_job(f, b->task), b->task->kind);
    farm_needs(f, b->task, device_of(o), &needs);
    put_pattern(&output, f->root.text);
    TRY(text_status(&output));
    argv_add(a, "sbatch");
    argv_add(a, "--parsable");
    argv_add(a, "--job-name=%s.%s", f->base->name, b->name);
    /* The task's log holds what the script prints; this file is for Slurm's own messages. */
    argv_add(a, "--output=%s", output.data);
    argv_add(a, "--open-mode=append");
    argv_add(a, "--requeue");
    argv_add(a, "--signal=B:USR1@%d", needs.notice_s);
    argv_add(a, "--nodes=1");
    argv_add(a, "--ntasks=1");
    argv_add(a, "--cpus-per-task=%d", needs.cpus);
    argv_add(a, "--mem=%lldM", (long long)farm_units(needs.memory_bytes, MIB));
    if (needs.limit_s)
        argv_add(a, "--time=%lld", (long long)farm_units((uint64_t)needs.limit_s, MINUTE_S));
    if (needs.gpu)
        argv_add(a, "--gres=gpu:1");
    if (b->n > 1)
        argv_add(a, "--array=0-%zu", b->n - 1);
    if (dependency && *dependency) {
        argv_add(a, "--dependency=%s%s", end ? "afterany" : "afterok", dependency);
        if (!end)
            argv_add(a, "--kill-on-invalid-dep=yes");
    }
    for (size_t i = 0; i < keys->n_sbatch; i++)
        argv_add(a, "%s", keys->sbatch[i]);
    add_extra(o, end, a);
    argv_add(a, "%s", b->script.text);
    TRY(argv_status(a));
done:
    text_free(&output);
    return st;
}

/* ---- batches */

/* Whether two neighbours in the graph are of one kind and wedge and wait for the same task. */
static bool alike(const struct farm_graph *g, const struct farm_task *a, const struct farm_task *b)
{
    return a->kind == b->kind && a->show == b->show && a->wedge == b->wedge && a->kind != FARM_SIM &&
           farm_kind_is_cut(a->kind) && a->n_after == 1 && b->n_after == 1 &&
           g->after[a->after] == g->after[b->after];
}

/* `todo` is which tasks are left; the batch is the run of them from `first` on. */
static status next_batch(const struct farm *f, const bool *todo, size_t first, struct batch *b)
{
    enum { ARRAY_MAX = 1000 }; /* MaxArraySize is 1001 unless the site says more */
    const struct farm_graph *g = &f->graph;
    *b = (struct batch){.first = first, .n = 1, .task = &g->task[first]};
    while (first + b->n < g->n && b->n < ARRAY_MAX && todo[first + b->n] &&
           alike(g, b->task, &g->task[first + b->n]))
        b->n++;
    snprintf(b->name, sizeof b->name, "%s", b->task->name);
    if (b->n > 1) {
        char *range = strrchr(b->name, '.');
        const struct farm_task *last = &b->task[b->n - 1];
        struct frame_range all = {b->task->frames.first, last->frames.last, 1};
        if (farm_kinds[b->task->kind].cut == CUT_VIEWS)
            all = (struct frame_range){b->task->views.first, last->views.last, 1};
        char text[48];
        snprintf(range + 1, sizeof b->name - (size_t)(range + 1 - b->name), "%s", range_text(all, text));
    }
    return path_format(&b->script, "%s/farm/slurm/%s.sh", f->root.text, b->name);
}

/* ":12:13": the jobs that the batch waits for, each once. Tasks that are done have no job. */
static void put_dependency(const struct farm *f, const struct batch *b, char (*job)[SLURM_ID], struct text *t)
{
    const struct farm_graph *g = &f->graph;
    const char *last = "";
    for (size_t k = 0; k < b->task->n_after; k++) {
        const char *id = job[g->after[b->task->after + k]];
        size_t n = strcspn(id, "_"); /* the whole array */
        if (n == 0 || (strlen(last) >= n && strncmp(last, id, n) == 0 && !isdigit((unsigned char)last[n])))
            continue;
        text_add(t, ":%.*s", (int)n, id);
        last = id;
    }
    if (!t->data)
        text_add(t, "%s", "");
}

static status call_sbatch(const struct argv_list *a, const char *name, char id[SLURM_ID])
{
    status st = OK;
    struct text answer = {0};
    char said[512];
    int code = 0;
    TRY(child_ask((const char *const *)a->argv, SLURM_ANSWER_S, &answer, said, &code));
    size_t n = answer.data ? strspn(answer.data, "0123456789") : 0;
    if (code == 127)
        st = fail(E_INPUT, "sbatch is not installed here; submit from a machine of the cluster");
    else if (code != 0 || n == 0 || n >= 24)
        st = fail(E_OUTPUT, "sbatch refused %s (exit %d): %s", name, code, said);
    else
        snprintf(id, SLURM_ID, "%.*s", (int)n, answer.data);
done:
    text_free(&answer);
    return st;
}

static void describe(const struct batch *b, const struct argv_list *w, const char *id, bool dry_run,
                     struct text *out)
{
    json_object(out, NULL);
    json_text(out, "name", b->name);
    json_integer(out, "tasks", (int64_t)b->n);
    if (!dry_run)
        json_text(out, "job", id);
    struct text line = {0};
    for (size_t i = 0; dry_run && i < w->n; i++) {
        text_add(&line, i ? " " : "");
        if (w->argv[i][strspn(w->argv[i],
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=./:,@%")])
            farm_quote(&line, w->argv[i]);
        else
            text_add(&line, "%s", w->argv[i]);
    }
    if (dry_run)
        json_text(out, "command", line.data ? line.data : "");
    text_free(&line);
    json_end_object(out);
}

/* Writes the script of a batch, calls sbatch and stores the ids of its tasks. `place` makes up an id in a dry run. */
static status submit_batch(const struct farm *f, const struct slurm_options *o, const struct batch *b,
                           char (*job)[SLURM_ID], size_t place, struct text *out)
{
    status st = OK;
    struct argv_list a = {0};
    struct text dependency = {0};
    char id[SLURM_ID] = "";
    put_dependency(f, b, job, &dependency);
    TRY(text_status(&dependency));
    TRY(sbatch_arguments(f, o, b, dependency.data, &a));
    if (o->dry_run) {
        snprintf(id, sizeof id, "%zu", place + 1);
    } else {
        TRY(write_script(f, o, b));
        for (size_t i = 0; i < b->n; i++)
            TRY(tries_add(f, &b->task[i], "submitted"));
        TRY(call_sbatch(&a, b->name, id));
        log_info("%s: job %s%s", b->name, id, b->n > 1 ? " (an array)" : "");
    }
    for (size_t i = 0; i < b->n; i++)
        if (b->n > 1)
            snprintf(job[b->first + i], SLURM_ID, "%.24s_%zu", id, i);
        else
            snprintf(job[b->first + i], SLURM_ID, "%.24s", id);
    describe(b, &a, id, o->dry_run, out);
done:
    argv_free(&a);
    text_free(&dependency);
    return st;
}

/* Decides which tasks to submit: those that are neither done nor queued, of the chosen ones. */
static status find_work(const struct farm *f, const struct slurm_options *o, char (*job)[SLURM_ID],
                        bool *todo, struct text *out)
{
    status st = OK;
    const struct farm_graph *g = &f->graph;
    size_t n_done = 0, n_queued = 0, n_todo = 0;
    for (size_t i = 0; i < g->n; i++) {
        const bool end = g->task[i].kind == FARM_END;
        bool done = true;
        /* A task is not done before what it waits for. */
        for (size_t k = 0; k < g->task[i].n_after; k++)
            done = done && !todo[g->after[g->task[i].after + k]] && !*job[g->after[g->task[i].after + k]];
        if (done)
            TRY(farm_task_done(f, &g->task[i], &done));
        /* The job that ends the others must wait for the new ones too: it is submitted again. */
        if (end && *job[i] && n_todo) {
            if (!o->dry_run)
                TRY(slurm_cancel((const char(*)[SLURM_ID]) & job[i], 1));
            *job[i] = '\0';
        }
        todo[i] = !done && !*job[i] && (!f->chosen || f->chosen[i]);
        n_todo += todo[i];
        n_done += done;
        n_queued += *job[i] != '\0';
    }
    json_integer(out, "done_already", (int64_t)n_done);
    json_integer(out, "queued_already", (int64_t)n_queued);
done:
    return st;
}

/* Programs that are not on this machine. A node may have them all the same, and a prologue's container has a disk of its own. */
static void warn_of_programs(const struct farm *f)
{
    const char *last = "";
    for (int k = 0; k < FARM_KINDS; k++) {
        const struct command_head head = command_head(f->base, (enum farm_kind)k, f->hoodoo.text);
        if (head.n_prologue || !strchr(head.hoodoo, '/') || strcmp(head.hoodoo, last) == 0 ||
            access(head.hoodoo, X_OK) == 0)
            continue;
        log_warn("%s: %s; nodes that cannot run it are excluded, and tasks fail if no node is left",
                 head.hoodoo, strerror(errno));
        last = head.hoodoo;
    }
}

status slurm_submit(const struct farm *f, const struct slurm_options *o, struct text *out)
{
    status st = OK;
    const struct farm_graph *g = &f->graph;
    char(*job)[SLURM_ID] = NULL;
    struct path path;
    bool *todo = NULL;
    size_t n_batches = 0;
    struct batch *b = NULL;
    TRY(memory_alloc(g->n, sizeof *job, "the jobs", &job));
    TRY(memory_alloc(g->n, sizeof *todo, "the jobs", &todo));
    TRY(memory_alloc(1, sizeof *b, "the jobs", &b));
    if (!o->dry_run) {
        TRY(path_join(&path, f->root.text, "farm/slurm"));
        TRY(folder_make(path.text));
        atomic_file_sweep(path.text);
        TRY(slurm_active(f, job));
    }
    TRY(find_work(f, o, job, todo, out));
    warn_of_programs(f);
    json_array(out, o->dry_run ? "would_submit" : "submitted");
    for (size_t i = 0; i < g->n; i += todo[i] ? b->n : 1) {
        if (!todo[i])
            continue;
        TRY(next_batch(f, todo, i, b));
        st = submit_batch(f, o, b, job, n_batches++, out);
        if (o->dry_run) {
            TRY(st);
            continue;
        }
        /* Record the jobs already queued even if sbatch refused a later one. */
        if (st != OK || i + b->n >= g->n || n_batches % 16 == 0) {
            char why[800];
            snprintf(why, sizeof why, "%s", status_message());
            status written = slurm_remember(f, job);
            if (st != OK) {
                fail(st, "%s", why);
                goto done;
            }
            TRY(written);
        }
    }
    if (!o->dry_run)
        TRY(slurm_remember(f, job));
    json_end_array(out);
done:
    free(job);
    free(todo);
    free(b);
    return st;
}
