#include "voxels/voxels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geology/attitude.h"

/* ---- geometry */

static struct voxels_params geometry(const int n[3], int margin)
{
    struct voxels_params g = {.nx = (uint)n[0], .ny = (uint)n[1], .nz = (uint)n[2], .margin = (uint)margin};
    g.row = (g.nx + 31) / 32 + 1;
    g.rows = g.ny + 2 * g.margin;
    g.slab = g.row * g.rows;
    g.words = 2 + g.slab * (g.nz + 2 * g.margin);
    g.per_row = 1.0f / (float)g.row;
    g.per_slab = 1.0f / (float)g.slab;
    g.brick_rows = (g.rows + VOXELS_BRICK - 1) / VOXELS_BRICK;
    g.brick_slabs = (g.nz + 2 * g.margin + VOXELS_BRICK - 1) / VOXELS_BRICK;
    g.reach = (g.margin + VOXELS_BRICK - 1) / VOXELS_BRICK;
    return g;
}

static size_t domain_words(const struct voxels_params *g)
{
    return (size_t)g->slab * g->nz;
}

static size_t bricks(const struct voxels_params *g)
{
    return (size_t)g->row * g->brick_rows * g->brick_slabs;
}

struct voxels_params voxels_params(const struct voxels *v, size_t n)
{
    struct voxels_params k = v->grid;
    k.n = (uint)n;
    return k;
}

size_t voxels_number(const struct voxels *v, int x, int y, int z)
{
    const struct voxels_params *g = &v->grid;
    return (1 + ((size_t)z + g->margin) * g->slab + ((size_t)y + g->margin) * g->row) * 32 + (size_t)x;
}

static int skin_of(const struct job *job)
{
    double skin_m = job->goblins.skin_m, most = skin_m > 0 ? SKIN_MAX : SKIN_EVEN;
    if (!(skin_m > 0)) {
        skin_m = INFINITY;
        for (size_t i = 0; i < job->n_strata; i++)
            skin_m = fmin(skin_m, job->strata[i].bubble.radius_m / 2);
    }
    return (int)fmin(fmax(round(skin_m / job->domain.spacing_m), 1), most);
}

/* Upper bound of the reach of the job's bubbles in y and z, and of the skin, in voxels. */
static int margin_of(const struct job *job)
{
    double reach = 1;
    for (size_t i = 0; i < job->n_strata; i++)
        for (int a = 1; a < 3; a++) {
            const struct job_bubble *b = &job->strata[i].bubble;
            reach = fmax(reach, (b->stretch[a] + fabs(b->offset[a])) * b->radius_m / job->domain.spacing_m);
        }
    int skin = skin_of(job), margin = reach < BUBBLE_REACH_MAX ? (int)reach : BUBBLE_REACH_MAX;
    return margin > skin ? margin : skin;
}

uint64_t voxels_bytes(const struct job *job, const int n[3], size_t n_active, size_t *words)
{
    struct voxels_params g = geometry(n, margin_of(job));
    *words = domain_words(&g) + 2;
    return (uint64_t)g.words * (3 * 4 + 64 * 4) + domain_words(&g) * 4 + bricks(&g) * 8 + n_active * 4 +
           (attitude_is_level(job) ? 0 : (uint64_t)g.words * 64);
}

/* ---- tables */

struct tables {
    uint32_t *rows, *bubbles, *layer_of;
    size_t n_rows, n_layer_of;
};

static void add_row(struct tables *t, int64_t first, uint32_t run)
{
    t->rows[t->n_rows++] = (uint32_t)first; /* added to a voxel's number, modulo 2^32 */
    t->rows[t->n_rows++] = run;
}

/* The skin's ball: offset of each row in words, and its reach to either side. */
static void add_skin(struct voxels *v, struct tables *t)
{
    struct voxels_params *g = &v->grid;
    g->skin_first = (uint)t->n_rows;
    for (int dz = -v->skin; dz <= v->skin; dz++)
        for (int dy = -v->skin; dy <= v->skin; dy++) {
            int rest = v->skin * v->skin - dy * dy - dz * dz;
            if (rest < 0)
                continue;
            add_row(t, (int64_t)dz * g->slab + (int64_t)dy * g->row, (uint32_t)sqrt((double)rest));
            g->skin_rows++;
        }
}

/* Strata by slab, or where beds are not level by voxel, two to a word. */
static status find_layers(const struct voxels *v, const struct job *job, struct tables *t)
{
    status st = OK;
    t->n_layer_of = v->grid.tilted ? 16 * (size_t)v->grid.words : (size_t)v->n[2];
    TRY(memory_alloc(t->n_layer_of, 4, "the layers", &t->layer_of));
    if (!v->grid.tilted) {
        for (int z = 0; z < v->n[2]; z++)
            t->layer_of[z] = (uint32_t)job_layer_at(job, (z + 0.5) * v->h);
        return OK;
    }
#pragma omp parallel for schedule(static)
    for (int z = 0; z < v->n[2]; z++)
        for (int y = 0; y < v->n[1]; y++)
            for (int x = 0; x < v->n[0]; x++) {
                const double at[3] = {(x + 0.5) * v->h, (y + 0.5) * v->h, (z + 0.5) * v->h};
                const size_t number = voxels_number(v, x, y, z);
                t->layer_of[number / 2] |= (uint32_t)attitude_layer(job, at) << 16 * (number % 2);
            }
done:
    return st;
}

static status bubble_of(const struct job *job, size_t stratum, struct bubble *b)
{
    status st = OK;
    TRY(bubble_create(&job->strata[stratum].bubble, job->domain.spacing_m, b));
    if (!isfinite(bubble_rate(b, 0, 1).slope))
        st = fail(E_USAGE, "bubble: that of stratum %zu sees no air beside a flat face", stratum);
done:
    return st;
}

status voxels_check(const struct job *job)
{
    status st = OK;
    struct bubble *b = NULL;
    TRY(memory_alloc(1, sizeof *b, "a bubble", &b));
    for (size_t i = 0; i < job->n_strata; i++)
        TRY(bubble_of(job, i, b));
done:
    free(b);
    return st;
}

static status make_tables(struct voxels *v, const struct job *job, struct bubble *b, struct tables *t)
{
    status st = OK;
    const struct voxels_params *g = &v->grid;
    TRY(memory_alloc((job->n_strata + 1) * (BUBBLE_ROWS_MAX + 3), 8, "the bubbles' rows", &t->rows));
    TRY(memory_alloc(job->n_strata, 12, "the bubbles", &t->bubbles));
    TRY(memory_alloc(job->n_strata, sizeof *v->rate, "the layers", &v->rate));
    for (size_t i = 0; i < job->n_strata; i++) {
        TRY(bubble_of(job, i, b));
        t->bubbles[3 * i] = (uint32_t)t->n_rows;
        t->bubbles[3 * i + 2] = b->n;
        for (int r = 0; r < b->n_rows; r++) {
            const struct bubble_row *row = &b->row[r];
            int64_t words = (int64_t)row->dz * g->slab + (int64_t)row->dy * g->row;
            add_row(t, 32 * words + row->low, (uint32_t)((UINT64_C(2) << (row->high - row->low)) - 1));
        }
        while ((t->n_rows - t->bubbles[3 * i]) % 8)
            add_row(t, 0, 0); /* the kernel takes four rows at a time */
        t->bubbles[3 * i + 1] = (uint32_t)((t->n_rows - t->bubbles[3 * i]) / 2);
        v->rate[i] = bubble_rate(b, job->goblins.threshold, v->skin);
    }
    add_skin(v, t);
    TRY(find_layers(v, job, t));
done:
    return st;
}

static status upload_tables(struct gpu *gpu, struct voxels *v, const struct job *job)
{
    status st = OK;
    struct tables t = {0};
    struct bubble *b = NULL;
    TRY(memory_alloc(1, sizeof *b, "a bubble", &b));
    TRY(make_tables(v, job, b, &t));
    TRY(gpu_buffer_create(gpu, "bubble rows", t.n_rows, 4, &v->rows));
    TRY(gpu_buffer_create(gpu, "bubbles", 3 * job->n_strata, 4, &v->bubbles));
    TRY(gpu_buffer_create(gpu, "layers by slab or voxel", t.n_layer_of, 4, &v->layer_of));
    TRY(gpu_buffer_create(gpu, "layers", job->n_strata, 16, &v->layers));
    TRY(gpu_buffer_create(gpu, "paces", 2 * VOXELS_PACERS, 4, &v->paces));
    TRY(gpu_upload(gpu, v->rows, 0, t.rows, t.n_rows));
    TRY(gpu_upload(gpu, v->bubbles, 0, t.bubbles, 3 * job->n_strata));
    TRY(gpu_upload(gpu, v->layer_of, 0, t.layer_of, t.n_layer_of));
done:
    free(b);
    free(t.rows);
    free(t.bubbles);
    free(t.layer_of);
    return st;
}

/* ---- start */

/* Converts a non-negative number to half precision, rounded to nearest; at most 65504. */
static uint32_t half_of(float x)
{
    uint32_t bits;
    x = fminf(x, 65504.0f);
    if (x < 6.103515625e-5f)
        return (uint32_t)lrintf(x * 16777216.0f);
    memcpy(&bits, &x, sizeof bits);
    return (bits + 0xfff + (bits >> 13 & 1) - (112u << 23)) >> 13;
}

static float half_value(uint32_t half)
{
    uint32_t bits = (half << 13) + (112u << 23);
    float x;
    if (half < 0x400)
        return (float)half / 16777216.0f;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Converts one slab of the domain to the device's layout. */
static void pack_slab(const struct voxels *v, const float *share, const float *factor, uint32_t *rock,
                      float *left, uint32_t *state)
{
    const struct voxels_params *g = &v->grid;
    memset(rock, 0, g->slab * 4);
    memset(left, 0, (size_t)g->slab * 128);
    for (uint y = 0; y < g->ny; y++)
        for (uint x = 0; x < g->nx; x++, share++, factor++) {
            size_t bit = ((size_t)y + g->margin) * g->row * 32 + x;
            state[bit] = half_of(*factor) << 16 | VOXELS_UNKNOWN;
            if (*share > VOXELS_SLIVER) {
                left[bit] = *share;
                rock[bit / 32] |= 1u << (bit % 32);
            }
        }
}

static status upload_rock(struct gpu *gpu, struct voxels *v, bool floats, const float *share,
                          const float *factor)
{
    status st = OK;
    const struct voxels_params *g = &v->grid;
    uint32_t *rock = NULL, *state = NULL;
    float *left = NULL;
    TRY(memory_alloc(g->slab, 4, "a slab of voxels", &rock));
    TRY(memory_alloc((size_t)g->slab * 32, 4, "a slab of voxels", &state));
    TRY(memory_alloc((size_t)g->slab * 32, 4, "a slab of voxels", &left));
    memset(rock, floats ? 0 : 0xff, g->slab * 4);
    for (uint z = 0; z < g->margin; z++)
        TRY(gpu_upload(gpu, v->bits, g->words + 1 + (size_t)z * g->slab, rock, g->slab));
    for (uint z = 0; z < g->nz; z++) {
        size_t from = (size_t)z * g->nx * g->ny, word = 1 + ((size_t)z + g->margin) * g->slab;
        pack_slab(v, share + from, factor + from, rock, left, state);
        TRY(gpu_upload(gpu, v->bits, g->words + word, rock, g->slab));
        TRY(gpu_upload(gpu, v->left, 32 * word, left, 32 * (size_t)g->slab));
        TRY(gpu_upload(gpu, v->state, 32 * word, state, 32 * (size_t)g->slab));
    }
done:
    free(rock);
    free(state);
    free(left);
    return st;
}

/* Fills the margin behind walls with the mirror image. */
static void mirror(struct gpu *gpu, struct voxels *v)
{
    const struct voxels_params k = voxels_params(v, domain_words(&v->grid));
    if (k.walls)
        GPU_RUN(gpu, voxels_mirror, k.n, k, v->bits);
}

static status refresh(struct gpu *gpu, struct gpu_work *work, struct voxels *v);

status voxels_create(struct gpu *gpu, struct gpu_work *work, const struct job *job, const int n[3],
                     const float *share, const float *factor, struct voxels *v)
{
    status st = OK;
    *v = (struct voxels){.n = {n[0], n[1], n[2]}, .h = job->domain.spacing_m, .skin = skin_of(job)};
    v->grid = geometry(n, margin_of(job));
    v->grid.walls = job_walls(job);
    v->grid.tilted = attitude_is_level(job) ? 0 : 1;
    size_t words = v->grid.words;
    if (words > UINT32_MAX / 32)
        return fail(E_USAGE,
                    "domain: %d x %d x %d voxels are more than goblins can number: raise domain.spacing_m",
                    n[0], n[1], n[2]);
    TRY(upload_tables(gpu, v, job));
    TRY(gpu_buffer_create(gpu, "voxel bits", 2 * words, 4, &v->bits));
    TRY(gpu_buffer_create(gpu, "active voxels' bits", words, 4, &v->skin_bits));
    TRY(gpu_buffer_create(gpu, "places of words", domain_words(&v->grid) + 1, 4, &v->place));
    TRY(gpu_buffer_create(gpu, "bricks", bricks(&v->grid), 4, &v->gone_bricks));
    TRY(gpu_buffer_create(gpu, "touched bricks", bricks(&v->grid), 4, &v->touched));
    TRY(gpu_buffer_create(gpu, "voxels", 32 * words, 4, &v->left));
    TRY(gpu_buffer_create(gpu, "voxels' air", 32 * words, 4, &v->state));
    TRY(upload_rock(gpu, v, job->goblins.floats, share, factor));
    mirror(gpu, v);
    gpu_fill(gpu, v->touched, 1);
    TRY(refresh(gpu, work, v));
done:
    if (st != OK)
        voxels_destroy(gpu, v);
    return st;
}

void voxels_destroy(struct gpu *gpu, struct voxels *v)
{
    struct gpu_buffer **all[] = {&v->bits,     &v->skin_bits, &v->touched, &v->gone_bricks, &v->place,
                                 &v->left,     &v->state,     &v->list,    &v->rows,        &v->bubbles,
                                 &v->layer_of, &v->layers,    &v->paces};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(gpu, all[i]);
    free(v->rate);
    *v = (struct voxels){0};
}

status voxels_rates(struct gpu *gpu, struct voxels *v, const struct job *job, int frame)
{
    status st = OK;
    float(*layer)[4] = NULL;
    TRY(memory_alloc(job->n_strata, sizeof *layer, "the layers", &layer));
    for (size_t i = 0; i < job->n_strata; i++) {
        double rate = job_weak(job, i, frame) / v->h;
        layer[i][0] = (float)(rate * v->rate[i].slope);
        layer[i][1] = (float)(rate * v->rate[i].level);
    }
    TRY(gpu_upload(gpu, v->layers, 0, layer, job->n_strata));
done:
    free(layer);
    return st;
}

/* ---- a cycle */

/* Updates skin, list and air counts in touched bricks. */
static status refresh(struct gpu *gpu, struct gpu_work *work, struct voxels *v)
{
    status st = OK;
    size_t words = domain_words(&v->grid);
    uint32_t n_active;
    struct voxels_params k = voxels_params(v, words);
    GPU_RUN(gpu, voxels_skin, words, k, v->bits, v->touched, v->rows, v->skin_bits, v->place);
    gpu_scan(gpu, work, v->place, words + 1);
    TRY(gpu_download(gpu, v->place, words, &n_active, 1));
    if (!v->list || gpu_buffer_count(v->list) < n_active) {
        gpu_buffer_destroy(gpu, &v->list);
        TRY(gpu_buffer_create(gpu, "active voxels", n_active + n_active / 8 + 64, 4, &v->list));
    }
    v->n_active = n_active;
    GPU_RUN(gpu, voxels_list, words, k, v->skin_bits, v->place, v->list);
    k.n = n_active;
    GPU_RUN(gpu, voxels_count, n_active, k, v->list, v->bits, v->touched, v->rows, v->bubbles, v->layer_of,
            v->state);
done:
    return st;
}

status voxels_remove(struct gpu *gpu, struct gpu_work *work, struct voxels *v, uint32_t *n_gone)
{
    status st = OK;
    size_t words = domain_words(&v->grid), n_bricks = bricks(&v->grid);
    struct gpu_buffer *counts = gpu_work_words(work);
    struct voxels_params k = voxels_params(v, words);
    gpu_fill(gpu, v->gone_bricks, 0);
    gpu_fill(gpu, counts, 0);
    mirror(gpu, v);
    GPU_RUN(gpu, voxels_apply, words, k, v->bits, v->gone_bricks, counts);
    TRY(gpu_download(gpu, counts, VOXELS_GONE, n_gone, 1));
    if (*n_gone == 0)
        goto done;
    k.n = (uint)n_bricks;
    GPU_RUN(gpu, voxels_touch, n_bricks, k, v->gone_bricks, v->touched);
    TRY(refresh(gpu, work, v));
    k.n = (uint)words;
    GPU_RUN(gpu, voxels_forget, words, k, v->bits);
done:
    return st;
}

static float float_of(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* *event: kyr until the next voxel vanishes; *fastest: largest rate, 1/kyr, 0 if nothing weathers. */
static status pace(struct gpu *gpu, struct voxels *v, double *event, double *fastest)
{
    status st = OK;
    float paces[VOXELS_PACERS][2];
    struct voxels_params k = voxels_params(v, v->n_active);
    *event = INFINITY;
    *fastest = 0;
    GPU_RUN(gpu, voxels_pace, VOXELS_PACERS, k, v->list, v->state, v->left, v->layers, v->layer_of, v->paces);
    TRY(gpu_download(gpu, v->paces, 0, paces, 2 * VOXELS_PACERS));
    for (uint i = 0; i < VOXELS_PACERS; i++) {
        *event = fmin(*event, (double)paces[i][0]);
        *fastest = fmax(*fastest, (double)paces[i][1]);
    }
done:
    return st;
}

status voxels_cycle(struct gpu *gpu, struct gpu_work *work, struct voxels *v, double quantum, double kyr,
                    double *passed, uint32_t *n_gone)
{
    status st = OK;
    double event, fastest;
    struct voxels_params k = voxels_params(v, v->n_active);
    *passed = kyr;
    *n_gone = 0;
    if (v->n_active == 0)
        return OK;
    v->n_cycles++;
    TRY(pace(gpu, v, &event, &fastest));
    if (!isfinite(fastest) || isnan(event)) {
        st = fail(E_NUMERIC, "voxels: the fastest of %zu active voxels loses %g of itself in 1000 years",
                  v->n_active, fastest);
        goto done;
    }
    if (fastest <= 0)
        goto done;
    *passed = fmin(kyr, fmax(event, quantum / fastest));
    k.dt = (float)*passed;
    k.early = *passed > event ? 0.5f * k.dt : 0;
    GPU_RUN(gpu, voxels_decimate, v->n_active, k, v->list, v->state, v->layers, v->layer_of, v->left,
            v->bits);
    TRY(voxels_remove(gpu, work, v, n_gone));
done:
    return st;
}

status voxels_download(struct gpu *gpu, const struct voxels *v, float *share, float *factor)
{
    status st = OK;
    const struct voxels_params *g = &v->grid;
    uint32_t *row = NULL;
    TRY(memory_alloc((size_t)g->slab * 32, 4, "a slab of voxels", &row));
    for (int pass = 0; pass < 2; pass++) {
        float *out = pass ? factor : share;
        for (uint z = 0; out && z < g->nz; z++) {
            size_t first = 32 * (1 + ((size_t)z + g->margin) * g->slab);
            TRY(gpu_download(gpu, pass ? v->state : v->left, first, row, 32 * (size_t)g->slab));
            for (uint y = 0; y < g->ny; y++)
                for (uint x = 0; x < g->nx; x++) {
                    uint32_t word = row[((size_t)y + g->margin) * g->row * 32 + x];
                    *out++ = pass ? half_value(word >> 16) : float_of(word);
                }
        }
    }
done:
    free(row);
    return st;
}
