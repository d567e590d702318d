#include "frame/rocks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "particles/particles.h"
#include "scene/scene.h"

/* The most places for rocks in a horizontal section of the domain; a layer has a few of these above each other. */
static const double MOST_PLACES = 1 << 25;

status rocks_tile(const struct job *job, struct pile_tile *out)
{
    status st = OK;
    const struct job_piles *p = job_piles(job);
    const double *size = job->domain.size_m;
    *out = (struct pile_tile){0};
    if (!p)
        return OK;
    struct pile_options options = {.radius = p->rock_m,
                                   .rocks = (size_t)p->rocks,
                                   .erosion = p->erosion,
                                   .contacts = (size_t)p->contacts,
                                   .detail = 3,
                                   .seed = (uint32_t)job->seed};
    TRY(pile_tile_create(&options, out));
    double places = ceil(size[0] / out->side) * ceil(size[1] / out->side) * (double)out->n;
    if (places > MOST_PLACES || places * ceil(size[2] / out->side) > UINT32_MAX) {
        st = fail(
            E_USAGE,
            "piles.rock_m: rocks of %g m have %.3g places side by side in this domain, more than the %.3g that ids can number; raise it",
            p->rock_m, places, MOST_PLACES);
        pile_tile_destroy(out);
    }
done:
    return st;
}

uint32_t rocks_layer(const struct job *job)
{
    return (uint32_t)(job_model(job)->terrain ? job->n_strata + MATERIAL_ROCK - MATERIAL_SAND
                                              : job->n_strata - 1);
}

/* The bounding box of every shape. */
static status bound(const struct pile_tile *tile, struct frame_rocks *out)
{
    status st = memory_alloc(tile->n, sizeof *out->box, "rocks", &out->box);
    if (st != OK)
        return st;
    out->n_shapes = tile->n;
    for (size_t r = 0; r < tile->n; r++)
        for (size_t a = 0; a < 3; a++) {
            float lo = HUGE_VALF, hi = -HUGE_VALF;
            for (size_t i = 0; i < tile->rock[r].n_vertices; i++) {
                lo = fminf(lo, tile->rock[r].vertex[3 * i + a]);
                hi = fmaxf(hi, tile->rock[r].vertex[3 * i + a]);
            }
            out->box[r][0][a] = lo;
            out->box[r][1][a] = hi;
        }
    return OK;
}

static status place(const struct job *job, const struct pile_tile *tile, pile_layers layers, void *user,
                    struct frame_rocks *out)
{
    status st = OK;
    struct pile_place *at = NULL;
    struct rock *rock = &out->at;
    size_t n;
    if (tile->n == 0)
        return OK;
    TRY(pile_place_all(tile, job->domain.size_m, layers, user, &at, &n));
    TRY(bound(tile, out));
    out->wanted = true;
    rock->n = n;
    TRY(memory_alloc(4 * n, sizeof *rock->P, "rocks", &rock->P));
    TRY(memory_alloc(n, sizeof *rock->id, "rocks", &rock->id));
    TRY(memory_alloc(n, sizeof *rock->layer, "rocks", &rock->layer));
    for (size_t i = 0; i < n; i++) {
        for (size_t a = 0; a < 3; a++)
            rock->P[4 * i + a] = (float)at[i].at[a];
        rock->id[i] = at[i].id;
        rock->layer[i] = at[i].rock;
    }
done:
    free(at);
    return st;
}

/* ---- stacks */

static size_t rock_layers(void *user, double x, double y, double (*span)[2], size_t most)
{
    const struct stacks *s = user;
    size_t n, found = 0;
    int i = (int)(x / s->cell), j = (int)(y / s->cell);
    const uint32_t *layer =
        stacks_column(s, i < s->n[0] ? i : s->n[0] - 1, j < s->n[1] ? j : s->n[1] - 1, &n);
    for (size_t k = 0; k < n && found < most; k++)
        if (layer_material(layer[k]) == MATERIAL_ROCK) {
            span[found][0] = k ? layer_top(layer[k - 1]) * s->quantum : 0;
            span[found++][1] = layer_top(layer[k]) * s->quantum;
        }
    return found;
}

status rocks_on_stacks(const struct job *job, const struct stacks *s, const struct pile_tile *tile,
                       struct frame_rocks *out)
{
    struct stacks read = *s; /* the callback's argument is not const */
    return place(job, tile, rock_layers, &read, out);
}

/* ---- deposits */

enum { WIDEST = 3 };

/* One bit per voxel for deposits and one for other rock, stored by column, with an empty word at both ends of each column. */
struct held {
    int n[3], reach; /* voxels: half the width of the box that is averaged */
    double h;
    size_t words; /* of a column */
    uint64_t *loose, *solid;
};

static void hold(const struct rock *rock, struct held *d)
{
    for (size_t i = 0; i < rock->n; i++) {
        const float *p = rock->P + 4 * i;
        size_t x[3] = {0};
        bool inside = true;
        for (int a = 0; a < 3; a++) {
            double at = floor((double)p[a] / d->h);
            inside &= at >= 0 && at < d->n[a];
            x[a] = inside ? (size_t)at : 0;
        }
        uint64_t *bits = rock->phase[i] == PHASE_DEPOSIT ? d->loose : d->solid;
        if (inside)
            bits[(x[1] * (size_t)d->n[0] + x[0]) * d->words + 1 + x[2] / 64] |= 1ULL << (x[2] % 64);
    }
}

/* The number of voxels lo .. lo + n - 1 of a column that are set; n < 64, lo >= -64. */
static int count(const uint64_t *column, int lo, int n)
{
    size_t word = (size_t)(lo + 64) / 64, shift = (size_t)(lo + 64) % 64;
    uint64_t bits = column[word] >> shift | (shift ? column[word + 1] << (64 - shift) : 0);
    return __builtin_popcountll(bits & ((1ULL << n) - 1));
}

/* Whether voxel k of column (i, j) is in a smoothed layer of deposits: of the voxels around it that are not rock, at least half are
 * deposit. Rocks then do not change when the surface loses a grain here and gains one there. Below the floor is rock. */
static bool is_deposit(const struct held *d, int i, int j, int k)
{
    const int wide = 2 * d->reach + 1, below = k < d->reach ? d->reach - k : 0;
    int loose = 0, air = 0;
    for (int b = j - d->reach; b <= j + d->reach; b++)
        for (int a = i - d->reach; a <= i + d->reach; a++) {
            if (a < 0 || b < 0 || a >= d->n[0] || b >= d->n[1])
                continue;
            const size_t at = ((size_t)b * (size_t)d->n[0] + (size_t)a) * d->words;
            const int some = count(d->loose + at, k - d->reach, wide);
            loose += some;
            air += wide - below - some - count(d->solid + at, k - d->reach, wide);
        }
    return loose > 0 && loose >= air;
}

static size_t deposit_layers(void *user, double x, double y, double (*span)[2], size_t most)
{
    const struct held *d = user;
    int i = (int)(x / d->h), j = (int)(y / d->h);
    size_t found = 0;
    if (i >= d->n[0] || j >= d->n[1])
        return 0;
    for (int k = 0; k < d->n[2] && found < most; k++)
        if (is_deposit(d, i, j, k)) {
            span[found][0] = k * d->h;
            while (k < d->n[2] && is_deposit(d, i, j, k))
                k++;
            span[found++][1] = k * d->h;
        }
    return found;
}

status rocks_on_deposits(const struct job *job, const struct rock *rock, const struct pile_tile *tile,
                         struct frame_rocks *out)
{
    status st = OK;
    struct held d = {.h = job->domain.spacing_m};
    if (tile->n == 0)
        return OK;
    TRY(scene_voxels(job, d.n));
    d.reach = (int)fmin(fmax(ceil(tile->radius / d.h), 2), WIDEST);
    d.words = (size_t)(d.n[2] + 63) / 64 + 2;
    size_t n = (size_t)d.n[0] * (size_t)d.n[1] * d.words;
    TRY(memory_alloc(n, sizeof *d.loose, "deposits", &d.loose));
    TRY(memory_alloc(n, sizeof *d.solid, "deposits", &d.solid));
    if (rock->phase)
        hold(rock, &d);
    TRY(place(job, tile, deposit_layers, &d, out));
done:
    free(d.loose);
    free(d.solid);
    return st;
}
