#include "farm/farm.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "farm/command.h"
#include "farm/end.h"
#include "farm/submission.h"
#include "output/folder.h"
#include "run/branch.h"
#include "run/owner.h"
#include "run/timing.h"
#include "system/atomic_file.h"
#include "system/beside.h"
#include "text/nearest.h"

static status set_paths(struct farm *f, const char *out)
{
    status st = OK;
    struct path here, relative;
    char self[BESIDE_PATH];
    if (!beside_self(self))
        return fail(E_OUTPUT, "the path of this program is not known (/proc/self/exe) or too long");
    TRY(path_format(&f->hoodoo, "%s", self));
    TRY(out ? path_format(&relative, "%s", out) : path_join(&relative, "out", f->base->name));
    if (!getcwd(here.text, sizeof here.text)) {
        st = fail(E_OUTPUT, "the current folder: %s", strerror(errno));
        goto done;
    }
    TRY(*relative.text == '/' ? path_format(&f->root, "%s", relative.text)
                              : path_join(&f->root, here.text, relative.text));
    TRY(folder_check_length(f->root.text));
done:
    return st;
}

/* Sets the first frame of a branch; with `from` (OUT@FRAME), the job becomes a branch that starts at that checkpoint. */
static status prepare(const struct farm *f, const char *from, struct job *job)
{
    status st = OK;
    struct path root;
    TRY(farm_root(f, (int)job->wedge.index, &root));
    if (from)
        TRY(branch_from(job, from, root.text));
    TRY(branch_prepare(job, root.text));
done:
    return st;
}

status farm_load(const char *path, const char *const *given, size_t n_given, const char *from, int only,
                 const char *out, struct farm *f)
{
    status st = OK;
    const char **sets = NULL;
    size_t n_sets = n_given;
    TRY(memory_alloc(n_given + 1, sizeof *sets, "the job", &sets));
    if (n_given)
        memcpy(sets, given, n_given * sizeof *sets);
    if (from)
        sets[n_sets++] = BRANCH_SET;
    TRY(job_load(path, sets, n_sets, &f->base));
    TRY(set_paths(f, out));
    TRY(prepare(f, from, f->base));
    size_t n = job_wedges(f->base);
    if (only && n == 0) {
        st = fail(E_USAGE, "--wedge %d: the job has no wedges", only);
        goto done;
    }
    f->n_wedges = only || n == 0 ? 1 : n;
    TRY(memory_alloc(f->n_wedges, sizeof *f->wedge, "the wedges", &f->wedge));
    for (size_t i = 0; i < f->n_wedges; i++) {
        struct farm_wedge *w = &f->wedge[i];
        if (n)
            TRY(job_load_wedge(path, sets, n_sets, f->base, only ? only : (int)i + 1, &w->job));
        else
            TRY(job_load(path, sets, n_sets, &w->job));
        TRY(command_check(w->job));
        TRY(prepare(f, from, w->job));
        TRY(model_estimate(w->job, &w->estimate));
    }
done:
    free(sets);
    return st;
}

status farm_graph(struct farm *f)
{
    graph_free(&f->graph);
    return graph_make(f->wedge, f->n_wedges, &f->graph);
}

void farm_free(struct farm *f)
{
    for (size_t i = 0; f->wedge && i < f->n_wedges; i++)
        job_destroy(&f->wedge[i].job);
    free(f->wedge);
    job_destroy(&f->base);
    graph_free(&f->graph);
    free(f->chosen);
    *f = (struct farm){0};
}

status farm_root(const struct farm *f, int wedge, struct path *out)
{
    return path_wedge(out, f->root.text, wedge);
}

const struct job *farm_job(const struct farm *f, const struct farm_task *t)
{
    for (size_t i = 0; i < f->n_wedges; i++)
        if (f->wedge[i].job->wedge.index == t->wedge)
            return f->wedge[i].job;
    return f->wedge[0].job;
}

status farm_log_path(const struct farm *f, const struct farm_task *t, struct path *out)
{
    return path_format(out, "%s/log/farm/%s.log", f->root.text, t->name);
}

status farm_measure(struct farm *f)
{
    status st = OK;
    struct path root;
    for (size_t i = 0; i < f->n_wedges; i++) {
        TRY(farm_root(f, (int)f->wedge[i].job->wedge.index, &root));
        TRY(timing_frame_seconds(root.text, &f->wedge[i].frame_seconds));
    }
done:
    return st;
}

status farm_open(const char *root, struct farm *f)
{
    status st = OK;
    struct path path;
    struct submission s = {0};
    TRY(path_join(&path, root, "farm/job.yaml"));
    if (access(path.text, F_OK) != 0) {
        st = fail(E_INPUT, "%s was not made by hoodoo submit: it has no farm/job.yaml", root);
        goto done;
    }
    TRY(submission_read(root, &s));
    TRY(farm_load(path.text, NULL, 0, NULL, s.wedge, root, f));
    TRY(farm_measure(f));
    TRY(farm_graph(f));
done:
    submission_free(&s);
    return st;
}

int farm_retries(const struct farm *f, const struct farm_task *t)
{
    return t->kind == FARM_END ? 0 : (int)farm_job(f, t)->farm.retries;
}

status farm_choose(struct farm *f, size_t task, const bool *active)
{
    status st = OK;
    const struct farm_graph *g = &f->graph;
    bool done;
    TRY(memory_alloc(g->n, sizeof *f->chosen, "the tasks", &f->chosen));
    TRY(farm_task_done(f, &g->task[task], &done));
    if (done || (active && active[task])) {
        st = fail(E_USAGE, "%s %s, so there is nothing to retry", g->task[task].name,
                  done ? "is done" : "waits or runs");
        goto done;
    }
    f->chosen[task] = true;
    for (size_t i = task; i < g->n; i++) {
        bool behind = i == task, ready = true;
        for (size_t k = 0; k < g->task[i].n_after; k++)
            behind |= f->chosen[g->after[g->task[i].after + k]];
        for (size_t k = 0; k < g->task[i].n_after && behind && ready; k++) {
            const size_t before = g->after[g->task[i].after + k];
            if (f->chosen[before] || (active && active[before]))
                continue;
            TRY(farm_task_done(f, &g->task[before], &ready));
            if (!ready && i == task) {
                st = fail(E_USAGE,
                          "%s waits for %s, which is not done: retry that one, or all with 'hoodoo retry %s'",
                          g->task[i].name, g->task[before].name, f->root.text);
                goto done;
            }
        }
        f->chosen[i] = behind && ready;
    }
done:
    return st;
}

status farm_find(const struct farm *f, const char *name, size_t *out)
{
    status st = OK;
    const char **names = NULL;
    TRY(memory_alloc(f->graph.n, sizeof *names, "the tasks", &names));
    for (size_t i = 0; i < f->graph.n; i++) {
        names[i] = f->graph.task[i].name;
        if (strcmp(names[i], name) == 0) {
            *out = i;
            goto done;
        }
    }
    const char *near = nearest_word(name, names, f->graph.n);
    st = fail(E_USAGE, "the job has no task '%.80s'%s%s; 'hoodoo plan' lists its tasks", name,
              near ? "; did you mean " : "", near ? near : "");
done:
    free(names);
    return st;
}

/* ---- what every task reads */

/* Refuses a folder of another job now, before each task would do so. */
static status check_owner(const struct farm *f, const struct job *job)
{
    struct path root, path;
    struct job *theirs = NULL;
    uint64_t ours, hash;
    status st = OK;
    TRY(farm_root(f, (int)job->wedge.index, &root));
    TRY(path_join(&path, root.text, "job.yaml"));
    if (access(path.text, F_OK) != 0)
        return OK;
    TRY(job_hash(job, &ours));
    const bool read = job_load(path.text, NULL, 0, &theirs) == OK &&
                      branch_prepare_own(theirs, root.text) == OK && job_hash(theirs, &hash) == OK;
    if (read && (hash != ours || strcmp(theirs->name, job->name) != 0))
        st = owner_refuse(root.text, path.text, theirs, job);
    else if (read)
        st = owner_check_files(root.text, theirs, job);
    else
        st =
            fail(E_CHECKPOINT,
                 "%s cannot be read, so it is not known what is in the folder; use another --out", path.text);
done:
    job_destroy(&theirs);
    return st;
}

status farm_freeze(struct farm *f)
{
    status st = OK;
    struct path path;
    char *real = NULL;
    struct text t = {0};
    static const char *const folders[] = {"", "/farm", "/log", "/log/farm"};
    for (size_t i = 0; i < f->n_wedges; i++)
        TRY(check_owner(f, f->wedge[i].job));
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        TRY(path_format(&path, "%s%s", f->root.text, folders[i]));
        TRY(folder_make(path.text));
    }
    folder_sweep(f->root.text);
    real = realpath(f->root.text, NULL);
    if (!real) {
        st = fail(E_OUTPUT, "%s: %s", f->root.text, strerror(errno));
        goto done;
    }
    TRY(path_format(&f->root, "%s", real));
    TRY(folder_check_length(f->root.text));
    TRY(job_resolved(f->base, &t));
    TRY(path_join(&path, f->root.text, "farm/job.yaml"));
    TRY(atomic_file_write(path.text, t.data, t.size));
    farm_end_reset(f);
done:
    free(real);
    text_free(&t);
    return st;
}
