/* Wedges: rows of values for some keys, which are applied to the job in the same manner as --set. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/path.h"
#include "job/parse.h"
#include "system/atomic_file.h"

enum { WEDGES_MAX = 9999, OVER_MAX = 64, LABEL_MAX = 1000 };

size_t job_wedges(const struct job *job)
{
    const struct job_wedge *w = &job->wedge;
    if (w->n_over == 0)
        return 0;
    if (w->combine == WEDGE_ZIP)
        return w->over[0].n_values;
    size_t n = 1;
    for (size_t i = 0; i < w->n_over && n <= WEDGES_MAX; i++)
        n *= w->over[i].n_values;
    return n;
}

/* The value of parameter `i` in wedge `index`. */
static const char *value_of(const struct job_wedge *w, size_t i, int index)
{
    size_t row = (size_t)index - 1;
    if (w->combine == WEDGE_ZIP)
        return w->over[i].values[row];
    for (size_t k = w->n_over; --k > i;)
        row /= w->over[k].n_values;
    return w->over[i].values[row % w->over[i].n_values];
}

static status check(const struct job *base, int index)
{
    static const char *const own[] = {"name", "hoodoo", "wedge", "farm", NULL};
    size_t n = job_wedges(base);
    if (n == 0)
        return fail(E_USAGE, "wedge %d: the job has no wedges", index);
    if (n > WEDGES_MAX || base->wedge.n_over > OVER_MAX)
        return fail(E_USAGE, "wedge: more than %d wedges or %d parameters; split the job", WEDGES_MAX,
                    OVER_MAX);
    if (index < 1 || (size_t)index > n)
        return fail(E_USAGE, "wedge %d: the job has wedges 1 to %zu", index, n);
    for (size_t i = 0; i < base->wedge.n_over; i++)
        for (size_t k = 0; own[k]; k++) {
            size_t length = strcspn(base->wedge.over[i].key, ".[");
            if (strlen(own[k]) == length && strncmp(base->wedge.over[i].key, own[k], length) == 0)
                return fail(E_USAGE, "wedge.over.%zu.key: %.80s cannot differ between wedges", i,
                            base->wedge.over[i].key);
        }
    return OK;
}

/* wedge.label="wind.speed_m_s=10, seed=2", cut where a character ends. */
static void put_label(struct text *t, const struct job_wedge *w, int index)
{
    text_add(t, "wedge.label=\"");
    size_t start = t->size;
    for (size_t i = 0; i < w->n_over; i++) {
        const char *part[] = {i ? ", " : "", w->over[i].key, "=", value_of(w, i, index)};
        for (size_t k = 0; k < 4; k++)
            for (const char *s = part[k]; *s; s++) {
                if (t->size - start > LABEL_MAX && (*s & 0xc0) != 0x80)
                    goto full;
                if (*s == '"' || *s == '\\')
                    text_add(t, "\\");
                text_add(t, "%c", (unsigned char)*s < 0x20 ? ' ' : *s);
            }
    }
full:
    text_add(t, "\"");
}

status job_load_wedge(const char *path, const char *const *sets, size_t n_sets, const struct job *base,
                      int index, struct job **out)
{
    status st = OK;
    struct text own[OVER_MAX + 5] = {0};
    const char **all = NULL;
    char number[FRAME_TEXT];
    size_t n = 0;
    *out = NULL;
    TRY(check(base, index));
    for (; n < base->wedge.n_over; n++)
        text_add(&own[n], "%s=%s", base->wedge.over[n].key, value_of(&base->wedge, n, index));
    text_add(&own[n++], "name=\"%s_%s\"", base->name, wedge_text(index, number));
    text_add(&own[n++], "wedge.over=[]");
    text_add(&own[n++], "wedge.csv=\"\"");
    text_add(&own[n++], "wedge.index=%d", index);
    put_label(&own[n++], &base->wedge, index);
    TRY(memory_alloc(n_sets + n, sizeof *all, "a wedge", &all));
    if (n_sets)
        memcpy(all, sets, n_sets * sizeof *all);
    for (size_t i = 0; i < n; i++) {
        TRY(text_status(&own[i]));
        all[n_sets + i] = own[i].data;
    }
    st = job_load(path, all, n_sets + n, out);
    if (st != OK) {
        char why[1800];
        snprintf(why, sizeof why, "%s", status_message());
        fail(st, "wedge %d: %s", index, why);
    }
done:
    for (size_t i = 0; i < n; i++)
        text_free(&own[i]);
    free(all);
    return st;
}

/* ---- CSV: RFC 4180. Fields may be quoted, quotes in them doubled. */

struct csv {
    const char *path, *at, *end;
    int line;
};

/* Reads the next field; *last is set if it is the last one of its line. */
static status csv_field(struct csv *c, struct text *out, bool *last)
{
    bool quoted = c->at < c->end && *c->at == '"', closed = !quoted;
    c->at += quoted;
    for (; c->at < c->end; c->at++) {
        if (quoted && *c->at == '"' && c->at + 1 < c->end && c->at[1] == '"')
            c->at++;
        else if (quoted && *c->at == '"') {
            closed = true;
            quoted = false;
            continue;
        } else if (!quoted && (*c->at == ',' || *c->at == '\n' || *c->at == '\r'))
            break;
        if (*c->at == '\n' || *c->at == '\0')
            return fail(E_INPUT, "%s:%d: a field spans several lines, or contains a NUL byte", c->path,
                        c->line);
        text_add_bytes(out, c->at, 1);
    }
    if (!closed)
        return fail(E_INPUT, "%s:%d: unterminated quote", c->path, c->line);
    *last = c->at >= c->end || *c->at != ',';
    if (c->at < c->end && *c->at == '\r' && c->at + 1 < c->end && c->at[1] == '\n')
        c->at++;
    c->at += c->at < c->end;
    return text_status(out);
}

static status csv_name(struct job_wedge *w, const struct csv *c, const char *key)
{
    struct job_sweep *sweep;
    size_t capacity = w->n_over;
    if (!*key || w->n_over == OVER_MAX)
        return fail(E_INPUT, "%s:1: an empty column name, or more than %d columns", c->path, OVER_MAX);
    status st = memory_grow(&w->over, &capacity, w->n_over + 1, sizeof *w->over, "the wedge");
    if (st != OK)
        return st;
    sweep = &w->over[w->n_over++];
    *sweep = (struct job_sweep){0};
    return memory_strdup(key, &sweep->key);
}

static status csv_value(struct job_sweep *sweep, const struct csv *c, const char *value)
{
    size_t capacity = sweep->n_values;
    for (const char *s = value; *s; s++)
        if ((unsigned char)*s < 0x20 || *s == 0x7f)
            return fail(E_INPUT, "%s:%d: a control character", c->path, c->line);
    if (!*value)
        return fail(E_INPUT, "%s:%d: %.80s is empty", c->path, c->line, sweep->key);
    status st =
        memory_grow(&sweep->values, &capacity, sweep->n_values + 1, sizeof *sweep->values, "the wedge");
    return st == OK ? memory_strdup(value, &sweep->values[sweep->n_values++]) : st;
}

static status csv_rows(struct job_wedge *w, struct csv *c)
{
    status st = OK;
    struct text field = {0};
    bool last = false;
    size_t column = 0, rows = 0;
    /* A comma at the end of the file is followed by an empty field. */
    for (; c->at < c->end || column > 0; c->line += last) {
        text_free(&field);
        field = (struct text){0};
        TRY(csv_field(c, &field, &last));
        const char *text = field.data ? field.data : "";
        if (last && column == 0 && !*text)
            continue; /* an empty line */
        if (c->line == 1)
            TRY(csv_name(w, c, text));
        else if (column < w->n_over)
            TRY(csv_value(&w->over[column], c, text));
        if (c->line > 1 && (column >= w->n_over || (last && column + 1 != w->n_over))) {
            st = fail(E_INPUT, "%s:%d: %s fields than the first line's %zu", c->path, c->line,
                      column >= w->n_over ? "more" : "fewer", w->n_over);
            goto done;
        }
        rows += last && c->line > 1;
        column = last ? 0 : column + 1;
        if (rows > WEDGES_MAX) {
            st = fail(E_INPUT, "%s: more than %d lines", c->path, WEDGES_MAX);
            goto done;
        }
    }
    if (rows == 0)
        st = fail(E_INPUT, "%s: no line of values below the line of keys", c->path);
done:
    text_free(&field);
    return st;
}

/* Detects variants that spreadsheets also export as CSV, and explains them. */
static status check_kind(const struct csv *c)
{
    const size_t n = (size_t)(c->end - c->at);
    const char *end = memchr(c->at, '\n', n);
    const size_t first = end ? (size_t)(end - c->at) : n;
    if (n >= 2 && (memcmp(c->at, "\xff\xfe", 2) == 0 || memcmp(c->at, "\xfe\xff", 2) == 0))
        return fail(E_INPUT, "%s: the encoding is UTF-16; save it as UTF-8", c->path);
    if (memchr(c->at, ',', first))
        return OK;
    if (memchr(c->at, ';', first) || memchr(c->at, '\t', first))
        return fail(E_INPUT, "%s:1: fields are separated by %s; commas are expected", c->path,
                    memchr(c->at, ';', first) ? "semicolons" : "tabs");
    return OK;
}

status read_wedge_csv(const char *folder, const char *behind, struct job *job)
{
    status st = OK;
    struct job_wedge *w = &job->wedge;
    struct path path;
    char *bytes = NULL;
    size_t n;
    if (!*w->csv)
        return OK;
    st = *w->csv == '/' ? path_format(&path, "%s", w->csv) : path_join(&path, folder, w->csv);
    if (st != OK)
        return fail(E_INPUT, "wedge.csv: %s", status_message());
    if (behind && *w->csv != '/' && access(path.text, F_OK) != 0)
        TRY(path_join(&path, behind, w->csv));
    TRY(file_read(path.text, YAML_BYTES, &bytes, &n));
    struct csv csv = {.path = path.text, .at = bytes, .end = bytes + n, .line = 1};
    if (n >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0)
        csv.at += 3; /* skips the byte order mark that spreadsheets write */
    TRY(check_kind(&csv));
    TRY(csv_rows(w, &csv));
    w->combine = WEDGE_ZIP;
    *w->csv = '\0'; /* the job has the rows now */
done:
    free(bytes);
    return st;
}
