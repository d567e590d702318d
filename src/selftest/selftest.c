#include "selftest/selftest.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/log.h"
#include "base/memory.h"
#include "job/job.h"
#include "system/atomic_file.h"
#include "system/cache.h"

status selftest_stop(const struct selftest *t)
{
    return t->stop && t->stop() ? fail(STOPPED, "selftest: stopped before its end; nothing of it is left")
                                : OK;
}

status selftest_do(struct selftest *t, const char *group, const char *name, selftest_check check,
                   const void *what)
{
    status st = OK;
    struct findings *r = &t->findings;
    TRY(selftest_stop(t));
    TRY(memory_grow(&r->row, &r->capacity, r->n_rows + 1, sizeof *r->row, "the checks"));
    struct row row = {.group = group, .ok = true};
    snprintf(row.name, sizeof row.name, "%s", name);
    const double start = clock_seconds();
    const bool hushed = log_silence(true);
    st = check(t, what, &row);
    log_silence(hushed);
    row.seconds = clock_seconds() - start;
    if (st == STOPPED || st == E_OUTPUT)
        return st;
    if (st != OK)
        row_wrong(&row, "%s", status_message());
    if (!row.ok && !*row.found)
        row_found(&row, "see below");
    r->row[r->n_rows++] = row;
    log_info("%s, %s: %s (%.1f s)", group, name, row.ok ? "ok" : row.why, row.seconds);
    if (st != E_DEVICE)
        st = OK;
done:
    return st;
}

status selftest_load(struct selftest *t, const char *const *line, const char *const *sets, size_t n_sets,
                     struct job **out)
{
    status st = OK;
    struct text text = {0};
    struct path path;
    for (; *line; line++)
        text_add(&text, "%s", *line);
    TRY(text_status(&text));
    TRY(path_join(&path, t->folder.text, "job.yaml"));
    TRY(atomic_file_write(path.text, text.data, text.size));
    TRY(job_load(path.text, sets, n_sets, out));
done:
    text_free(&text);
    return st;
}

static status make_folder(struct path *out)
{
    status st = OK;
    struct path parent;
    TRY(temporary_folder(&parent));
    TRY(path_join(out, parent.text, "hoodoo-selftest.XXXXXX"));
    if (!mkdtemp(out->text)) {
        st = fail(E_OUTPUT,
                  "%s: the temporary folder cannot be created: %s (set HOODOO_TMP to use another place)",
                  out->text, strerror(errno));
        out->text[0] = '\0';
    }
done:
    return st;
}

/* The folder contains only files. */
static void remove_folder(struct path *folder)
{
    struct path path;
    DIR *dir = *folder->text ? opendir(folder->text) : NULL;
    if (!dir)
        return;
    for (struct dirent *e; (e = readdir(dir));)
        if (path_join(&path, folder->text, e->d_name) == OK)
            unlink(path.text);
    closedir(dir);
    rmdir(folder->text);
    folder->text[0] = '\0';
}

static status describe_device(struct selftest *t)
{
    status st = OK;
    struct gpu *gpu = NULL;
    TRY(gpu_create(&(struct gpu_options){.device = t->device}, &gpu));
    t->findings.device = *gpu_info(gpu);
    t->findings.limits = gpu_limits(gpu);
    t->findings.memory_free = gpu_memory_free(gpu);
done:
    gpu_destroy(&gpu);
    return st;
}

status selftest_run(struct selftest *t)
{
    status st = OK;
    static status (*const parts[])(struct selftest *) = {selftest_primitives, selftest_models,
                                                         selftest_picture, selftest_memory, selftest_speed};
    const double start = clock_seconds(), cpu_start = clock_cpu_seconds();
    t->findings.quick = t->quick;
    TRY(describe_device(t));
    TRY(make_folder(&t->folder));
    for (size_t i = 0; i < sizeof parts / sizeof *parts && st == OK; i++)
        st = parts[i](t);
    /* A lost device has already been recorded as a row. */
    if (st == E_DEVICE && findings_first_wrong(&t->findings))
        st = OK;
done:
    remove_folder(&t->folder);
    t->findings.seconds = clock_seconds() - start;
    t->findings.cpu_seconds = clock_cpu_seconds() - cpu_start;
    return st;
}

void selftest_end(struct selftest *t)
{
    findings_free(&t->findings);
}
