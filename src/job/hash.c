/* The job hash. It covers SIM keys in the table's order and LATER keys that differ from their defaults, with names and values in a
 * canonical form that does not depend on how they were written: numbers as eight bytes (little endian, as on all supported
 * machines), texts with a NUL, lists and mappings with their length first, and files as their content. The first frame, from
 * which ages count, comes last. */
#include "base/hash.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "gltf/gltf.h"
#include "job/parse.h"

/* A key that is not a section, and where its part of the canonical form ends. */
struct leaf {
    char path[256];
    size_t end;
};

/* The part to hash: all; or, for the hash of a frame, the values that are the same in all frames, or those of one frame. */
enum walk_part { WALK_ALL, WALK_STEADY, WALK_MOMENT };

/* Traverses the job for all purposes: the canonical form of what affects the simulation, or the files of frames, or the list of input
 * files. */
struct walk {
    enum walk_part part;
    int frame;               /* WALK_MOMENT */
    const struct job *whole; /* for a frame's hash: the job as loaded, which has the edits */
    struct text canonical;
    struct leaf *leaf; /* with `leaves` */
    size_t n_leaves, leaf_capacity;
    bool leaves, of_files, all; /* all: every key of a section */
    struct job_input *inputs;
    size_t n_inputs, capacity;
    bool only_inputs;
    char path[256]; /* key path of the current position */
};

static void put_number(struct walk *w, double v)
{
    v += 0.0; /* -0 is 0 */
    text_add_bytes(&w->canonical, &v, sizeof v);
}

static void put_count(struct walk *w, size_t n)
{
    uint64_t count = n;
    text_add_bytes(&w->canonical, &count, sizeof count);
}

static void put_text(struct walk *w, const char *s)
{
    text_add_bytes(&w->canonical, s, strlen(s) + 1);
}

static void put_range(struct walk *w, struct frame_range range)
{
    put_number(w, range.first);
    put_number(w, range.last);
    put_number(w, range.step);
}

/* A constant curve is hashed as a number, however it is written. For the part that is common to all frames, only whether a curve is ever
 * above 0 counts: a model allocates nothing for water, for example, if there never is any. */
static void put_curve(struct walk *w, const struct curve *c, size_t width)
{
    double now[3];
    if (w->part == WALK_STEADY) {
        put_count(w, width == 1 && curve_max(c) > 0);
        return;
    }
    if (w->part == WALK_MOMENT) {
        if (width == 1)
            now[0] = curve_at(c, w->frame);
        else
            track_at(c, w->frame, now);
        for (size_t a = 0; a < width; a++)
            put_number(w, now[a]);
        return;
    }
    put_count(w, c->n);
    for (size_t i = 0; i < c->n; i++) {
        if (c->n > 1)
            put_number(w, c->frame[i]);
        for (size_t a = 0; a < width; a++)
            put_number(w, c->value[i * width + a]);
    }
    if (c->n > 1)
        put_count(w, (size_t)c->ease);
}

static status add_input(struct walk *w, struct job_input input)
{
    status st = OK;
    for (size_t i = 0; i < w->n_inputs; i++)
        if (strcmp(w->inputs[i].path, input.path) == 0)
            return OK;
    TRY(memory_grow(&w->inputs, &w->capacity, w->n_inputs + 1, sizeof *w->inputs, "the job's input files"));
    TRY(memory_strdup(input.path, &input.path));
    w->inputs[w->n_inputs++] = input;
done:
    return st;
}

/* Accepts regular files only: a pipe or /dev/zero could be read forever. */
static status walk_file(struct walk *w, char *path)
{
    struct job_input input = {.path = path};
    struct stat info;
    if (stat(path, &info) != 0)
        return fail(E_INPUT, "%s: %s: %s", w->path, path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return fail(E_INPUT, "%s: %s: not a regular file", w->path, path);
    status st = hash_file(path, &input.hash, &input.size);
    if (st != OK) {
        char why[1200];
        snprintf(why, sizeof why, "%.1190s", status_message());
        return fail(st, "%s: %s", w->path, why);
    }
    put_count(w, input.hash);
    put_count(w, input.size);
    return w->only_inputs ? add_input(w, input) : OK;
}

/* The file, and the files that it refers to. */
static status walk_input(struct walk *w, char *path)
{
    status st = OK;
    struct gltf_buffers buffers = {0};
    put_count(w, *path != 0);
    if (!*path)
        return OK;
    TRY(walk_file(w, path));
    TRY(gltf_buffers(path, &buffers));
    for (size_t i = 0; i < buffers.n; i++)
        TRY(walk_file(w, buffers.path[i]));
done:
    gltf_buffers_free(&buffers);
    return st;
}

static status walk_section(struct walk *w, enum job_section_id section, const void *base);
static status walk_key(struct walk *w, const struct job_key *key, const void *base);
static status walk_sets(struct walk *w, const struct job_sets *sets);

/* Adds ".name" to the path; returns its length before, for path_back(). */
static size_t path_add(struct walk *w, const char *name)
{
    size_t n = strlen(w->path);
    snprintf(w->path + n, sizeof w->path - n, "%s%s", n ? "." : "", name);
    return n;
}

static size_t path_add_index(struct walk *w, size_t i)
{
    char number[24];
    snprintf(number, sizeof number, "%zu", i);
    return path_add(w, number);
}

static void path_back(struct walk *w, size_t n)
{
    w->path[n] = '\0';
}

static status walk_node(struct walk *w, const struct job_node *node)
{
    put_count(w, node != NULL);
    if (!node)
        return OK;
    bool shape = node->kind == NODE_SHAPE;
    enum job_section_id section = node_section(node);
    const char *name = shape ? job_sections[section].name : node_operators[node->kind];
    status st = OK;
    put_text(w, name);
    put_count(w, node->n_child);
    size_t back = path_add(w, name);
    TRY(walk_section(w, section, &node->u));
    for (size_t i = 0; i < node->n_child; i++) {
        size_t item = path_add_index(w, i);
        TRY(walk_node(w, node->child[i]));
        path_back(w, item);
    }
    path_back(w, back);
done:
    return st;
}

/* An edit or an operation is hashed in full in the frames in which it is applied. */
static status walk_deed(struct walk *w, enum job_section_id section, const void *item)
{
    status st = OK;
    const struct job_edit *edit = item;
    const struct job_operation *operation = item;
    const enum walk_part part = w->part;
    const struct frame_range when = section == SECTION_edit
                                        ? (struct frame_range){(int)edit->frame, (int)edit->frame, 1}
                                        : operation->frames;
    if (part == WALK_MOMENT && range_holds(when, w->frame)) {
        w->part = WALK_ALL;
        TRY(walk_section(w, section, item));
    }
done:
    w->part = part;
    return st;
}

static status walk_items(struct walk *w, const struct job_key *key, const void *base)
{
    const bool deeds = w->part != WALK_ALL && (key->child == SECTION_edit || key->child == SECTION_operation);
    const struct job_section *child = &job_sections[key->child];
    size_t n;
    const char *items = key_items(key, deeds && key->child == SECTION_edit ? w->whole : base, &n);
    status st = OK;
    if (!deeds)
        put_count(w, n);
    for (size_t i = 0; i < n; i++) {
        size_t back = path_add_index(w, i);
        TRY((deeds ? walk_deed : walk_section)(w, (enum job_section_id)key->child, items + i * child->size));
        path_back(w, back);
    }
done:
    return st;
}

/* Settings of an edit are hashed as the resulting job, independent of how they were written. Values that no edit changes are already
 * hashed. */
static status walk_sets(struct walk *w, const struct job_sets *sets)
{
    const struct job_section *s = &job_sections[SECTION_job];
    status st = OK;
    if (w->whole) /* the hash of a frame covers the job with its edits applied */
        return OK;
    put_count(w, sets->n);
    for (size_t i = 0; sets->n && i < s->n; i++)
        if (job_settable(s->key[i].name))
            TRY(walk_key(w, &s->key[i], sets->job));
done:
    return st;
}

/* The part that does not vary between frames of the keys that an edit may set. */
static status walk_settable(struct walk *w, const struct job *job)
{
    const struct job_section *s = &job_sections[SECTION_job];
    const enum walk_part part = w->part;
    status st = OK;
    w->part = WALK_STEADY;
    for (size_t i = 0; i < s->n; i++)
        if (job_settable(s->key[i].name))
            TRY(walk_key(w, &s->key[i], job));
    TRY(text_status(&w->canonical)); /* some walks are only compared */
done:
    w->part = part;
    return st;
}

static bool same_bytes(const struct text *a, const struct text *b)
{
    return a->size == b->size && memcmp(a->data, b->data, a->size) == 0;
}

/* What later edits make a model allocate from the start: whether any of them plants, and constants that differ from those of the job and
 * of the edit before. */
static status walk_ahead(struct walk *w)
{
    const struct job *job = w->whole;
    status st = OK;
    bool plants = false;
    struct walk base = {.whole = job}, last = {.whole = job}, next = {.whole = job};
    TRY(walk_settable(&base, job));
    TRY(walk_settable(&last, job));
    for (size_t i = 0; i < job->n_edits; i++) {
        const struct job_edit *edit = &job->edits[i];
        for (size_t k = 0; k < edit->n_paint; k++)
            plants |= edit->paint[k].vegetation > 0;
        if (!edit->set.job)
            continue;
        next.canonical.size = 0;
        TRY(walk_settable(&next, edit->set.job));
        if (same_bytes(&next.canonical, &base.canonical) || same_bytes(&next.canonical, &last.canonical))
            continue;
        text_add_bytes(&w->canonical, next.canonical.data, next.canonical.size);
        const struct text swap = last.canonical;
        last.canonical = next.canonical;
        next.canonical = swap;
    }
    put_count(w, plants);
done:
    text_free(&base.canonical);
    text_free(&last.canonical);
    text_free(&next.canonical);
    return st;
}

/* Whether the value of a key, or of a key inside it, can vary between frames. Nodes cannot. */
static bool key_has_moments(const struct job_key *key)
{
    static const enum key_type those[] = {KEY_CURVE, KEY_TRACK, KEY_SUB, KEY_MAYBE, KEY_LIST, KEY_MAP};
    bool has = false;
    for (size_t i = 0; i < sizeof those / sizeof *those; i++)
        has |= key->type == those[i];
    return has;
}

static status walk_key(struct walk *w, const struct job_key *key, const void *base)
{
    const void *member = key_member(key, base);
    const struct frame_range *ranges;
    const char *item;
    char **names;
    const double *points;
    const void *child;
    size_t n;
    switch (key->type) {
    case KEY_TEXT:
    case KEY_NAME:
        put_text(w, *(char *const *)member);
        break;
    case KEY_INPUT:
        return walk_input(w, *(char *const *)member);
    case KEY_NUM:
        put_number(w, *(const double *)member);
        break;
    case KEY_INT:
        put_number(w, (double)*(const int64_t *)member);
        break;
    case KEY_BOOL:
        put_count(w, *(const bool *)member);
        break;
    case KEY_CHOICE:
        item = choice_item(key->choices, *(const int *)member, &n);
        text_add_bytes(&w->canonical, item, n);
        put_text(w, "");
        break;
    case KEY_CURVE:
    case KEY_TRACK:
        put_curve(w, member, key->type == KEY_TRACK ? key->n : 1);
        break;
    case KEY_VEC:
        for (size_t i = 0; i < key->n; i++)
            put_number(w, ((const double *)member)[i]);
        break;
    case KEY_RANGE:
        put_range(w, *(const struct frame_range *)member);
        break;
    case KEY_POINTS:
        points = key_items(key, base, &n);
        put_count(w, n);
        for (size_t i = 0; i < n * key->n; i++)
            put_number(w, points[i]);
        break;
    case KEY_RANGES:
        ranges = key_items(key, base, &n);
        put_count(w, n);
        for (size_t i = 0; i < n; i++)
            put_range(w, ranges[i]);
        break;
    case KEY_NAMES:
    case KEY_TEXTS:
        names = key_items(key, base, &n);
        put_count(w, n);
        for (size_t i = 0; i < n; i++)
            put_text(w, names[i]);
        break;
    case KEY_SUB:
        return walk_section(w, (enum job_section_id)key->child, member);
    case KEY_MAYBE:
        child = *(void *const *)member;
        put_count(w, child != NULL);
        return child ? walk_section(w, (enum job_section_id)key->child, child) : OK;
    case KEY_SETS:
        return walk_sets(w, member);
    case KEY_LIST:
    case KEY_MAP:
        return walk_items(w, key, base);
    case KEY_NODE:
        return walk_node(w, *(struct job_node *const *)member);
    }
    return OK;
}

/* Whether the bytes from `at` on are those of the key's default; false for required keys. */
static status is_default(struct walk *w, enum job_section_id section, const struct job_key *key, size_t at,
                         bool *out)
{
    status st = OK;
    struct walk preset = {.of_files = w->of_files, .all = w->all, .part = w->part, .frame = w->frame};
    void *base = NULL;
    *out = false;
    if (key_required(key))
        return OK;
    TRY(memory_alloc(1, job_sections[section].size, key->name, &base));
    TRY(read_default(key, NULL, key->name, base));
    TRY(walk_key(&preset, key, base));
    TRY(text_status(&preset.canonical));
    const size_t n = w->canonical.size - at;
    *out = preset.canonical.size == n &&
           (n == 0 || memcmp(preset.canonical.data, w->canonical.data + at, n) == 0);
done:
    text_free(&preset.canonical);
    if (base)
        free_section(section, base);
    free(base);
    return st;
}

static bool wanted(const struct walk *w, const struct job_key *key)
{
    return w->only_inputs || w->all || (w->of_files ? key_files(key) : key_simulates(key));
}

/* The leaf of a section would follow those of its keys and is not recorded. */
static status add_leaf(struct walk *w)
{
    status st = memory_grow(&w->leaf, &w->leaf_capacity, w->n_leaves + 1, sizeof *w->leaf, "the job's keys");
    if (st == OK) {
        struct leaf *leaf = &w->leaf[w->n_leaves++];
        snprintf(leaf->path, sizeof leaf->path, "%s", w->path);
        leaf->end = w->canonical.size;
    }
    return st;
}

static status walk_section(struct walk *w, enum job_section_id section, const void *base)
{
    const struct job_section *s = &job_sections[section];
    status st = OK;
    for (size_t i = 0; i < s->n; i++) {
        const struct job_key *key = &s->key[i];
        bool leave = false;
        if (!wanted(w, key) || (w->part == WALK_MOMENT && !key_has_moments(key)))
            continue;
        const size_t back = path_add(w, key->name), before = w->canonical.size, leaves = w->n_leaves;
        put_text(w, key->name);
        const size_t at = w->canonical.size;
        TRY(walk_key(w, key, base));
        if (!w->of_files && key_later(key))
            TRY(is_default(w, section, key, at, &leave));
        if (leave) { /* with the leaves of its keys, which would end behind it */
            w->canonical.size = before;
            w->n_leaves = leaves;
        }
        if (w->leaves)
            TRY(add_leaf(w));
        path_back(w, back);
    }
done:
    return st;
}

static void walk_end(struct walk *w)
{
    text_free(&w->canonical);
    free(w->leaf);
    job_inputs_free(&w->inputs, w->n_inputs);
}

/* Of the cameras, only those of output.aov.cameras affect files. */
static status walk_cameras(struct walk *w, const struct job *job)
{
    status st = OK;
    const size_t back = path_add(w, "cameras");
    w->all = true;
    for (size_t i = 0; i < job->output.aov.n_cameras; i++)
        for (size_t c = 0; c < job->n_cameras; c++)
            if (strcmp(job->cameras[c].name, job->output.aov.cameras[i]) == 0) {
                const size_t name = path_add(w, job->cameras[c].name);
                TRY(walk_section(w, SECTION_camera, &job->cameras[c]));
                path_back(w, name);
            }
done:
    path_back(w, back);
    return st;
}

/* The same holds for the light. With its defaults it adds nothing, so that frames of releases without the key remain valid. */
static status walk_light(struct walk *w, const struct job *job)
{
    status st = OK;
    const struct job_key *key = table_find(SECTION_job, "light");
    const size_t back = path_add(w, "light"), before = w->canonical.size, leaves = w->n_leaves;
    bool preset = true;
    w->all = true;
    if (job->output.aov.n_cameras) {
        TRY(walk_key(w, key, job));
        TRY(is_default(w, SECTION_job, key, before, &preset));
        if (preset) {
            w->canonical.size = before;
            w->n_leaves = leaves;
        }
    }
done:
    path_back(w, back);
    return st;
}

static status walk_job(struct walk *w, const struct job *job)
{
    status st = OK;
    TRY(walk_section(w, SECTION_job, job));
    if (w->of_files) {
        TRY(walk_cameras(w, job));
        TRY(walk_light(w, job));
    } else
        put_number(w, job->frames.first);
    TRY(text_status(&w->canonical));
done:
    return st;
}

static status hash_of(struct walk *w, const struct job *job, uint64_t *hash)
{
    const status st = walk_job(w, job);
    if (st == OK)
        *hash = hash_bytes(w->canonical.data, w->canonical.size);
    walk_end(w);
    return st;
}

status job_hash(const struct job *job, uint64_t *hash)
{
    return hash_of(&(struct walk){0}, job, hash);
}

status job_files_hash(const struct job *job, uint64_t *hash)
{
    return hash_of(&(struct walk){.of_files = true}, job, hash);
}

status job_frame_hashes(const struct job *job, int last, uint64_t *hash)
{
    status st = OK;
    struct walk w = {.part = WALK_STEADY, .whole = job};
    TRY(walk_job(&w, job));
    TRY(walk_ahead(&w));
    for (int frame = job->frames.first; frame <= last; frame++) {
        const size_t at = (size_t)(frame - job->frames.first);
        const struct job *now = job_at(job, frame);
        w.part = WALK_MOMENT;
        w.frame = frame;
        TRY(walk_section(&w, SECTION_job, now));
        if (now != (at ? job_at(job, frame - 1) : job))
            TRY(walk_settable(&w, now));
        TRY(text_status(&w.canonical));
        hash[at] = hash_bytes(w.canonical.data, w.canonical.size);
        w.canonical.size = 0;
        put_count(&w, hash[at]);
    }
done:
    walk_end(&w);
    return st;
}

status job_states(const struct job *job, struct job_states *out)
{
    status st = OK;
    struct job_states s = {.first = job->frames.first};
    TRY(job_hash(job, &s.job));
    s.n = (size_t)(job->frames.last - job->frames.first) + 1;
    TRY(memory_alloc(s.n, sizeof *s.frame, "hashes of frames", &s.frame));
    TRY(job_frame_hashes(job, job->frames.last, s.frame));
    *out = s;
    s = (struct job_states){0};
done:
    job_states_free(&s);
    return st;
}

void job_states_free(struct job_states *states)
{
    free(states->frame);
    *states = (struct job_states){0};
}

uint64_t job_state(const struct job_states *s, int frame)
{
    const bool inside = frame >= s->first && (size_t)(frame - s->first) < s->n;
    return inside ? s->frame[frame - s->first] : s->job;
}

bool job_states_hold(const struct job_states *s, int frame, uint64_t hash)
{
    return hash == job_state(s, frame) || hash == s->job;
}

int job_states_differ(const struct job_states *one, const struct job_states *other)
{
    size_t i = 0;
    while (i < one->n && i < other->n && one->frame[i] == other->frame[i])
        i++;
    return one->first + (int)i;
}

/* The start of a leaf. */
static size_t leaf_begin(const struct walk *w, size_t i)
{
    return i ? w->leaf[i - 1].end : 0;
}

static bool same_leaf(const struct walk *a, const struct walk *b, size_t i)
{
    const size_t at = leaf_begin(a, i), other = leaf_begin(b, i), n = a->leaf[i].end - at;
    return strcmp(a->leaf[i].path, b->leaf[i].path) == 0 && b->leaf[i].end - other == n &&
           memcmp(a->canonical.data + at, b->canonical.data + other, n) == 0;
}

status job_differ(const struct job *one, const struct job *other, bool files, char path[256])
{
    status st = OK;
    struct walk a = {.leaves = true, .of_files = files}, b = {.leaves = true, .of_files = files};
    size_t i = 0;
    TRY(walk_job(&a, one));
    TRY(walk_job(&b, other));
    while (i < a.n_leaves && i < b.n_leaves && same_leaf(&a, &b, i))
        i++;
    snprintf(path, 256, "%s", i < b.n_leaves ? b.leaf[i].path : i < a.n_leaves ? a.leaf[i].path : "frames");
done:
    walk_end(&a);
    walk_end(&b);
    return st;
}

status job_is_default(const struct job *job, const char *name, bool *out)
{
    status st = OK;
    struct walk w = {.all = true};
    const struct job_key *key = table_find(SECTION_job, name);
    if (!key)
        return fail(E_USAGE, "a job has no key '%s'", name);
    TRY(walk_key(&w, key, job));
    TRY(is_default(&w, SECTION_job, key, 0, out));
done:
    walk_end(&w);
    return st;
}

status job_inputs(const struct job *job, struct job_input **out, size_t *n)
{
    struct walk w = {.only_inputs = true};
    status st = OK;
    *out = NULL;
    *n = 0;
    TRY(walk_section(&w, SECTION_job, job));
    TRY(text_status(&w.canonical));
    if (!w.inputs)
        TRY(memory_alloc(0, sizeof *w.inputs, "the job's input files", &w.inputs));
    *out = w.inputs;
    *n = w.n_inputs;
    w.inputs = NULL;
    w.n_inputs = 0;
done:
    walk_end(&w);
    return st;
}

void job_inputs_free(struct job_input **inputs, size_t n)
{
    for (size_t i = 0; *inputs && i < n; i++)
        free((*inputs)[i].path);
    free(*inputs);
    *inputs = NULL;
}
