#include "farm/local.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>

#include "base/clock.h"
#include "base/cores.h"
#include "base/log.h"
#include "base/memory.h"
#include "farm/command.h"
#include "farm/schedule.h"
#include "farm/tries.h"
#include "gpu/gpu.h"
#include "system/child.h"

enum { PAUSE_S = 1 };

/* How long a stop request may go unnoticed if its signal came to another thread, and how far a pause may overrun. */
static const double POLL_S = 0.1;

/* ---- workers */

static void add_cpu_workers(struct local_worker out[LOCAL_WORKERS], size_t *n)
{
    /* Workers for stills and meshes have four cores each; one core is left to each GPU's own process. */
    int left = cores() - (int)*n, k = left / 4 > 1 ? left / 4 : 1;
    for (int i = 0; i < k && *n < LOCAL_WORKERS; i++)
        out[(*n)++] = (struct local_worker){.others = true, .threads = left > 4 ? left / k : 1};
}

static status workers_named(const char *gpus, struct local_worker out[LOCAL_WORKERS], size_t *n)
{
    for (const char *s = gpus;; s++) {
        size_t length = strcspn(s, ",");
        if (length == 0 || length >= sizeof out[0].device || *n == LOCAL_WORKERS)
            return fail(E_USAGE, "--gpus %.80s: write devices with commas between, such as 0,1 (at most %d)",
                        gpus, LOCAL_WORKERS);
        out[*n] = (struct local_worker){.sims = true, .threads = 1};
        memcpy(out[(*n)++].device, s, length);
        s += length;
        if (!*s)
            return OK;
    }
}

static status workers_found(struct local_worker out[LOCAL_WORKERS], size_t *n)
{
    struct gpu_info *info = NULL;
    size_t n_devices;
    status st = gpu_list(&info, &n_devices);
    for (size_t i = 0; st == OK && i < n_devices && *n < LOCAL_WORKERS / 2; i++)
        if (info[i].usable && !info[i].is_cpu) {
            out[*n] = (struct local_worker){.sims = true, .threads = 1};
            snprintf(out[(*n)++].device, sizeof out[0].device, "%d", info[i].index);
        }
    free(info);
    return st;
}

status local_workers(const char *gpus, int workers, struct local_worker out[LOCAL_WORKERS], size_t *n)
{
    status st = OK;
    *n = 0;
    if (gpus && workers)
        return fail(E_USAGE, "--gpus and --workers: give one of the two");
    if (workers < 0 || workers > LOCAL_WORKERS)
        return fail(E_USAGE, "--workers %d: 1 to %d", workers, LOCAL_WORKERS);
    if (gpus)
        TRY(workers_named(gpus, out, n));
    else if (!workers)
        TRY(workers_found(out, n));
    if (*n > 0) {
        add_cpu_workers(out, n);
        return OK;
    }
    for (int i = 0; i < (workers ? workers : 1); i++) {
        int threads = cores() / (workers ? workers : 1);
        out[*n] = (struct local_worker){.sims = true, .others = true, .threads = threads > 1 ? threads : 1};
        snprintf(out[(*n)++].device, sizeof out[0].device, "cpu");
    }
done:
    return st;
}

/* ---- tasks */

enum task_state { WAITING, RUNNING, DONE, FAILED, LEFT_OUT };

struct task {
    enum task_state state;
    int tries;
    double not_before; /* a pause before the next try */
    bool checked;      /* its files have been looked at */
};

struct worker {
    size_t task;
    double since;
};

struct local {
    const struct farm *farm;
    const struct local_options *options;
    struct task *task;
    size_t *order; /* of tasks, the most urgent first */
    struct worker worker[LOCAL_WORKERS];
    struct child child[LOCAL_WORKERS]; /* of each worker; pid 0: idle */
    struct local_state state;
    bool stopping;
    int code; /* of the first task that failed */
    size_t first_failed;
};

static void report(struct local *l, enum local_news what, size_t task, int worker, double seconds,
                   const char *why)
{
    if (l->options->news)
        l->options->news(l->options->user, what, &l->farm->graph.task[task], worker, seconds, why);
}

/* Appends a line to the task's log, between what its tries write. Never fails: a task whose log cannot be opened fails by itself. */
static void log_line(const struct local *l, size_t task, const char *format, ...)
{
    const struct farm_task *t = &l->farm->graph.task[task];
    struct path path;
    FILE *file;
    char now[32];
    const time_t seconds = time(NULL);
    struct tm tm;
    va_list list;
    if (farm_log_path(l->farm, t, &path) != OK || !(file = fopen(path.text, "ae")))
        return;
    strftime(now, sizeof now, "%Y-%m-%dT%H:%M:%S%z", localtime_r(&seconds, &tm));
    fprintf(file, "%s hoodoo farm: %s: ", now, t->name);
    va_start(list, format);
    vfprintf(file, format, list);
    va_end(list);
    fputc('\n', file);
    fclose(file);
}

static status start(struct local *l, size_t task, int k)
{
    status st = OK;
    const struct farm_task *t = &l->farm->graph.task[task];
    const struct local_worker *w = &l->options->worker[k];
    struct farm_command *command = NULL;
    struct path log;
    char threads[32];
    TRY(memory_alloc(1, sizeof *command, "a command", &command));
    TRY(farm_command(l->farm, t, *w->device ? w->device : NULL, w->threads, command));
    TRY(farm_log_path(l->farm, t, &log));
    snprintf(threads, sizeof threads, "%d", w->threads);
    bool cpu = strcmp(w->device, "cpu") == 0;
    const struct child_variable variables[] = {{"OMP_NUM_THREADS", threads},
                                               {cpu ? "LP_NUM_THREADS" : NULL, threads}};
    const struct child_options options = {.argv = command->argv,
                                          .log = log.text,
                                          .variable = variables,
                                          .n_variables = 2,
                                          .death_signal = SIGTERM};
    log_line(l, task, "try %d, worker %d, device %s", l->task[task].tries + 1, k,
             *w->device ? w->device : "auto");
    if (l->task[task].tries == 0)
        TRY(tries_add(l->farm, t, "submitted"));
    TRY(tries_add_start(l->farm, t, ""));
    TRY(child_start(&options, &l->child[k]));
    l->worker[k].task = task;
    l->worker[k].since = clock_seconds();
    l->task[task].state = RUNNING;
    l->task[task].tries++;
    l->state.running++;
    l->state.task[k] = t;
    l->state.running_since[k] = l->worker[k].since;
    report(l, LOCAL_STARTED, task, k, 0, "");
done:
    free(command);
    return st;
}

static void finish(struct local *l, int k, int how)
{
    struct worker *w = &l->worker[k];
    struct task *task = &l->task[w->task];
    const struct farm_task *t = &l->farm->graph.task[w->task];
    double took = clock_seconds() - w->since;
    struct path log;
    char why[600] = "", meaning[160];
    int code = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
    l->state.running--;
    l->state.task[k] = NULL;
    log_line(l, w->task, "exit %d after %.0f s: %s", code, took, farm_exit_meaning(code, meaning));
    if (tries_add_end(l->farm, t, code, took) != OK)
        log_warn("%s", status_message());
    if (code == 0) {
        task->state = DONE;
        l->state.done++;
        report(l, LOCAL_DONE, w->task, k, took, "");
        return;
    }
    if (l->stopping) {
        /* Whatever the exit code, the same command continues from here. */
        task->state = WAITING;
        report(l, LOCAL_SAVED, w->task, k, took, "");
        return;
    }
    if (farm_log_path(l->farm, t, &log) == OK)
        child_reason(how, log.text, why, sizeof why);
    task->not_before = clock_seconds() + PAUSE_S * task->tries;
    if (code == STOPPED) {
        task->tries--; /* someone stopped this task alone, which is not a failure */
        task->state = WAITING;
        report(l, LOCAL_AGAIN, w->task, k, took, why);
    } else if (farm_final(code) || code == CHILD_NO_PROGRAM || task->tries > farm_retries(l->farm, t)) {
        task->state = FAILED;
        l->state.failed++;
        if (!l->code) {
            l->code = code;
            l->first_failed = w->task;
        }
        report(l, LOCAL_FAILED, w->task, k, took, why);
    } else {
        task->state = WAITING;
        report(l, LOCAL_AGAIN, w->task, k, took, why);
    }
}

/* Whether the task can start. It is left out if a task that it waits for failed, and done if its files are complete. The task that ends the
 * job waits for the others' ends alone. */
static status ready(struct local *l, size_t i, bool *yes)
{
    status st = OK;
    const struct farm_graph *g = &l->farm->graph;
    struct task *task = &l->task[i];
    *yes = false;
    for (size_t k = 0; k < g->task[i].n_after; k++) {
        enum task_state before = l->task[g->after[g->task[i].after + k]].state;
        const bool failed = before == FAILED || before == LEFT_OUT;
        if (failed && g->task[i].kind == FARM_END)
            continue;
        if (failed) {
            task->state = LEFT_OUT;
            l->state.left_out++;
            report(l, LOCAL_LEFT_OUT, i, -1, 0, g->task[g->after[g->task[i].after + k]].name);
            return OK;
        }
        if (before != DONE)
            return OK;
    }
    if (!task->checked) {
        bool done;
        task->checked = true;
        TRY(farm_task_done(l->farm, &g->task[i], &done));
        if (done) {
            task->state = DONE;
            l->state.done++;
            l->state.already++;
            return OK;
        }
    }
    *yes = clock_seconds() >= task->not_before;
done:
    return st;
}

/* Starts ready tasks on idle workers: those that use a device first, and the most urgent of each, so that wedges advance together. */
static status start_ready(struct local *l)
{
    status st = OK;
    const struct farm_graph *g = &l->farm->graph;
    for (int others = 0; others < 2; others++)
        for (size_t place = 0; place < g->n; place++) {
            const size_t i = l->order[place];
            bool sim = farm_kinds[g->task[i].kind].device, yes;
            if (l->task[i].state != WAITING || sim == (others == 1))
                continue;
            TRY(ready(l, i, &yes));
            for (size_t k = 0; yes && k < l->options->n_workers; k++) {
                const struct local_worker *w = &l->options->worker[k];
                if (l->child[k].pid == 0 && (sim ? w->sims : w->others)) {
                    TRY(start(l, i, (int)k));
                    break;
                }
            }
        }
done:
    return st;
}

static void stop_all(struct local *l)
{
    l->stopping = true;
    for (size_t k = 0; k < l->options->n_workers; k++)
        if (l->child[k].pid)
            kill(l->child[k].pid, SIGTERM);
}

/* Handles the tasks that have ended or end within `seconds`; true if there are any. */
static bool reap(struct local *l, double seconds)
{
    const size_t n = l->options->n_workers;
    bool any = false;
    int how = 0;
    for (size_t k; (k = child_wait(l->child, n, any ? 0 : seconds, &how)) < n; any = true)
        finish(l, (int)k, how);
    return any;
}

static status verdict(const struct local *l)
{
    struct path log;
    if (l->stopping)
        return fail(STOPPED, "stopped with %zu of %zu tasks done; run the same command again to continue",
                    l->state.done, l->state.total);
    if (l->code == 0)
        return OK;
    const struct farm_task *t = &l->farm->graph.task[l->first_failed];
    status st = farm_log_path(l->farm, t, &log);
    if (st != OK)
        return st;
    st = E_OUTPUT;
#define KNOWN(name, value, text) st = l->code == (value) ? name : st;
    STATUS_MAP(KNOWN)
#undef KNOWN
    return fail(
        st,
        "%zu of %zu tasks failed and %zu that wait for them were left out; the first was %s: see %s, then run the same command again",
        l->state.failed, l->state.total, l->state.left_out, t->name, log.text);
}

status local_run(const struct farm *f, const struct local_options *options)
{
    status st = OK;
    struct local l = {.farm = f, .options = options, .state = {.total = f->graph.n}};
    double ticked = 0, wait = 0;
    TRY(memory_alloc(f->graph.n, sizeof *l.task, "the tasks", &l.task));
    TRY(schedule_order(&f->graph, &l.order));
    for (size_t i = 0; i < f->graph.n; i++)
        if (f->chosen && !f->chosen[i]) {
            l.task[i].state = DONE; /* what chosen tasks wait for is done: farm_choose() */
            l.state.total--;
        }
    for (;;) {
        bool any = reap(&l, wait);
        if (!l.stopping && options->stop && options->stop())
            stop_all(&l);
        if (!l.stopping && st == OK && (st = start_ready(&l)) != OK)
            stop_all(&l);
        size_t over = l.state.done + l.state.failed + l.state.left_out;
        if (l.state.running == 0 && (l.stopping || over == l.state.total))
            break;
        if (options->tick && (any || clock_seconds() - ticked > 1)) {
            options->tick(options->user, &l.state);
            ticked = clock_seconds();
        }
        wait = POLL_S;
    }
    if (options->tick)
        options->tick(options->user, &l.state);
    if (st == OK)
        st = verdict(&l);
done:
    free(l.task);
    free(l.order);
    return st;
}
