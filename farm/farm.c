#include "farm/farm.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/memory.h"
#include "run/branch.h"

static status set_paths(struct farm *f, const char *out)
{
    ssize_t n = readlink("/proc/self/exe", f->hoodoo, sizeof f->hoodoo - 1);
    if (n < 0)
        return fail(E_OUTPUT, "/proc/self/exe: %s", strerror(errno));
    f->hoodoo[n] = '\0';
    char here[FARM_PATH], relative[FARM_PATH];
    int length = out ? snprintf(relative, sizeof relative, "%s", out)
                     : snprintf(relative, sizeof relative, "out/%s", f->base->name);
    if (length < 0 || (size_t)length >= sizeof relative || !getcwd(here, sizeof here))
        return fail(E_USAGE, "--out: the path is longer than %d bytes", FARM_PATH);
    length = *relative == '/' ? snprintf(f->root, sizeof f->root, "%s", relative)
                              : snprintf(f->root, sizeof f->root, "%s/%s", here, relative);
    if (length < 0 || (size_t)length >= sizeof f->root)
        return fail(E_USAGE, "--out: the path is longer than %d bytes", FARM_PATH);
    return OK;
}

/* A branch's own frames, and with --from its checkpoint. */
static status prepare(const struct farm *f, const char *from, struct job *job)
{
    status st = OK;
    char root[FARM_PATH + 16];
    farm_root(f, (int)job->wedge.index, root);
    if (from)
        TRY(branch_from(job, from, root));
    TRY(branch_prepare(job, root));
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
    *f = (struct farm){0};
}

void farm_root(const struct farm *f, int wedge, char out[FARM_PATH + 16])
{
    if (wedge)
        snprintf(out, FARM_PATH + 16, "%s/w%04d", f->root, wedge);
    else
        snprintf(out, FARM_PATH + 16, "%s", f->root);
}

const struct job *farm_job(const struct farm *f, const struct farm_task *t)
{
    for (size_t i = 0; i < f->n_wedges; i++)
        if (f->wedge[i].job->wedge.index == t->wedge)
            return f->wedge[i].job;
    return f->wedge[0].job;
}

void farm_log_path(const struct farm *f, const struct farm_task *t, char out[FARM_PATH + 128])
{
    snprintf(out, FARM_PATH + 128, "%s/log/farm/%s.log", f->root, t->name);
}

/* ---- what every task reads */

/* A run would refuse the folder later, task by task, at night. */
static status check_owner(const struct farm *f, const struct job *job)
{
    char root[FARM_PATH + 16], path[FARM_PATH + 32];
    struct job *theirs = NULL;
    uint64_t ours, hash;
    status st = OK;
    farm_root(f, (int)job->wedge.index, root);
    snprintf(path, sizeof path, "%s/job.yaml", root);
    if (access(path, F_OK) != 0)
        return OK;
    TRY(job_hash(job, &ours));
    if (job_load(path, NULL, 0, &theirs) != OK || branch_prepare_own(theirs, root) != OK ||
        job_hash(theirs, &hash) != OK || hash != ours || strcmp(theirs->name, job->name) != 0)
        st = fail(E_CHECKPOINT,
                  "%s holds another job (%s differs in what is simulated); use another --out, or remove the "
                  "folder",
                  root, path);
done:
    job_destroy(&theirs);
    return st;
}

status farm_freeze(struct farm *f)
{
    status st = OK;
    char path[FARM_PATH + 32], *real = NULL;
    struct text t = {0};
    static const char *const folders[] = {"", "/farm", "/log", "/log/farm"};
    for (size_t i = 0; i < f->n_wedges; i++)
        TRY(check_owner(f, f->wedge[i].job));
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        snprintf(path, sizeof path, "%s%s", f->root, folders[i]);
        TRY(folder_make(path));
    }
    real = realpath(f->root, NULL);
    if (!real || strlen(real) >= sizeof f->root) {
        st = fail(E_OUTPUT, "%.200s: %s", f->root, real ? "the path is too long" : strerror(errno));
        goto done;
    }
    strcpy(f->root, real);
    TRY(job_resolved(f->base, &t));
    snprintf(path, sizeof path, "%s/farm/job.yaml", f->root);
    TRY(atomic_file_write(path, t.data, t.size));
done:
    free(real);
    text_free(&t);
    return st;
}
