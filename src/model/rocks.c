#include "model/rocks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "particles/particles.h"
#include "scene/scene.h"

/* Places for rocks side by side in a domain; a layer takes a few of those above each other. */
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
            "piles.rock_m: rocks of %g m have %.3g places side by side in this domain; raise it, at most "
            "%.3g can be told apart",
            p->rock_m, places, MOST_PLACES);
        pile_tile_destroy(out);
    }
done:
    return st;
}

/* The corners of every shape. */
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

/* Which voxels hold deposits, a bit each, column by column. */
struct held {
    int n[3];
    double h;
    size_t words; /* of a column */
    uint64_t *bit;
};

static bool is_held(const struct held *d, size_t column, int k)
{
    return d->bit[column * d->words + (size_t)k / 64] >> (k % 64) & 1;
}

static void hold(const struct rock *rock, struct held *d)
{
    for (size_t i = 0; i < rock->n; i++) {
        const float *p = rock->P + 4 * i;
        int x[3];
        bool inside = rock->phase[i] == PHASE_DEPOSIT;
        for (int a = 0; a < 3; a++) {
            double at = floor((double)p[a] / d->h);
            inside &= at >= 0 && at < d->n[a];
            x[a] = inside ? (int)at : 0;
        }
        if (inside)
            d->bit[((size_t)x[1] * (size_t)d->n[0] + (size_t)x[0]) * d->words + (size_t)x[2] / 64] |=
                1ULL << (x[2] % 64);
    }
}

static size_t deposit_layers(void *user, double x, double y, double (*span)[2], size_t most)
{
    const struct held *d = user;
    int i = (int)(x / d->h), j = (int)(y / d->h);
    size_t found = 0;
    if (i >= d->n[0] || j >= d->n[1])
        return 0;
    size_t column = (size_t)j * (size_t)d->n[0] + (size_t)i;
    for (int k = 0; k < d->n[2] && found < most; k++)
        if (is_held(d, column, k)) {
            span[found][0] = k * d->h;
            while (k < d->n[2] && is_held(d, column, k))
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
    d.words = (size_t)(d.n[2] + 63) / 64;
    TRY(memory_alloc((size_t)d.n[0] * (size_t)d.n[1] * d.words, sizeof *d.bit, "deposits", &d.bit));
    if (rock->phase)
        hold(rock, &d);
    TRY(place(job, tile, deposit_layers, &d, out));
done:
    free(d.bit);
    return st;
}
