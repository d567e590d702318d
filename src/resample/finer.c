/* Rock at a smaller spacing. Its deposits: heaps.c. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "resample/change.h"
#include "resample/split.h"

/* The number of a child among the k^3 of its parent, x fastest. */
static size_t child_number(const struct resample *r, const int child[3])
{
    return (size_t)(((child[2] % r->k) * r->k + child[1] % r->k) * r->k + child[0] % r->k);
}

/* The children of standing voxels: k^3 for each, in the order of the set. */
struct children {
    size_t each;
    struct rock own; /* their particles in the scene */
    uint32_t *place; /* index in `own` plus 1; 0: none */
    float *share;    /* of rock */
    bool *cut;       /* [voxels of the set]: it is cut by the smooth surface */
};

static void children_free(struct children *k)
{
    rock_free(&k->own);
    free(k->place);
    free(k->share);
    free(k->cut);
}

static status find_children(const struct change *c, struct children *k)
{
    status st = OK;
    const struct resample *r = c->r;
    const struct voxel_set *at = &c->standing.at;
    struct voxel_set set = {0};
    int v[3];
    k->each = (size_t)r->k * (size_t)r->k * (size_t)r->k;
    TRY(voxel_set_create(r->is.n, "voxels", &set));
    for (size_t w = 0; w < at->words; w++)
        EACH_BIT(at->bits[w], {
            voxel_set_at(at, w, bit, v);
            EACH_CHILD(r, v, { voxel_set_add(&set, child); })
        })
    TRY(scene_source_particles(c->scene, set.bits, NULL, &k->own));
    TRY(memory_alloc(k->each * voxel_set_count(at), sizeof *k->place, "voxels", &k->place));
    TRY(memory_alloc(k->each * voxel_set_count(at), sizeof *k->share, "voxels", &k->share));
    TRY(memory_alloc(voxel_set_count(at), sizeof *k->cut, "voxels", &k->cut));
    for (size_t q = 0; q < k->own.n; q++) {
        int parent[3];
        voxel_of(&r->is, k->own.P + 4 * q, v);
        for (int a = 0; a < 3; a++)
            parent[a] = v[a] / r->k;
        k->place[k->each * voxel_set_index(at, parent) + child_number(r, v)] = (uint32_t)q + 1;
    }
done:
    voxel_set_destroy(&set);
    return st;
}

/* Is a voxel, and are those around it, still as the scene has them? */
static bool is_untouched(const struct change *c, const int v[3])
{
    const struct standing *s = &c->standing;
    for (int e = 0; e < 27; e++) {
        int at[3] = {v[0] + e % 3 - 1, v[1] + e / 3 % 3 - 1, v[2] + e / 9 - 1};
        for (int a = 0; a < 3; a++)
            at[a] = at[a] < 0 ? 0 : at[a] < c->r->was.n[a] ? at[a] : c->r->was.n[a] - 1;
        if (voxel_set_has(&s->at, at)) {
            const size_t i = voxel_set_index(&s->at, at);
            if (s->first[i] <= 0 || s->fill[i] < s->first[i])
                return false;
        } else if (change_ground(c, at) < 1 && scene_source_has(c->before, at))
            return false; /* there was rock */
    }
    return true;
}

/* What children have in the scene. */
static void scene_shares(const struct children *k, size_t i, float *most)
{
    for (size_t e = 0; e < k->each; e++) {
        const uint32_t place = k->place[k->each * i + e];
        most[e] = place ? k->own.viability[place - 1] : 0;
    }
}

/* Divides an untouched voxel, or marks it as one to be cut. */
static void sort_out(const struct change *c, const int v[3], size_t i, struct children *k)
{
    const struct standing *s = &c->standing;
    float most[SPLIT_VOXELS];
    k->cut[i] = !is_untouched(c, v);
    if (k->cut[i])
        return;
    scene_shares(k, i, most);
    split_evenly(k->each, (double)s->fill[i], (double)s->first[i], most, k->share + k->each * i);
}

/* Cuts a voxel by the smooth surface at `level`. Returns how much rock there is now more than before, in 2^-20 of a small voxel; integers,
 * so that sums do not depend on threads. */
static int64_t cut(const struct change *c, const int v[3], size_t i, double level, struct children *k)
{
    const struct standing *s = &c->standing;
    float most[SPLIT_VOXELS], *share = k->share + k->each * i;
    double near[27], sum = -(double)s->fill[i] * (double)k->each;
    scene_shares(k, i, most);
    for (int e = 0; e < 27; e++)
        near[e] = change_ground(c, (const int[]){v[0] + e % 3 - 1, v[1] + e / 3 % 3 - 1, v[2] + e / 9 - 1});
    for (size_t e = 0; e < k->each; e++) {
        const double below = split_smooth(near, level, c->r->k, (int)e),
                     rock = s->first[i] > 0 ? fmin(below, (double)most[e]) : below;
        share[e] = rock < RESAMPLE_SLIVER ? 0 : (float)rock;
        sum += (double)share[e];
    }
    return llround(ldexp(sum, 20));
}

static void sort_out_all(const struct change *c, struct children *k)
{
    const struct voxel_set *at = &c->standing.at;
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t w = 0; w < at->words; w++) {
        int v[3];
        EACH_BIT(at->bits[w], {
            voxel_set_at(at, w, bit, v);
            sort_out(c, v, voxel_set_before(at, w, bit), k);
        })
    }
}

/* Returns how much more rock there is at this level, in small voxels. */
static double cut_all(const struct change *c, double level, struct children *k)
{
    const struct voxel_set *at = &c->standing.at;
    int64_t more = 0;
#pragma omp parallel for schedule(dynamic, 256) reduction(+ : more)
    for (size_t w = 0; w < at->words; w++) {
        int v[3];
        EACH_BIT(at->bits[w], {
            const size_t i = voxel_set_before(at, w, bit);
            voxel_set_at(at, w, bit, v);
            more += k->cut[i] ? cut(c, v, i, level, k) : 0;
        })
    }
    return ldexp((double)more, -20);
}

/* Finds the level at which there is as much rock as before, by secants: near 1/2 the volume is almost linear in it. */
static void cut_alike(const struct change *c, struct children *k)
{
    enum { TRIES = 6 };
    double level[2] = {0.5, 0.49}, more[2];
    const double enough = 1e-6 * (double)(k->each * voxel_set_count(&c->standing.at));
    more[0] = cut_all(c, level[0], k);
    for (int i = 0; i < TRIES && fabs(more[0]) > enough; i++) {
        more[1] = cut_all(c, level[1], k);
        const double slope = (more[1] - more[0]) / (level[1] - level[0]);
        level[0] = level[1];
        more[0] = more[1];
        if (!(slope < 0))
            break;
        level[1] = fmin(fmax(level[1] - more[1] / slope, 0.4), 0.6);
    }
}

/* Deep rock stays deep if it is full and unpainted at the new spacing, too; *rest receives the particles of the others. */
static status divide_deep(struct change *c, struct rock *rest)
{
    status st = OK;
    const struct resample *r = c->r;
    struct voxel_set set = {0}, *deep = &c->to->deep;
    size_t n;
    if (!c->deep)
        return OK;
    TRY(voxel_set_create(r->is.n, "voxels", &set));
    for (size_t w = 0; w < c->standing.at.words; w++)
        EACH_BIT(c->deep[w], {
            int v[3];
            voxel_set_at(&c->standing.at, w, bit, v);
            EACH_CHILD(r, v, voxel_set_add(&set, child);)
        })
    scene_source_uniform(c->scene, deep->bits, &n);
    for (size_t w = 0; w < set.words; w++)
        deep->bits[w] &= set.bits[w];
    TRY(scene_source_particles(c->scene, set.bits, deep->bits, rest));
done:
    voxel_set_destroy(&set);
    return st;
}

static void append_children(struct change *c, const struct children *k)
{
    const struct standing *s = &c->standing;
    for (size_t w = 0; w < s->at.words; w++)
        EACH_BIT(s->at.bits[w], {
            int v[3];
            const size_t i = voxel_set_before(&s->at, w, bit);
            voxel_set_at(&s->at, w, bit, v);
            EACH_CHILD(c->r, v, {
                const size_t at = k->each * i + (size_t)e;
                const bool own = s->first[i] > 0 && k->place[at];
                if (k->share[at] > 0)
                    change_append(c, child, &k->own, own ? k->place[at] - 1 : SIZE_MAX, s->rate[i],
                                  s->interlock[i], s->particle[i], k->share[at]);
            })
        })
}

status change_finer(struct change *c)
{
    status st = OK;
    const struct resample *r = c->r;
    struct children k = {0};
    struct rock rest = {0};
    TRY(find_children(c, &k));
    sort_out_all(c, &k);
    cut_alike(c, &k);
    TRY(divide_deep(c, &rest));
    TRY(change_reserve(c, k.each * voxel_set_count(&c->standing.at) + heaps_most(c) + rest.n));
    append_children(c, &k);
    for (size_t q = 0; q < rest.n; q++) {
        int v[3];
        voxel_of(&r->is, rest.P + 4 * q, v);
        change_append(c, v, &rest, q, 1, 1, SIZE_MAX, rest.viability[q]);
    }
    TRY(heaps_divide(c));
done:
    children_free(&k);
    rock_free(&rest);
    return st;
}
