/* Descriptions of keys as text: all of a section, a single one, or all that mention a word. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "job/job.h"
#include "job/words.h"
#include "text/nearest.h"

enum { PATH_MAX_KEYS = 256, INDENT = 4, KEYS_MOST = 2048 };

/* ---- all keys with their paths */

static bool holds_keys(const struct job_key *key)
{
    return key->type == KEY_SUB || key->type == KEY_MAYBE || key->type == KEY_LIST || key->type == KEY_MAP;
}

/* Calls `key` for each key, with its path ("strata.N.to_m", "scene.box.min_m"). */
struct visit {
    void (*key)(void *user, const char *path, const struct job_key *key);
    void *user;
    bool everywhere; /* visits a section in all places where it is used, not only in the first */
    bool seen[JOB_SECTIONS];
};

static void visit_section(struct visit *v, enum job_section_id section, const char *path)
{
    const struct job_section *s = &job_sections[section];
    if (v->seen[section] && !v->everywhere)
        return;
    v->seen[section] = true;
    for (size_t i = 0; i < s->n; i++) {
        const struct job_key *key = &s->key[i];
        char below[PATH_MAX_KEYS];
        if (key->type == KEY_NAME && section != SECTION_job)
            continue;
        snprintf(below, sizeof below, "%s%s%s", path, *path ? "." : "", key->name);
        v->key(v->user, below, key);
        if (!holds_keys(key))
            continue;
        strncat(below,
                key->type == KEY_LIST  ? ".N"
                : key->type == KEY_MAP ? ".NAME"
                                       : "",
                sizeof below - strlen(below) - 1);
        visit_section(v, (enum job_section_id)key->child, below);
    }
}

static void visit_all(struct visit *v)
{
    visit_section(v, SECTION_job, "");
    for (int i = 0; i <= SHAPES; i++) {
        char path[PATH_MAX_KEYS];
        snprintf(path, sizeof path, "scene.%s", i < SHAPES ? job_sections[i].name : node_operators[0]);
        visit_section(v, (enum job_section_id)i, path);
    }
}

/* ---- one key */

static void show_key(struct text *t, const char *path, const struct job_key *key, int width)
{
    struct text about = {0};
    char range[256];
    text_add(t, "%s\n", path);
    text_add(&about, "%s%s%s", key_type_words(key), *key->unit ? ", " : "", key->unit);
    if (key_required(key)) {
        text_add(&about, "; required");
    } else {
        struct text preset = {0};
        key_default_words(key, &preset);
        if (preset.size)
            text_add(&about, "; default %s", preset.data);
        text_free(&preset);
    }
    if (*key_range_words(key, range))
        text_add(&about, "; %s", range);
    if (about.data)
        text_add_wrapped(t, about.data, 0, INDENT, width);
    text_free(&about);
    text_add(&about, "%s%s%s%s", key->meaning, *key->source ? " (" : "", key->source,
             *key->source ? ")" : "");
    if (about.data)
        text_add_wrapped(t, about.data, 0, INDENT, width);
    text_free(&about);
}

/* ---- by path */

struct place {
    enum job_section_id section;
    const struct job_key *key; /* NULL: the section */
    char path[PATH_MAX_KEYS];
};

static bool is_number(const char *s)
{
    return *s && strspn(s, "0123456789") == strlen(s);
}

/* The section of a shape or of the operators by name; SECTION_job if `name` is neither. */
static enum job_section_id shape_named(const char *name)
{
    for (int i = 0; i < SHAPES; i++)
        if (strcmp(job_sections[i].name, name) == 0)
            return (enum job_section_id)i;
    for (int i = 0; i < (int)NODE_SHAPE; i++)
        if (strcmp(node_operators[i], name) == 0)
            return SECTION_group;
    return SECTION_job;
}

/* Finds a key or section by path. Indices of lists and names in mappings are arbitrary and may be omitted. */
static bool find(const char *what, struct place *out)
{
    char copy[PATH_MAX_KEYS], *rest = copy;
    const struct job_key *in = NULL; /* the key that contains the section */
    *out = (struct place){.section = SECTION_job};
    snprintf(copy, sizeof copy, "%s", what);
    for (char *part; (part = strsep(&rest, ".")) != NULL;) {
        const struct job_key *key = out->key ? NULL : table_find(out->section, part);
        const bool nodes = in && in->type == KEY_NODE;
        if (nodes && shape_named(part) != SECTION_job) {
            out->section = shape_named(part);
            out->key = NULL;
        } else if (nodes && is_number(part)) {
            continue;
        } else if (key) {
            out->key = holds_keys(key) ? NULL : key;
            if (holds_keys(key))
                out->section = (enum job_section_id)key->child;
            in = key;
        } else if (in && !out->key &&
                   ((in->type == KEY_LIST && (is_number(part) || strcmp(part, "N") == 0)) ||
                    in->type == KEY_MAP)) {
            in = NULL;
        } else {
            return false;
        }
        if (in && in->type == KEY_NODE && out->key == in && rest)
            out->key = NULL;
    }
    snprintf(out->path, sizeof out->path, "%s", what);
    return true;
}

static void show_section(struct text *t, const struct place *p, int width)
{
    const struct job_section *s = &job_sections[p->section];
    text_add_wrapped(t, s->meaning, 0, 0, width);
    for (size_t i = 0; i < s->n; i++) {
        const struct job_key *key = &s->key[i];
        char path[PATH_MAX_KEYS + 64];
        snprintf(path, sizeof path, "%s%s%s", p->path, *p->path ? "." : "", key->name);
        if (holds_keys(key)) {
            text_add(t, "\n%s: a section\n", path);
            text_add_wrapped(t, job_sections[key->child].meaning, 0, INDENT, width);
        } else {
            text_add(t, "\n");
            show_key(t, path, key, width);
        }
    }
}

/* ---- by word */

struct search {
    struct text *out;
    const char *word;
    int width;
    size_t n, n_paths;
    char path[KEYS_MOST][PATH_MAX_KEYS];
};

static bool has(const char *text, const char *word)
{
    const size_t n = strlen(word);
    for (; *text; text++)
        if (strncasecmp(text, word, n) == 0)
            return true;
    return false;
}

static void try_key(void *user, const char *path, const struct job_key *key)
{
    struct search *s = user;
    if (s->n_paths < KEYS_MOST)
        snprintf(s->path[s->n_paths++], PATH_MAX_KEYS, "%s", path);
    if (holds_keys(key) || !(has(path, s->word) || has(key->meaning, s->word) || has(key->unit, s->word)))
        return;
    text_add(s->out, s->n++ ? "\n" : "");
    show_key(s->out, path, key, s->width);
}

static status show_found(const char *word, int width, struct text *out)
{
    status st = OK;
    struct search *s = calloc(1, sizeof *s);
    const char **known = calloc(KEYS_MOST, sizeof *known);
    if (!s || !known) {
        st = fail(E_MEMORY, "out of memory: listing the keys");
        goto done;
    }
    s->out = out;
    s->word = word;
    s->width = width;
    struct visit v = {.key = try_key, .user = s};
    visit_all(&v);
    if (s->n > 0)
        goto done;
    /* Suggestions compare whole paths, or the last part of paths if `word` is not a path. */
    for (size_t i = 0; i < s->n_paths; i++) {
        const char *dot = strrchr(s->path[i], '.'), *mine = strrchr(word, '.');
        known[i] = mine || !dot ? s->path[i] : dot + 1;
    }
    const char *near = nearest_word(word, known, s->n_paths);
    st = fail(E_USAGE, "no key is named or mentions '%.100s'; %s%s%s", word,
              near ? "did you mean " : "'hoodoo keys' lists the sections", near ? near : "", near ? "?" : "");
done:
    free(s);
    free(known);
    return st;
}

/* ---- all */

static void list_key(void *user, const char *path, const struct job_key *key)
{
    if (!holds_keys(key))
        text_add(user, "%s\n", path);
}

status job_keys_list(struct text *out)
{
    struct visit v = {.key = list_key, .user = out, .everywhere = true};
    visit_all(&v);
    return text_status(out);
}

static void show_overview(struct text *t, int width)
{
    const struct job_section *s = &job_sections[SECTION_job];
    for (size_t i = 0; i < s->n; i++) {
        const struct job_key *key = &s->key[i];
        text_add(t, "%s%s\n", key->name, holds_keys(key) ? ":" : "");
        text_add_wrapped(t, holds_keys(key) ? job_sections[key->child].meaning : key->meaning, 0, INDENT,
                         width);
    }
    struct text shapes = {0};
    text_add(&shapes, "shapes of scene:");
    for (int i = 0; i < SHAPES + (int)NODE_SHAPE; i++)
        text_add(&shapes, " %s", i < SHAPES ? job_sections[i].name : node_operators[i - SHAPES]);
    text_add(t, "\n");
    text_add_wrapped(t, shapes.data, 0, 0, width);
    text_free(&shapes);
    text_add(t, "\n");
    text_add_wrapped(
        t,
        "'hoodoo keys wind' describes the keys of a section, 'hoodoo keys wind.speed_m_s' one key, and 'hoodoo keys shear' all keys that mention shear.",
        0, 0, width);
}

status job_keys(const char *what, int width, struct text *out)
{
    struct place place;
    status st = OK;
    if (!what) {
        show_overview(out, width);
    } else if (find(what, &place) || (shape_named(what) != SECTION_job && find("scene", &place))) {
        if (shape_named(what) != SECTION_job && place.key) {
            place.key = NULL;
            place.section = shape_named(what);
            snprintf(place.path, sizeof place.path, "scene.%s", what);
        }
        if (place.key)
            show_key(out, place.path, place.key, width);
        else
            show_section(out, &place, width);
    } else {
        st = show_found(what, width, out);
    }
    return st == OK ? text_status(out) : st;
}
