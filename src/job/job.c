#include "job/job.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "job/parse.h"
#include "job/values.h"
#include "shared/params.h"
#include "system/atomic_file.h"

static void free_node(struct job_node *node)
{
    if (!node)
        return;
    for (size_t i = 0; i < node->n_child; i++)
        free_node(node->child[i]);
    free(node->child);
    free_section(node_section(node), &node->u);
    free(node);
}

void free_section(enum job_section_id section, void *base)
{
    const struct job_section *s = &job_sections[section];
    for (size_t i = 0; i < s->n; i++) {
        const struct job_key *key = &s->key[i];
        void *member = key_member(key, base);
        size_t n = 0;
        char *items;
        switch (key->type) {
        case KEY_TEXT:
        case KEY_NAME:
        case KEY_INPUT:
            free(*(char **)member);
            break;
        case KEY_CURVE:
        case KEY_TRACK:
            free(((struct curve *)member)->frame); /* `value` is the second half of the same allocation */
            break;
        case KEY_SUB:
            free_section((enum job_section_id)key->child, member);
            break;
        case KEY_LIST:
        case KEY_MAP:
            items = key_items(key, base, &n);
            for (size_t k = 0; k < n; k++)
                free_section((enum job_section_id)key->child, items + k * job_sections[key->child].size);
            free(items);
            break;
        case KEY_NODE:
            free_node(*(struct job_node **)member);
            break;
        case KEY_MAYBE:
            items = *(char **)member;
            if (items)
                free_section((enum job_section_id)key->child, items);
            free(items);
            break;
        case KEY_SETS:
            free_sets(member);
            break;
        case KEY_POINTS:
        case KEY_RANGES:
            free(key_items(key, base, &n));
            break;
        case KEY_NAMES:
        case KEY_TEXTS:
            items = key_items(key, base, &n);
            for (size_t k = 0; k < n; k++)
                free(((char **)(void *)items)[k]);
            free(items);
            break;
        case KEY_NUM:
        case KEY_INT:
        case KEY_BOOL:
        case KEY_CHOICE:
        case KEY_VEC:
        case KEY_RANGE:
            break;
        }
    }
}

void job_destroy(struct job **job)
{
    if (!*job)
        return;
    free_section(SECTION_job, *job);
    free(*job);
    *job = NULL;
}

/* The absolute folder of `path`, released with free(). */
static status folder_of(const char *path, char **out)
{
    char *copy = NULL;
    status st = memory_strdup(path, &copy);
    if (st != OK)
        return st;
    char *slash = strrchr(copy, '/');
    if (slash)
        slash[slash == copy] = '\0';
    *out = realpath(slash ? copy : ".", NULL);
    if (!*out)
        st = fail(E_INPUT, "%s: %s", path, strerror(errno));
    free(copy);
    return st;
}

/* The folder of the target if `path` is a symbolic link, else NULL. */
static status folder_behind(const char *path, char **out)
{
    struct stat info;
    *out = NULL;
    if (lstat(path, &info) != 0 || !S_ISLNK(info.st_mode))
        return OK;
    char *real = realpath(path, NULL);
    const status st = real ? folder_of(real, out) : fail(E_INPUT, "%s: %s", path, strerror(errno));
    free(real);
    return st;
}

const struct job *job_at(const struct job *job, int frame)
{
    const struct job *now = job;
    for (size_t i = 0; i < job->n_edits && job->edits[i].frame <= frame; i++)
        if (job->edits[i].set.job)
            now = job->edits[i].set.job;
    return now;
}

const struct job_model *job_model(const struct job *job)
{
#define MODEL(constant, word, ...) [MODEL_##constant] = {.name = #word, __VA_ARGS__},
    static const struct job_model models[] = {JOB_MODELS(MODEL)};
#undef MODEL
    return &models[job->model];
}

#define PROCESS(constant, word, models, stacked, color, legend, meaning)                                     \
    [PROCESS_##constant] = {#word, models, color, legend, meaning},
const struct job_process job_processes[PROCESSES] = {JOB_PROCESSES(PROCESS)};
#undef PROCESS

bool job_has_process(const struct job *job, enum process process)
{
    return job_processes[process].models >> job->model & 1;
}

bool job_has_processes(const struct job *job)
{
    bool any = false;
    for (int p = 0; p < PROCESSES; p++)
        any |= job_has_process(job, (enum process)p);
    return any;
}

unsigned job_walls(const struct job *job)
{
    const struct job_sides *s = &job->domain.sides;
    return (s->x_min == SIDE_X_MIN_WALL ? WALL_X_MIN : 0) | (s->x_max == SIDE_X_MAX_WALL ? WALL_X_MAX : 0) |
           (s->y_min == SIDE_Y_MIN_WALL ? WALL_Y_MIN : 0) | (s->y_max == SIDE_Y_MAX_WALL ? WALL_Y_MAX : 0);
}

const struct job_piles *job_piles(const struct job *job)
{
    const size_t offset = job_model(job)->piles;
    const struct job_piles *p = (const void *)((const char *)job + offset);
    return offset && p->rock_m > 0 ? p : NULL;
}

bool job_marks(const struct job *job, int frame)
{
    for (size_t i = 0; i < job->checkpoint.n_mark; i++)
        if (range_holds(job->checkpoint.mark[i], frame))
            return true;
    return false;
}

bool job_writes(const struct job *job, enum job_files kind, int frame)
{
    const struct job_vdb *vdb = &job->output.vdb;
    int64_t every = kind == JOB_PICTURES                      ? job->output.aov.every
                    : kind == JOB_POINTS && vdb->points_every ? vdb->points_every
                                                              : vdb->every;
    return (frame - job->frames.first) % every == 0 || frame == job->frames.last;
}

double job_years(const struct job *job, int from, int to)
{
    double years = 0;
    for (size_t i = 0; i < job->n_edits && from < to; i++) {
        int before = (int)job->edits[i].frame - 1;
        if (before > from) {
            int last = before < to ? before : to;
            years += (last - from) * job_at(job, last)->clock.years_per_frame;
            from = last;
        }
    }
    return years + (to - from) * job_at(job, to)->clock.years_per_frame;
}

bool job_wants_layer(const struct job *job, const char *layer)
{
    const struct job_aov *a = &job->output.aov;
    for (size_t i = 0; i < a->n_layers; i++)
        if (strcmp(a->layers[i], layer) == 0)
            return true;
    for (int v = 1; v < VALUES && a->n_layers == 0; v++)
        if (!job_may_have(job, value_table[v].has) && strcmp(layer, value_table[v].layer) == 0)
            return false;
    return a->n_layers == 0;
}

bool job_may_have(const struct job *job, unsigned has)
{
    return has == HAS_EXPOSED ? job_keeps_exposed(job) : has == HAS_SEEPAGE ? job_seeps(job) : true;
}

bool job_seeps(const struct job *job)
{
    bool any = job->groundwater.recharge_m_per_yr > 0;
    for (size_t i = 0; i < job->n_edits; i++)
        any |= job->edits[i].set.job && job->edits[i].set.job->groundwater.recharge_m_per_yr > 0;
    return any;
}

static bool exposes(const struct job *job)
{
    return job->skin.exposed || job->skin.crust > 1 || job->skin.damp > 1;
}

bool job_keeps_exposed(const struct job *job)
{
    bool any = exposes(job);
    for (size_t i = 0; i < job->n_edits; i++)
        any |= job->edits[i].set.job && exposes(job->edits[i].set.job);
    return any;
}

double job_weak(const struct job *job, size_t i, double frame)
{
    return curve_at(&job->strata[i].weak_m_per_kyr, frame) * curve_at(&job->strata_scale.rates, frame);
}

double job_strong(const struct job *job, size_t i, double frame)
{
    return curve_at(&job->strata[i].strong_m_per_kyr, frame) * curve_at(&job->strata_scale.rates, frame);
}

double job_interlock(const struct job *job, size_t i, double frame)
{
    return curve_at(&job->strata[i].interlock_MPa, frame) * curve_at(&job->strata_scale.interlock, frame);
}

size_t job_layer_at(const struct job *job, double z)
{
    size_t layer = 0;
    while (layer + 1 < job->n_strata && z >= job->strata[layer].to_m)
        layer++;
    return layer;
}

status job_load(const char *path, const char *const *sets, size_t n_sets, struct job **out)
{
    const struct yaml_source source = {.file = path};
    struct yaml_tree tree = {0};
    struct yaml *root = NULL;
    struct job *job = NULL;
    char *bytes = NULL, *folder = NULL, *behind = NULL;
    size_t n = 0;
    status st = OK;
    *out = NULL;
    TRY(file_read(path, YAML_BYTES, &bytes, &n));
    TRY(folder_of(path, &folder));
    TRY(folder_behind(path, &behind));
    TRY(yaml_parse(&tree, bytes, n, &source, &root));
    if (root->kind != YAML_MAP) {
        st = yaml_fail(root, NULL,
                       "%s where a mapping of keys is expected (hoodoo: 1, name: ...; see jobs/README.md)",
                       yaml_what(root));
        goto done;
    }
    for (size_t i = 0; i < n_sets; i++)
        TRY(job_set(&tree, root, sets[i]));
    TRY(memory_alloc(1, sizeof *job, "the job", &job));
    TRY(read_section(SECTION_job, root, NULL, folder, job));
    TRY(read_default_layer(root, job));
    read_default_clock(root, job);
    read_default_sides(root, job);
    read_default_pivot(root, job);
    TRY(check_job(root, job));
    TRY(read_edited_jobs(&tree, root, folder, job));
    if (behind)
        TRY(map_beside_link(job, folder, behind));
    TRY(read_wedge_csv(folder, behind, job));
    *out = job;
    job = NULL;
done:
    job_destroy(&job);
    yaml_free(&tree);
    free(folder);
    free(behind);
    free(bytes);
    return st;
}

bool job_sizes_heightfield(const struct job_heightfield *h)
{
    return h->max_m[0] != 0 || h->max_m[1] != 0;
}

bool job_heights_are_metres(const struct job_heightfield *h)
{
    return h->scale_m == 0 && !job_sizes_heightfield(h) && h->max_m[2] == 0;
}
