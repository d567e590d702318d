#include "farm/command.h"

#include <stdio.h>
#include <string.h>

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

status command_fill(const char *hoodoo, enum farm_kind kind, const struct command_values *values,
                    struct farm_command *c)
{
    size_t used = 0;
    c->n = 0;
    c->argv[c->n++] = hoodoo;
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
    TRY(command_fill(f->hoodoo.text, t->kind, &values, c));
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
