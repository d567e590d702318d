#include "resample/resample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "resample/change.h"

bool resample_fits(struct resample *r)
{
    const double ratio = r->was.h / r->is.h;
    r->finer = ratio > 1;
    const double k = round(r->finer ? ratio : 1 / ratio);
    if (!(k >= 2 && k <= RESAMPLE_MOST) || fabs((r->finer ? ratio : 1 / ratio) / k - 1) > 1e-9)
        return false;
    r->k = (int)k;
    const struct spacing *fine = r->finer ? &r->is : &r->was, *coarse = r->finer ? &r->was : &r->is;
    for (int a = 0; a < 3; a++)
        if (fine->n[a] > r->k * coarse->n[a] || fine->n[a] <= r->k * (coarse->n[a] - 2))
            return false;
    return true;
}

void voxel_of(const struct spacing *s, const float P[4], int v[3])
{
    for (int a = 0; a < 3; a++)
        v[a] = (int)fmin(fmax(floor((double)(P[a] / (float)s->h)), 0), s->n[a] - 1);
}

/* ---- the old rock */

float resample_painted(float now, float first)
{
    if (first <= 0)
        return 1;
    return fabsf(now / first - 1) < 1e-5f ? 1 : now / first;
}

/* Compares the standing particles with those of the scene. */
static status compare_with_scene(struct change *c)
{
    status st = OK;
    struct standing *s = &c->standing;
    struct rock own = {0};
    TRY(scene_source_particles(c->before, s->at.bits, NULL, &own));
    for (size_t q = 0; q < own.n; q++) {
        int v[3];
        voxel_of(&c->r->was, own.P + 4 * q, v);
        const size_t i = voxel_set_index(&s->at, v), p = s->particle[i];
        if (c->was->id[p] != own.id[q] || memcmp(c->was->P + 4 * p, own.P + 4 * q, 4 * sizeof(float)) != 0)
            continue;
        s->first[i] = own.viability[q];
        s->rate[i] = resample_painted(c->was->rate_factor[p], own.rate_factor[q]);
        s->interlock[i] = resample_painted(c->was->interlock_factor[p], own.interlock_factor[q]);
    }
done:
    rock_free(&own);
    return st;
}

static status find_standing(struct change *c)
{
    status st = OK;
    struct standing *s = &c->standing;
    const struct rock *rock = c->was;
    int v[3];
    TRY(voxel_set_create(c->r->was.n, "voxels with rock", &s->at));
    TRY(voxel_set_create(c->r->was.n, "voxels with deposits", &c->deposits));
    for (size_t p = 0; p < rock->n; p++) {
        voxel_of(&c->r->was, rock->P + 4 * p, v);
        voxel_set_add(rock->phase[p] == 0 ? &s->at : &c->deposits, v);
    }
    TRY(voxel_set_rank(&s->at));
    TRY(voxel_set_rank(&c->deposits));
    const size_t n = voxel_set_count(&s->at);
    TRY(memory_alloc(n, sizeof *s->particle, "voxels with rock", &s->particle));
    float **const arrays[] = {&s->fill, &s->first, &s->rate, &s->interlock};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
        TRY(memory_alloc(n, sizeof(float), "voxels with rock", arrays[a]));
    for (size_t i = 0; i < n; i++)
        s->particle[i] = SIZE_MAX;
    for (size_t p = 0; p < rock->n; p++) {
        if (rock->phase[p] != 0)
            continue;
        voxel_of(&c->r->was, rock->P + 4 * p, v);
        const size_t i = voxel_set_index(&s->at, v);
        if (s->particle[i] == SIZE_MAX || rock->id[p] < rock->id[s->particle[i]])
            s->particle[i] = p;
        s->fill[i] = fminf(s->fill[i] + rock->viability[p], 1);
    }
    TRY(compare_with_scene(c));
done:
    return st;
}

static bool is_deep(const struct change *c, const int v[3])
{
    return c->deep && c->deep[voxel_set_word(&c->standing.at, v)] >> (v[0] % 32) & 1;
}

double change_ground(const struct change *c, const int at[3])
{
    const struct standing *s = &c->standing;
    int v[3];
    if (at[2] < 0)
        return 1;
    for (int a = 0; a < 3; a++)
        v[a] = at[a] < 0 ? 0 : at[a] < c->r->was.n[a] ? at[a] : c->r->was.n[a] - 1;
    if (is_deep(c, v) || voxel_set_has(&c->deposits, v))
        return 1;
    return voxel_set_has(&s->at, v) ? (double)s->fill[voxel_set_index(&s->at, v)] : 0;
}

/* ---- the new particles */

/* Appends a particle at a voxel: that of the scene, number `own` of it, with painted factors; or, if own is SIZE_MAX, one that takes its
 * values from particle `from` of the checkpoint. */
void change_append(struct change *c, const int v[3], const struct rock *scene, size_t own, float rate,
                   float interlock, size_t from, float viability)
{
    struct rock *is = &c->to->rock;
    const size_t p = is->n++;
    scene_source_position(c->scene, v, is->P + 4 * p);
    is->viability[p] = viability;
    if (own != SIZE_MAX) {
        is->id[p] = scene->id[own];
        is->layer[p] = scene->layer[own];
        is->rate_factor[p] = scene->rate_factor[own] * rate;
        is->interlock_factor[p] = scene->interlock_factor[own] * interlock;
    } else {
        is->id[p] = (uint32_t)c->to->n_ids++;
        is->layer[p] = c->was->layer[from];
        is->rate_factor[p] = c->was->rate_factor[from];
        is->interlock_factor[p] = c->was->interlock_factor[from];
    }
    is->phase[p] = from == SIZE_MAX ? 0 : c->was->phase[from];
    is->vegetation[p] = from == SIZE_MAX ? 0 : c->was->vegetation[from];
    if (is->exposed_kyr)
        is->exposed_kyr[p] = from == SIZE_MAX ? 0 : c->was->exposed_kyr[from];
}

/* Allocates room for n particles; none is there yet. */
status change_reserve(struct change *c, size_t n)
{
    status st = OK;
    if ((uint64_t)c->to->n_ids + n > UINT32_MAX)
        return fail(E_MEMORY, "the state at %g m has more than 2^32 particles: raise domain.spacing_m",
                    c->r->is.h);
    TRY(rock_alloc(&c->to->rock, n, STATE));
    if (c->was->exposed_kyr)
        TRY(rock_keep(&c->to->rock, ROCK_exposed_kyr));
    c->to->rock.n = 0;
done:
    return st;
}

static void standing_free(struct standing *s)
{
    voxel_set_destroy(&s->at);
    free(s->particle);
    free(s->fill);
    free(s->first);
    free(s->rate);
    free(s->interlock);
}

status resample_rock(const struct resample *r, const struct resample_from *from, struct resample_to *to)
{
    status st = OK;
    struct change c = {
        .r = r, .was = from->rock, .deep = from->deep, .before = from->scene, .scene = to->scene, .to = to};
    to->n_ids = scene_source_count(to->scene);
    TRY(voxel_set_create(r->is.n, "voxels without particles", &to->deep));
    TRY(find_standing(&c));
    TRY(r->finer ? change_finer(&c) : change_coarser(&c));
    TRY(voxel_set_rank(&to->deep));
done:
    standing_free(&c.standing);
    voxel_set_destroy(&c.deposits);
    return st;
}
