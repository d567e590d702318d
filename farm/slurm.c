#include "farm/slurm.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/atomic_file.h"
#include "base/child.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/version.h"
#include "farm/command.h"
#include "farm/slurm_jobs.h"

/* How long before its time limit a task is told, in seconds; more is no signal time to Slurm. */
enum { NOTICE_S = 180, NOTICE_MOST_S = 65535 };

/* Tasks of one kind from one block: an array, unless it is one. */
struct batch {
    size_t first, n;
    const struct farm_task *task; /* the first */
    char name[80];                /* "w0001.still.1001-1050": of the block */
    struct path script;
};

/* ---- the script */

/* What a task of the batch is, by its place in the array. */
static status put_cases(const struct farm *f, const struct slurm_options *o, const struct batch *b,
                        struct text *t)
{
    status st = OK;
    struct farm_command *c = NULL;
    struct path log;
    TRY(memory_alloc(1, sizeof *c, "a command", &c));
    text_add(t, "case ${SLURM_ARRAY_TASK_ID:-0} in\n");
    for (size_t i = 0; i < b->n; i++) {
        const struct farm_task *task = &b->task[i];
        TRY(farm_command(f, task, o->device ? o->device : "slurm", 0, c));
        TRY(farm_log_path(f, task, &log));
        text_add(t, "%zu)\n    task=%s\n    log=", i, task->name);
        farm_quote(t, log.text);
        text_add(t, "\n    set --");
        for (size_t k = 0; k < c->n; k++) {
            text_add(t, " ");
            farm_quote(t, c->argv[k]);
        }
        text_add(t, "\n    ;;\n");
    }
    text_add(t, "*)\n    echo \"no task $SLURM_ARRAY_TASK_ID here\" >&2\n    exit %d\n    ;;\nesac\n",
             E_USAGE);
    TRY(text_status(t));
done:
    free(c);
    return st;
}

/* Slurm signals the batch script alone: USR1 before the time limit (--signal=B:), TERM when it cancels,
 * preempts or requeues. After TERM Slurm decides what comes next; else the script does. A wait that a signal
 * ends is begun again. */
static const char body[] =
    "say() { echo \"$(date +%Y-%m-%dT%H:%M:%S) hoodoo farm: $task on $(hostname): $*\"; }\n"
    "id=${SLURM_ARRAY_JOB_ID:+${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID}\n"
    "id=${id:-$SLURM_JOB_ID}\n"
    "pid= got= term=\n"
    "pass() { got=1; [ -z \"$pid\" ] || kill -TERM \"$pid\" 2>/dev/null; }\n"
    "trap 'pass' USR1\n"
    "trap 'term=1; pass' TERM INT\n"
    "exec >>\"$log\" 2>&1\n"
    "say \"job $id, start $((${SLURM_RESTART_COUNT:-0} + 1)), GPU ${SLURM_JOB_GPUS:-none}\"\n"
    "\"$@\" &\n"
    "pid=$!\n"
    "[ -z \"$got\" ] || kill -TERM \"$pid\" 2>/dev/null\n"
    "while :; do\n"
    "    got=\n"
    "    wait \"$pid\"\n"
    "    rc=$?\n"
    "    [ -n \"$got\" ] || break\n"
    "done\n"
    "case $rc in\n"
    "0)\n"
    "    rm -f \"$log.failed\"\n"
    "    say done\n"
    "    exit 0\n"
    "    ;;\n"
    "85)\n"
    "    [ -z \"$term\" ] || { say \"saved and stopped, as Slurm asked\"; exit 85; }\n"
    "    say \"saved and stopped; queued again\"\n"
    "    ;;\n"
    "2 | 7 | 8)\n"
    "    say \"failed for good: exit $rc\"\n"
    "    exit \"$rc\"\n"
    "    ;;\n"
    "*)\n"
    "    [ -z \"$term\" ] || { say \"stopped by Slurm: exit $rc\"; exit \"$rc\"; }\n"
    "    echo \"$rc\" >>\"$log.failed\"\n"
    "    n=$(wc -l <\"$log.failed\")\n"
    "    [ \"$n\" -le \"$retries\" ] || { say \"failed $n times, the last with exit $rc\"; rm -f \"$log.failed\"; exit \"$rc\"; }\n"
    "    say \"exit $rc; queued again (try $((n + 1)) of $((retries + 1)))\"\n"
    "    ;;\n"
    "esac\n"
    "scontrol requeue \"$id\" || say \"scontrol could not: left to RequeueExit=85\"\n"
    "exit 85\n";

static status write_script(const struct farm *f, const struct slurm_options *o, const struct batch *b)
{
    status st = OK;
    struct text t = {0};
    text_add(
        &t,
        "#!/bin/bash\n# Written by hoodoo %s submit --to slurm. Safe to run again: what is done is not done twice.\nretries=%d\n",
        hoodoo_version, (int)farm_job(f, b->task)->farm.retries);
    TRY(put_cases(f, o, b, &t));
    text_add(&t, "%s", body);
    TRY(text_status(&t));
    TRY(atomic_file_write(b->script.text, t.data, t.size));
done:
    text_free(&t);
    return st;
}

/* ---- sbatch's words */

/* A path as sbatch takes one for --output: % begins a pattern there. A backslash switches patterns off, and the
 * file is not found then. */
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

struct words {
    const char *argv[80];
    size_t n;
    struct text own[8];
    size_t n_own;
};

static void word(struct words *w, const char *text)
{
    w->argv[w->n++] = text;
    w->argv[w->n] = NULL;
}

static struct text *made(struct words *w)
{
    return &w->own[w->n_own++];
}

static void words_of(const struct farm *f, const struct slurm_options *o, const struct batch *b,
                     const char *dependency, struct words *w)
{
    struct text *t = NULL;
    const struct farm_task *task = b->task;
    word(w, "sbatch");
    word(w, "--parsable");
    t = made(w);
    text_add(t, "--job-name=%s.%s", f->base->name, b->name);
    word(w, t->data ? t->data : "");
    /* What the script itself says goes to the task's log; this is for what Slurm has to say. */
    t = made(w);
    text_add(t, "--output=");
    put_pattern(t, f->root.text);
    word(w, t->data ? t->data : "");
    word(w, "--open-mode=append");
    word(w, "--requeue");
    t = made(w);
    text_add(
        t, "--signal=B:USR1@%d",
        farm_notice_seconds(f->wedge, task->kind == FARM_SIM ? f->n_wedges : 0, NOTICE_S, NOTICE_MOST_S));
    word(w, t->data ? t->data : "");
    word(w, "--nodes=1");
    word(w, "--ntasks=1");
    if (farm_wants_gpu(task->kind, o->device))
        word(w, "--gres=gpu:1");
    if (b->n > 1) {
        t = made(w);
        text_add(t, "--array=0-%zu", b->n - 1);
        word(w, t->data ? t->data : "");
    }
    if (dependency && *dependency) {
        t = made(w);
        text_add(t, "--dependency=afterok%s", dependency);
        word(w, t->data ? t->data : "");
        word(w, "--kill-on-invalid-dep=yes");
    }
    for (size_t i = 0; i < o->n_extra && w->n < 70; i++)
        word(w, o->extra[i]);
    word(w, b->script.text);
}

static status words_status(const struct words *w)
{
    status st = OK;
    for (size_t i = 0; i < w->n_own && st == OK; i++)
        st = text_status(&w->own[i]);
    return st;
}

/* ---- batches */

/* Tasks that stand together, of one kind and wedge, and wait for the same ones. */
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

/* ":12:13" of the jobs that the batch waits for; those done already are no jobs. Each once. */
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

static status call_sbatch(const struct words *w, const char *name, char id[SLURM_ID])
{
    status st = OK;
    struct text answer = {0};
    char said[512];
    int code = 0;
    TRY(child_ask(w->argv, SLURM_ANSWER_S, &answer, said, &code));
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

static void describe(const struct batch *b, const struct words *w, const char *id, bool dry_run,
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

/* One batch: its script, sbatch, and the ids of its tasks. `place` is a made-up id of a dry run. */
static status submit_batch(const struct farm *f, const struct slurm_options *o, const struct batch *b,
                           char (*job)[SLURM_ID], size_t place, struct text *out)
{
    status st = OK;
    struct words w = {0};
    struct text dependency = {0};
    char id[SLURM_ID] = "";
    put_dependency(f, b, job, &dependency);
    words_of(f, o, b, dependency.data, &w);
    TRY(words_status(&w));
    if (o->dry_run) {
        snprintf(id, sizeof id, "%zu", place + 1);
    } else {
        TRY(write_script(f, o, b));
        TRY(call_sbatch(&w, b->name, id));
        log_info("%s: job %s%s", b->name, id, b->n > 1 ? " (an array)" : "");
    }
    for (size_t i = 0; i < b->n; i++)
        if (b->n > 1)
            snprintf(job[b->first + i], SLURM_ID, "%.24s_%zu", id, i);
        else
            snprintf(job[b->first + i], SLURM_ID, "%.24s", id);
    describe(b, &w, id, o->dry_run, out);
done:
    for (size_t i = 0; i < w.n_own; i++)
        text_free(&w.own[i]);
    text_free(&dependency);
    return st;
}

status slurm_submit(const struct farm *f, const struct slurm_options *o, struct text *out)
{
    status st = OK;
    const struct farm_graph *g = &f->graph;
    char(*job)[SLURM_ID] = NULL;
    struct path path;
    bool *todo = NULL;
    size_t n_done = 0, n_queued = 0, n_batches = 0;
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
    for (size_t i = 0; i < g->n; i++) {
        bool done = true;
        for (size_t k = 0; k < g->task[i].n_after; k++)
            done = done && !todo[g->after[g->task[i].after + k]] && !*job[g->after[g->task[i].after + k]];
        if (done)
            TRY(farm_task_done(f, &g->task[i], &done));
        todo[i] = !done && !*job[i];
        n_done += done;
        n_queued += *job[i] != '\0';
    }
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
        /* What is queued is known, also when the rest was refused. */
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
    json_integer(out, "done_already", (int64_t)n_done);
    json_integer(out, "queued_already", (int64_t)n_queued);
done:
    free(job);
    free(todo);
    free(b);
    return st;
}
