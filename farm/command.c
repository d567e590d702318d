#include "farm/command.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void add(struct farm_command *c, const char *word)
{
    c->argv[c->n++] = word;
    c->argv[c->n] = NULL;
}

static void add_made(struct farm_command *c, const char *format, ...) PRINTF_LIKE(2, 3);
static void add_made(struct farm_command *c, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(c->word[c->n_words], sizeof c->word[0], format, args);
    va_end(args);
    add(c, c->word[c->n_words++]);
}

void farm_command(const struct farm *f, const struct farm_task *t, const char *device, struct farm_command *c)
{
    char root[FARM_PATH + 16], frames[48];
    c->n = c->n_words = 0;
    farm_root(f, t->wedge, root);
    range_text(t->frames, frames);
    add(c, f->hoodoo);
    switch (t->kind) {
    case FARM_SIM:
        add(c, "run");
        add_made(c, "%s/farm/job.yaml", f->root);
        if (t->wedge)
            add_made(c, "--wedge=%d", t->wedge);
        add(c, "--out");
        add_made(c, "%s", root);
        add_made(c, "--frames=%s", frames);
        add(c, "--progress=plain");
        if (device)
            add_made(c, "--device=%.200s", device);
        break;
    case FARM_MESH:
        add(c, "mesh");
        add_made(c, "%s", root);
        add_made(c, "--frames=%s", frames);
        add(c, "--missing");
        break;
    case FARM_AOV:
        add(c, "aov");
        add_made(c, "%s", root);
        add_made(c, "--frames=%s", frames);
        add(c, "--missing");
        if (device)
            add_made(c, "--device=%.200s", device);
        break;
    case FARM_STILL:
        add(c, "preview");
        add_made(c, "%s", root);
        add_made(c, "--frames=%s", frames);
        add(c, "--only=stills");
        break;
    case FARM_SHEET:
        add(c, "preview");
        add_made(c, "%s", root);
        add(c, "--only=sheet");
        break;
    case FARM_VIEW:
        add(c, "preview");
        add_made(c, "%s", root);
        add(c, "--only=views");
        add_made(c, "--views=%d", (int)farm_job(f, t)->farm.turntable);
        add_made(c, "--view=%s", range_text(t->views, frames));
        break;
    case FARM_TURNTABLE:
        add(c, "preview");
        add_made(c, "%s", root);
        add(c, "--only=video");
        add_made(c, "--views=%d", (int)farm_job(f, t)->farm.turntable);
        break;
    case FARM_WEDGES:
    case FARM_KINDS:
        add(c, "preview");
        add_made(c, "%s", root);
        add(c, "--only=wedges");
        break;
    }
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
