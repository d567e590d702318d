#include "farm/end.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/visible.h"
#include "system/atomic_file.h"
#include "system/child.h"
#include "text/json.h"

enum { FILE_MAX = 65536 };

static status end_path(const struct farm *f, struct path *out)
{
    return path_join(out, f->root.text, "farm/end.json");
}

/* The state in end.json, or "" if there is none that can be read. */
static void read_state(const struct farm *f, char out[16])
{
    struct path path;
    char *bytes = NULL;
    size_t n;
    struct json *json = NULL;
    out[0] = '\0';
    if (end_path(f, &path) == OK && access(path.text, F_OK) == 0 &&
        file_read(path.text, FILE_MAX, &bytes, &n) == OK && json_read(path.text, bytes, n, &json) == OK) {
        const char *state = json_to_text(json_member(json, "state"));
        snprintf(out, 16, "%s", state ? state : "");
    }
    json_free(&json);
    free(bytes);
}

status farm_ended(const struct farm *f, bool *done)
{
    char state[16];
    read_state(f, state);
    *done = strcmp(state, "done") == 0;
    return OK;
}

void farm_end_reset(const struct farm *f)
{
    struct path path;
    bool done;
    if (farm_ended(f, &done) == OK && !done && end_path(f, &path) == OK)
        unlink(path.text);
}

/* Creates end.json; *ours: this process did, and no other has. */
static status claim(const struct farm *f, const char *state, size_t n_done, size_t n, bool *ours)
{
    status st = OK;
    struct path path;
    struct text t = {0};
    TRY(end_path(f, &path));
    json_object(&t, NULL);
    json_integer(&t, "format", 1);
    json_text(&t, "state", state);
    json_integer(&t, "tasks", (int64_t)n);
    json_integer(&t, "tasks_done", (int64_t)n_done);
    json_end_object(&t);
    TRY(text_status(&t));
    int fd = open(path.text, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    *ours = fd >= 0;
    if (fd < 0 && errno != EEXIST)
        st = fail(E_OUTPUT, "%s: %s", path.text, strerror(errno));
    if (fd >= 0) {
        const bool written = write(fd, t.data, t.size) == (ssize_t)t.size && fsync(fd) == 0;
        if ((close(fd) != 0) | !written) {
            st = fail(E_OUTPUT, "%s: %s", path.text, strerror(errno));
            unlink(path.text);
        }
    }
done:
    text_free(&t);
    return st;
}

static status run_on_done(const struct farm *f, const char *state, size_t n_done, size_t n)
{
    status st = OK;
    const struct job *job = f->base;
    const char **argv = NULL;
    struct child child = {0};
    struct path log;
    char tasks[32], tasks_done[32];
    int how = 0;
    if (job->farm.n_on_done == 0)
        return OK;
    TRY(memory_alloc(job->farm.n_on_done + 1, sizeof *argv, "farm.on_done", &argv));
    for (size_t i = 0; i < job->farm.n_on_done; i++)
        argv[i] = job->farm.on_done[i];
    TRY(path_join(&log, f->root.text, "log/farm/on_done.log"));
    snprintf(tasks, sizeof tasks, "%zu", n);
    snprintf(tasks_done, sizeof tasks_done, "%zu", n_done);
    const struct {
        const char *name, *value;
    } variables[] = {{"HOODOO_OUT", f->root.text},
                     {"HOODOO_NAME", job->name},
                     {"HOODOO_STATE", state},
                     {"HOODOO_TASKS", tasks},
                     {"HOODOO_TASKS_DONE", tasks_done}};
    for (size_t i = 0; i < sizeof variables / sizeof *variables; i++)
        setenv(variables[i].name, variables[i].value, 1);
    TRY(child_start(
        &(struct child_options){
            .argv = argv, .folder = f->root.text, .log = log.text, .death_signal = SIGTERM},
        &child));
    while (child.pid)
        child_wait(&child, 1, -1, &how);
    if (WIFEXITED(how) && WEXITSTATUS(how) == 0)
        log_info("farm.on_done was run: %s", argv[0]);
    else if (WIFEXITED(how) && WEXITSTATUS(how) == CHILD_NO_PROGRAM)
        st = fail(E_OUTPUT, "farm.on_done: there is no program '%s' here", argv[0]);
    else
        st = fail(E_OUTPUT, "farm.on_done: %s ended with %s %d: see %s", argv[0],
                  WIFEXITED(how) ? "exit code" : "signal", WIFEXITED(how) ? WEXITSTATUS(how) : WTERMSIG(how),
                  log.text);
done:
    free(argv);
    return st;
}

/* Counts the tasks besides the end. *first: the first that is not done, or NULL. */
static status count(const struct farm *f, size_t *n, size_t *n_done, const struct farm_task **first)
{
    status st = OK;
    bool done;
    *n = *n_done = 0;
    *first = NULL;
    for (size_t i = 0; i < f->graph.n; i++) {
        if (f->graph.task[i].kind == FARM_END)
            continue;
        TRY(farm_task_done(f, &f->graph.task[i], &done));
        ++*n;
        *n_done += done;
        if (!done && !*first)
            *first = &f->graph.task[i];
    }
done:
    return st;
}

status farm_end(const char *root)
{
    status st = OK;
    struct farm f = {0};
    size_t n_done = 0, n = 0;
    const struct farm_task *first = NULL;
    bool ours = false;
    const double until = clock_seconds() + visible_delay();
    TRY(farm_open(root, &f));
    /* A shared disk may not show yet what the last tasks wrote on other machines. */
    do
        TRY(count(&f, &n, &n_done, &first));
    while (first && clock_seconds() < until && usleep(500000) == 0);
    const char *state = first ? "failed" : "done";
    TRY(claim(&f, state, n_done, n, &ours));
    if (ours)
        TRY(run_on_done(&f, state, n_done, n));
    if (first)
        st = fail(E_OUTPUT, "%zu of %zu tasks are not done; the first is %s: 'hoodoo status %s' lists them",
                  n - n_done, n, first->name, f.root.text);
    else
        log_info("all %zu tasks are done: %s", n, f.root.text);
done:
    farm_free(&f);
    return st;
}
