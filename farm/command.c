#include "farm/command.h"

#include <stdio.h>
#include <string.h>

#include "farm/needs.h"

/* The value for {name}; NULL: none. */
static const char *value_named(const struct command_values *v, const char *name, size_t length)
{
#define COMMAND_LOOK(member)                                                                                 \
    if (length == sizeof #member - 1 && memcmp(name, #member, length) == 0)                                  \
        return v->member;
    COMMAND_VALUES(COMMAND_LOOK)
#undef COMMAND_LOOK
    return NULL;
}

/* Appends an argument of the template, of `length` bytes, with its value filled in, to c->text and c->argv. False if it does not
 * fit. */
static bool add_argument(struct farm_command *c, size_t *used, const char *argument, size_t length,
                         const struct command_values *values)
{
    const size_t space = sizeof c->text - *used;
    const char *open = memchr(argument, '{', length),
               *close = open ? memchr(open, '}', length - (size_t)(open - argument)) : NULL;
    const char *value = "";
    int written;
    if (close) {
        value = value_named(values, open + 1, (size_t)(close - open) - 1);
        if (!value)
            return true;
        written = snprintf(c->text + *used, space, "%.*s%s%.*s", (int)(open - argument), argument, value,
                           (int)(argument + length - close - 1), close + 1);
    } else {
        written = snprintf(c->text + *used, space, "%.*s", (int)length, argument);
    }
    if (written < 0 || (size_t)written >= space || c->n + 1 >= sizeof c->argv / sizeof *c->argv)
        return false;
    c->argv[c->n++] = c->text + *used;
    *used += (size_t)written + 1;
    return true;
}

static bool given(const char *text)
{
    return text && *text;
}

struct command_head command_head(const struct job *job, enum farm_kind kind, const char *hoodoo)
{
    const struct job_tasks *keys = farm_requests(job, kind);
    const char *binary = given(keys->binary) ? keys->binary : job->farm.binary;
    struct command_head head = {given(binary) ? binary : hoodoo, keys->prologue, keys->n_prologue};
    if (!head.n_prologue) {
        head.prologue = job->farm.prologue;
        head.n_prologue = job->farm.n_prologue;
    }
    return head;
}

status command_check(const struct job *job)
{
    for (int k = 0; k < FARM_KINDS; k++) {
        const size_t n = command_head(job, (enum farm_kind)k, "").n_prologue;
        if (n > COMMAND_PROLOGUE)
            return fail(
                E_USAGE,
                "farm: a prologue has %zu arguments, and at most %d are allowed: put them into a script", n,
                COMMAND_PROLOGUE);
    }
    return OK;
}

status command_fill(const struct command_head *head, enum farm_kind kind, const struct command_values *values,
                    struct farm_command *c)
{
    size_t used = 0;
    c->n = 0;
    for (size_t i = 0; i < head->n_prologue && i < COMMAND_PROLOGUE; i++)
        c->argv[c->n++] = head->prologue[i];
    c->argv[c->n++] = head->hoodoo;
    for (const char *at = farm_kinds[kind].command; *at;) {
        const size_t length = strcspn(at, " ");
        if (!add_argument(c, &used, at, length, values))
            return fail(E_USAGE, "the command of a task (%s) is longer than %zu bytes", farm_kinds[kind].name,
                        sizeof c->text);
        at += length + (at[length] == ' ');
    }
    c->argv[c->n] = NULL;
    return OK;
}

status farm_command(const struct farm *f, const struct farm_task *t, const char *device, int jobs,
                    struct farm_command *c)
{
    status st = OK;
    struct path job;
    char wedge[16], frames[48], view[48], views[16], side[16];
    TRY(path_join(&job, f->root.text, "farm/job.yaml"));
    snprintf(wedge, sizeof wedge, "%d", t->wedge);
    snprintf(views, sizeof views, "%d", (int)farm_job(f, t)->farm.turntable);
    snprintf(side, sizeof side, "%d", jobs);
    const struct command_values values = {.job = job.text,
                                          .out = f->root.text,
                                          .wedge = t->wedge ? wedge : NULL,
                                          .frames = range_text(t->frames, frames),
                                          .views = views,
                                          .view = range_text(t->views, view),
                                          .value = t->show,
                                          .device = device,
                                          .jobs = jobs ? side : NULL,
                                          .progress = "plain"};
    const struct command_head head = command_head(farm_job(f, t), t->kind, f->hoodoo.text);
    TRY(command_fill(&head, t->kind, &values, c));
done:
    return st;
}

void farm_quote(struct text *out, const char *argument)
{
    text_add(out, "'");
    for (const char *s = argument; *s; s++) {
        if (*s == '\'')
            text_add(out, "'\\''");
        else
            text_add_bytes(out, s, 1);
    }
    text_add(out, "'");
}

bool farm_final(int exit_code)
{
    return exit_code == E_USAGE || exit_code == E_CHECKPOINT || exit_code == E_NUMERIC;
}
