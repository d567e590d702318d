/* Reads single values from YAML and from the table's defaults. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "job/parse.h"

enum { FRAME_LIMIT = 9999999, NAMES = 4096, POINTS = 65536 };

/* Adds the position of `value` to the message of the last fail(). */
static status at_place(const struct yaml *value, status st)
{
    char why[200];
    snprintf(why, sizeof why, "%.190s", status_message());
    return st == E_USAGE ? yaml_fail(value, NULL, "%s", why) : st;
}

static status read_number(const struct job_key *key, const struct yaml *v, double *out)
{
    char allowed[256];
    key_allowed(key, allowed);
    if (v->kind != YAML_SCALAR || yaml_is_null(v))
        return yaml_fail(v, NULL, "%s where a number is expected (%s)", yaml_what(v), allowed);
    double number;
    bool decimal = yaml_decimal(v->text, &number);
    if (v->quoted)
        return yaml_fail(v, NULL, "text where a number is expected (%s)%s", allowed,
                         decimal ? "; leave out the quotes" : "");
    if (!decimal)
        return yaml_fail(v, NULL, "'%.40s' is not a finite decimal number (%s)", v->text, allowed);
    if (number < key->min || number > key->max)
        return yaml_fail(v, NULL, "%.40s is out of range (%s)", v->text, allowed);
    bool whole = key->type == KEY_INT || (key->type == KEY_VEC && strcmp(key->unit, "px") == 0);
    if (whole && number != floor(number))
        return yaml_fail(v, NULL, "%.40s is not a whole number (%s)", v->text, allowed);
    *out = number + 0.0; /* -0 becomes 0 */
    return OK;
}

/* Allocates a curve with `width` numbers for each of n frames. */
static status curve_alloc(struct curve *c, size_t n, size_t width)
{
    status st = memory_alloc((1 + width) * n, sizeof *c->frame, "a curve", &c->frame);
    if (st != OK)
        return st;
    c->value = c->frame + n;
    c->n = n;
    return OK;
}

struct curve_key {
    double frame, value[3];
    const struct yaml *at;
};

static int by_frame(const void *a, const void *b)
{
    const struct curve_key *x = a, *y = b;
    return (x->frame > y->frame) - (x->frame < y->frame);
}

static status read_ease(const struct yaml *v, enum curve_ease *out)
{
    static const char *const names[] = {"linear", "smooth", "step"};
    for (int i = 0; v->kind == YAML_SCALAR && i < 3; i++)
        if (strcmp(v->text, names[i]) == 0) {
            *out = (enum curve_ease)i;
            return OK;
        }
    return yaml_fail(v, NULL, "not an ease (linear, smooth, step)");
}

static status read_vec(const struct job_key *key, const struct yaml *v, double *out);

/* One value of a curve or a track. */
static status read_curve_value(const struct job_key *key, const struct yaml *v, double *out)
{
    return key->type == KEY_TRACK ? read_vec(key, v, out) : read_number(key, v, out);
}

static size_t curve_width(const struct job_key *key)
{
    return key->type == KEY_TRACK ? key->n : 1;
}

static status read_keyed_curve(const struct job_key *key, const struct yaml *map, struct curve *out)
{
    status st = OK;
    struct curve_key *keys = NULL;
    size_t n = 0;
    TRY(memory_alloc(map->n, sizeof *keys, "a curve", &keys));
    for (const struct yaml *v = map->first; v; v = v->next) {
        struct curve_key *k = &keys[n];
        if (strcmp(v->key, "ease") == 0) {
            TRY(read_ease(v, &out->ease));
            continue;
        }
        if (!yaml_decimal(v->key, &k->frame) || k->frame != floor(k->frame) || fabs(k->frame) > FRAME_LIMIT) {
            st = yaml_fail_key(
                v, "not a frame; a curve is a value, or {frame: value, ease: linear|smooth|step}");
            goto done;
        }
        k->frame += 0.0;
        k->at = v;
        TRY(read_curve_value(key, v, k->value));
        n++;
    }
    if (n == 0) {
        st = yaml_fail(map, NULL, "a curve needs at least one frame: {frame: value, ...}");
        goto done;
    }
    qsort(keys, n, sizeof *keys, by_frame);
    TRY(curve_alloc(out, n, curve_width(key)));
    for (size_t i = 0; i < n; i++) {
        if (i && keys[i].frame == keys[i - 1].frame) {
            st = yaml_fail_key(keys[i].at, "frame %.0f is given twice", keys[i].frame);
            goto done;
        }
        out->frame[i] = keys[i].frame;
        memcpy(out->value + i * curve_width(key), keys[i].value, curve_width(key) * sizeof(double));
    }
done:
    free(keys);
    return st;
}

static status read_curve(const struct job_key *key, const struct yaml *v, struct curve *out)
{
    if (v->kind == YAML_MAP)
        return read_keyed_curve(key, v, out);
    double value[3];
    status st = read_curve_value(key, v, value);
    if (st != OK || (st = curve_alloc(out, 1, curve_width(key))) != OK)
        return st;
    memcpy(out->value, value, curve_width(key) * sizeof *value);
    return OK;
}

static status read_vec(const struct job_key *key, const struct yaml *v, double *out)
{
    char allowed[256];
    if (v->kind != YAML_LIST || v->n != key->n)
        return yaml_fail(v, NULL, "%s%s where a list of %zu numbers is expected (each %s)", yaml_what(v),
                         v->kind == YAML_LIST ? " of another length" : "", key->n, key_allowed(key, allowed));
    for (const struct yaml *item = v->first; item; item = item->next) {
        status st = read_number(key, item, out++);
        if (st != OK)
            return st;
    }
    return OK;
}

static status read_choice(const struct job_key *key, const struct yaml *v, int *out)
{
    char allowed[256];
    const char *item;
    size_t n;
    key_allowed(key, allowed);
    if (v->kind != YAML_SCALAR)
        return yaml_fail(v, NULL, "%s where a choice is expected (%s)", yaml_what(v), allowed);
    for (int i = 0; (item = choice_item(key->choices, i, &n)) != NULL; i++)
        if (strlen(v->text) == n && memcmp(v->text, item, n) == 0) {
            *out = i;
            return OK;
        }
    return yaml_fail(v, NULL, "'%.40s' is not one of %s", v->text, allowed);
}

static status read_bool(const struct yaml *v, bool *out)
{
    static const char *const words[] = {"false", "False", "FALSE", "true", "True", "TRUE"};
    for (int i = 0; v->kind == YAML_SCALAR && !v->quoted && i < 6; i++)
        if (strcmp(v->text, words[i]) == 0) {
            *out = i >= 3;
            return OK;
        }
    if (v->kind == YAML_SCALAR && !yaml_is_null(v))
        return yaml_fail(v, NULL, "'%.40s' is not true or false", v->text);
    return yaml_fail(v, NULL, "%s where true or false is expected", yaml_what(v));
}

static status read_range(const struct yaml *v, struct frame_range *out)
{
    if (v->kind != YAML_SCALAR || yaml_is_null(v))
        return yaml_fail(v, NULL, "%s where a frame range is expected (such as 1001-1110 or 1001-1110x2)",
                         yaml_what(v));
    status st = range_parse(v->text, out);
    return st == OK ? OK : at_place(v, st);
}

/* Refuses control characters, which names, paths and metadata must not contain; comments may have line breaks and tabs. */
static bool printable(const char *text)
{
    for (const unsigned char *s = (const unsigned char *)text; *s; s++) {
        if ((*s < 0x20 && *s != '\n' && *s != '\t') || *s == 0x7f)
            return false;
        bool c1 = s[0] == 0xc2 && s[1] < 0xa0;
        bool line_break = s[0] == 0xe2 && s[1] == 0x80 && (s[2] == 0xa8 || s[2] == 0xa9);
        bool mark = s[0] == 0xef && ((s[1] == 0xbb && s[2] == 0xbf) || (s[1] == 0xbf && s[2] >= 0xbe));
        if (c1 || line_break || mark)
            return false;
    }
    return true;
}

static status check_text(const struct yaml *v, bool or_number)
{
    if (v->kind != YAML_SCALAR || yaml_is_null(v))
        return yaml_fail(v, NULL, "%s where text is expected (\"\" for none)", yaml_what(v));
    if (!v->quoted && strcmp(yaml_what(v), "text") != 0 &&
        !(or_number && strcmp(yaml_what(v), "a number") == 0))
        return yaml_fail(v, NULL, "%s where text is expected; put it in quotes: \"%.40s\"", yaml_what(v),
                         v->text);
    if (!printable(v->text))
        return yaml_fail(v, NULL, "contains a control character");
    return OK;
}

static status read_name(const struct yaml *v, char **out)
{
    status st = check_text(v, false);
    size_t n = st == OK ? strlen(v->text) : 0;
    if (st != OK)
        return st;
    if (n == 0 || n > 64 ||
        strspn(v->text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") != n)
        return yaml_fail(v, NULL, "'%.70s' is not a name (1 to 64 letters, digits, _ and -)", v->text);
    return memory_strdup(v->text, out);
}

static status read_input(const struct job_key *key, const struct yaml *v, const char *folder, char **out)
{
    status st = check_text(v, false);
    if (st != OK)
        return st;
    if (!*v->text && key->preset && !*key->preset)
        return memory_strdup("", out);
    if (!*v->text || strchr(v->text, '\n'))
        return yaml_fail(v, NULL, "a file name is expected");
    if (*v->text == '/')
        return memory_strdup(v->text, out);
    size_t n = strlen(folder) + strlen(v->text) + 2;
    st = memory_alloc(n, 1, "a file name", out);
    if (st == OK)
        snprintf(*out, n, "%s%s%s", folder, folder[strlen(folder) - 1] == '/' ? "" : "/", v->text);
    return st;
}

static status read_points(const struct job_key *key, const struct yaml *v, void *base)
{
    double *point = NULL;
    if (v->kind != YAML_LIST)
        return yaml_fail(v, NULL, "%s where a list of points is expected ([] for none), each of %zu numbers",
                         yaml_what(v), key->n);
    if (v->n > POINTS)
        return yaml_fail(v, NULL, "%zu points (at most %d)", v->n, POINTS);
    status st = memory_alloc(v->n, key->n * sizeof *point, key->name, &point);
    if (st != OK)
        return st;
    key_set_items(key, base, point, v->n);
    for (const struct yaml *item = v->first; item && st == OK; item = item->next, point += key->n)
        st = read_vec(key, item, point);
    return st;
}

static status read_ranges(const struct job_key *key, const struct yaml *v, void *base)
{
    struct frame_range *range = NULL;
    if (v->kind != YAML_LIST)
        return yaml_fail(v, NULL,
                         "%s where a list of frames is expected ([] for none), such as [1040, 1050-1100x10]",
                         yaml_what(v));
    if (v->n > NAMES)
        return yaml_fail(v, NULL, "%zu frame ranges (at most %d)", v->n, NAMES);
    status st = memory_alloc(v->n, sizeof *range, key->name, &range);
    if (st != OK)
        return st;
    key_set_items(key, base, range, v->n);
    for (const struct yaml *item = v->first; item && st == OK; item = item->next)
        st = read_range(item, range++);
    return st;
}

static status read_names(const struct job_key *key, const struct yaml *v, void *base)
{
    char **names = NULL;
    if (v->kind != YAML_LIST)
        return yaml_fail(v, NULL, "%s where a list of names is expected ([] for none)", yaml_what(v));
    if (v->n > NAMES)
        return yaml_fail(v, NULL, "%zu names (at most %d)", v->n, NAMES);
    status st = memory_alloc(v->n, sizeof *names, key->name, &names);
    if (st != OK)
        return st;
    key_set_items(key, base, names, v->n);
    for (const struct yaml *item = v->first; item && st == OK; item = item->next)
        st = read_name(item, names++);
    return st;
}

/* A value of any kind as one line of YAML, in the form that --set accepts. Texts in quotes are already YAML. */
static void put_flow(struct text *t, const struct yaml *v, bool top)
{
    if (v->kind == YAML_SCALAR && (top || !v->quoted)) {
        text_add(t, "%s", v->text);
    } else if (v->kind == YAML_SCALAR) {
        text_add(t, "'");
        for (const char *s = v->text; *s; s++)
            text_add(t, *s == '\'' ? "''" : "%c", *s);
        text_add(t, "'");
    } else {
        bool map = v->kind == YAML_MAP;
        text_add(t, map ? "{" : "[");
        for (const struct yaml *item = v->first; item; item = item->next) {
            if (map)
                text_add(t, "%s: ", item->key);
            put_flow(t, item, false);
            text_add(t, item->next ? ", " : "");
        }
        text_add(t, map ? "}" : "]");
    }
}

static status read_texts(const struct job_key *key, const struct yaml *v, void *base)
{
    char **texts = NULL;
    if (v->kind != YAML_LIST)
        return yaml_fail(v, NULL, "%s where a list of values is expected ([] for none)", yaml_what(v));
    if (v->n > NAMES)
        return yaml_fail(v, NULL, "%zu values (at most %d)", v->n, NAMES);
    status st = memory_alloc(v->n, sizeof *texts, key->name, &texts);
    if (st != OK)
        return st;
    key_set_items(key, base, texts, v->n);
    for (const struct yaml *item = v->first; item && st == OK; item = item->next) {
        struct text t = {0};
        put_flow(&t, item, true);
        st = text_status(&t);
        if (st == OK && (!t.data || !printable(t.data) || t.size >= YAML_TEXT))
            st = yaml_fail(item, NULL,
                           !t.data               ? "is empty"
                           : t.size >= YAML_TEXT ? "is too long"
                                                 : "contains a control character");
        if (st == OK)
            st = memory_strdup(t.data, texts++);
        text_free(&t);
    }
    return st;
}

status read_value(const struct job_key *key, const struct yaml *v, const char *folder, void *base)
{
    void *member = key_member(key, base);
    double number;
    status st;
    switch (key->type) {
    case KEY_TEXT:
        st = check_text(v, key->n == 1);
        return st == OK ? memory_strdup(v->text, member) : st;
    case KEY_NAME:
        return read_name(v, member);
    case KEY_INPUT:
        return read_input(key, v, folder, member);
    case KEY_NUM:
        return read_number(key, v, member);
    case KEY_INT:
        st = read_number(key, v, &number);
        if (st == OK)
            *(int64_t *)member = (int64_t)number;
        return st;
    case KEY_CURVE:
    case KEY_TRACK:
        return read_curve(key, v, member);
    case KEY_BOOL:
        return read_bool(v, member);
    case KEY_CHOICE:
        return read_choice(key, v, member);
    case KEY_VEC:
        return read_vec(key, v, member);
    case KEY_RANGE:
        return read_range(v, member);
    case KEY_POINTS:
        return read_points(key, v, base);
    case KEY_NAMES:
        return read_names(key, v, base);
    case KEY_RANGES:
        return read_ranges(key, v, base);
    case KEY_SETS:
        return read_sets(v, member);
    case KEY_TEXTS:
        return read_texts(key, v, base);
    case KEY_SUB:
    case KEY_MAYBE:
    case KEY_LIST:
    case KEY_MAP:
    case KEY_NODE:
        break;
    }
    return fail(E_USAGE, "%s is a section", key->name);
}
