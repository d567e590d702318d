#include "farm/command.h"

#include <stdio.h>
#include <string.h>

/* The value that {name} stands for. */
static const char *value_named(const struct command_values *v, const char *name, size_t length)
{
#define COMMAND_LOOK(member)                                                                                 \
    if (length == sizeof #member - 1 && memcmp(name, #member, length) == 0)                                  \
        return v->member;
    COMMAND_VALUES(COMMAND_LOOK)
#undef COMMAND_LOOK
    return NULL;
}

/* One word of `length` bytes with its value put in, behind what is in c->text; false if it does not fit. */
static bool add_word(struct farm_command *c, size_t *used, const char *word, size_t length,
                     const struct command_values *values)
{
    const size_t room = sizeof c->text - *used;
    const char *open = memchr(word, '{', length),
               *close = open ? memchr(open, '}', length - (size_t)(open - word)) : NULL;
    const char *value = "";
    int written;
    if (close) {
        value = value_named(values, open + 1, (size_t)(close - open) - 1);
        if (!value)
            return true;
        written = snprintf(c->text + *used, room, "%.*s%s%.*s", (int)(open - word), word, value,
                           (int)(word + length - close - 1), close + 1);
    } else {
        written = snprintf(c->text + *used, room, "%.*s", (int)length, word);
    }
    if (written < 0 || (size_t)written >= room || c->n + 1 >= sizeof c->argv / sizeof *c->argv)
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
    for (const char *word = farm_kinds[kind].command; *word;) {
        const size_t length = strcspn(word, " ");
        if (!add_word(c, &used, word, length, values))
            return fail(E_USAGE, "the command of a task (%s) is longer than %zu bytes", farm_kinds[kind].name,
                        sizeof c->text);
        word += length + (word[length] == ' ');
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

void farm_quote(struct text *out, const char *word)
{
    text_add(out, "'");
    for (const char *s = word; *s; s++) {
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
