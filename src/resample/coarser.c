/* Rock at a larger spacing. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "resample/change.h"

/* ---- a larger spacing */

/* What is in the voxels of the new spacing. */
struct parents {
    struct voxel_set at;
    double *fill;             /* share of rock */
    double *own;              /* of it, rock of the scene */
    double *rate, *interlock; /* sums of painted factors, weighted by `own` */
    size_t *from; /* the particle of the checkpoint whose plants and age it gets; SIZE_MAX: none */
};

static void parents_free(struct parents *k)
{
    voxel_set_destroy(&k->at);
    free(k->fill);
    free(k->own);
    free(k->rate);
    free(k->interlock);
    free(k->from);
}

/* The new voxel in which an old one lies. */
static void parent_voxel(const struct resample *r, const int v[3], int parent[3])
{
    for (int a = 0; a < 3; a++)
        parent[a] = v[a] / r->k;
}

static status parents_create(const struct resample *r, const struct voxel_set *some, const uint32_t *more,
                             struct parents *k)
{
    status st = OK;
    TRY(voxel_set_create(r->is.n, "voxels", &k->at));
    for (size_t w = 0; w < some->words; w++)
        EACH_BIT(some->bits[w] | (more ? more[w] : 0), {
            int v[3], parent[3];
            voxel_set_at(some, w, bit, v);
            parent_voxel(r, v, parent);
            voxel_set_add(&k->at, parent);
        })
    TRY(voxel_set_rank(&k->at));
    double **const arrays[] = {&k->fill, &k->own, &k->rate, &k->interlock};
    const size_t n = voxel_set_count(&k->at);
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
        TRY(memory_alloc(n, sizeof(double), "voxels", arrays[a]));
    TRY(memory_alloc(n, sizeof *k->from, "voxels", &k->from));
    for (size_t i = 0; i < n; i++)
        k->from[i] = SIZE_MAX;
done:
    return st;
}

static size_t parent_of(const struct resample *r, const struct parents *k, const int v[3])
{
    int parent[3];
    parent_voxel(r, v, parent);
    return voxel_set_index(&k->at, parent);
}

/* Gathers standing and deep rock. */
static void gather_rock(const struct change *c, struct parents *k)
{
    const struct standing *s = &c->standing;
    const double part = 1 / pow(c->r->k, 3);
    for (size_t w = 0; w < s->at.words; w++) {
        int v[3];
        EACH_BIT(s->at.bits[w], {
            const size_t i = voxel_set_before(&s->at, w, bit), p = s->particle[i];
            voxel_set_at(&s->at, w, bit, v);
            const size_t to = parent_of(c->r, k, v);
            const double fill = (double)s->fill[i] * part;
            k->fill[to] += fill;
            if (s->first[i] > 0) {
                k->own[to] += fill;
                k->rate[to] += fill * (double)s->rate[i];
                k->interlock[to] += fill * (double)s->interlock[i];
            }
            if (k->from[to] == SIZE_MAX || c->was->vegetation[p] > c->was->vegetation[k->from[to]])
                k->from[to] = p;
        })
        EACH_BIT(c->deep ? c->deep[w] : 0, {
            voxel_set_at(&s->at, w, bit, v);
            const size_t to = parent_of(c->r, k, v);
            k->fill[to] += part;
            k->own[to] += part;
            k->rate[to] += part;
            k->interlock[to] += part;
        })
    }
}

static void gather_deposits(const struct change *c, struct parents *k)
{
    const double part = 1 / pow(c->r->k, 3);
    for (size_t p = 0; p < c->was->n; p++) {
        int v[3];
        if (c->was->phase[p] != 1)
            continue;
        voxel_of(&c->r->was, c->was->P + 4 * p, v);
        const size_t to = parent_of(c->r, k, v);
        k->fill[to] += part * (double)c->was->viability[p];
        if (k->from[to] == SIZE_MAX || c->was->id[p] < c->was->id[k->from[to]])
            k->from[to] = p;
    }
}

/* Appends a particle for each voxel. `scene`: their particles in the scene, in voxel order. */
static void append_parents(struct change *c, const struct parents *k, const struct rock *scene)
{
    size_t q = 0;
    for (size_t w = 0; w < k->at.words; w++)
        EACH_BIT(k->at.bits[w], {
            const size_t i = voxel_set_before(&k->at, w, bit);
            int v[3], its[3] = {-1, -1, -1};
            voxel_set_at(&k->at, w, bit, v);
            if (q < scene->n)
                voxel_of(&c->r->is, scene->P + 4 * q, its);
            const bool is_here = memcmp(v, its, sizeof v) == 0, own = is_here && k->own[i] > 0;
            if (k->fill[i] >= RESAMPLE_SLIVER && (own || k->from[i] != SIZE_MAX))
                change_append(c, v, scene, own ? q : SIZE_MAX, (float)(own ? k->rate[i] / k->own[i] : 1),
                              (float)(own ? k->interlock[i] / k->own[i] : 1), k->from[i],
                              (float)fmin(k->fill[i], 1));
            q += is_here;
        })
}

status change_coarser(struct change *c)
{
    status st = OK;
    struct parents rock = {0}, deposits = {0};
    struct rock scene = {0}, none = {0};
    TRY(parents_create(c->r, &c->standing.at, c->deep, &rock));
    TRY(parents_create(c->r, &c->deposits, NULL, &deposits));
    gather_rock(c, &rock);
    gather_deposits(c, &deposits);
    TRY(scene_source_particles(c->scene, rock.at.bits, NULL, &scene));
    TRY(change_reserve(c, voxel_set_count(&rock.at) + voxel_set_count(&deposits.at)));
    append_parents(c, &rock, &scene);
    append_parents(c, &deposits, &none);
done:
    parents_free(&rock);
    parents_free(&deposits);
    rock_free(&scene);
    return st;
}
