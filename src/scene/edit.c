/* Edits of existing rock. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geology/attitude.h"
#include "scene/sampler.h"

/* The voxel of a particle, computed in floats like in the kernels. */
static void voxel_of(const struct sampler *s, const struct rock *rock, size_t p, int voxel[3])
{
    for (int a = 0; a < 3; a++) {
        double v = floor((double)(rock->P[4 * p + (size_t)a] / (float)s->h));
        voxel[a] = (int)fmin(fmax(v, 0), s->n[a] - 1);
    }
}

/* Keeps the n listed particles and appends `more` zeroed ones. */
static status rebuild(struct rock *rock, const size_t *list, size_t n, size_t more)
{
    status st = OK;
    struct rock out = {0};
    TRY(rock_alloc(&out, n + more, STATE));
    if (rock->exposed_kyr)
        TRY(rock_keep(&out, ROCK_exposed_kyr));
    for (int f = 0; f < ROCK_FIELDS; f++) {
        size_t size = rock_field_size((enum rock_field)f);
        for (size_t i = 0; i < n && out.field[f]; i++)
            memcpy((char *)out.field[f] + i * size, (const char *)rock->field[f] + list[i] * size, size);
    }
    rock_free(rock);
    *rock = out;
done:
    return st;
}

static status carve(const struct job *job, const struct job_node *shape, struct rock *rock, size_t *n_carved)
{
    status st = OK;
    struct sampler s;
    size_t *list = NULL, n = 0;
    TRY(sampler_init(&s, job, shape, COVERAGE_REACH));
    TRY(coverage_create(s.solid, s.n, s.h, &s.coverage));
    TRY(memory_alloc(rock->n, sizeof *list, "an edit", &list));
    for (size_t p = 0; p < rock->n; p++) {
        int voxel[3];
        voxel_of(&s, rock, p, voxel);
        unsigned share = coverage_at(s.coverage, voxel[0], voxel[1], voxel[2]);
        float left = rock->viability[p] * (float)(COVERAGE_FULL - share) / COVERAGE_FULL;
        if (share > 0 && left < 1.0f / COVERAGE_FULL)
            continue;
        rock->viability[p] = left;
        list[n++] = p;
    }
    *n_carved += rock->n - n;
    TRY(rebuild(rock, list, n, 0));
done:
    free(list);
    sampler_deinit(&s);
    return st;
}

/* A box of voxels and their contents. */
struct box {
    int low[3], size[3];
    size_t n;
    double *fill;  /* [n]: share of rock */
    size_t *owner; /* [n]: the particle of the lowest id; SIZE_MAX: none */
};

/* The index of a voxel in the box; SIZE_MAX: outside. */
static size_t box_index(const struct box *b, const int voxel[3])
{
    size_t index = 0;
    for (int a = 2; a >= 0; a--) {
        int i = voxel[a] - b->low[a];
        if (i < 0 || i >= b->size[a])
            return SIZE_MAX;
        index = index * (size_t)b->size[a] + (size_t)i;
    }
    return index;
}

static status box_create(const struct sampler *s, const struct rock *rock, struct box *b)
{
    status st = OK;
    double min[3], max[3];
    solid_bounds(s->solid, min, max);
    b->n = 1;
    for (int a = 0; a < 3; a++) {
        double low = fmin(fmax(floor(min[a] / s->h), 0), s->n[a]);
        double high = fmin(fmax(ceil(max[a] / s->h), low), s->n[a]);
        b->low[a] = (int)low;
        b->size[a] = (int)(high - low);
        b->n *= (size_t)b->size[a];
    }
    TRY(memory_alloc(b->n, sizeof *b->fill, "an edit", &b->fill));
    TRY(memory_alloc(b->n, sizeof *b->owner, "an edit", &b->owner));
    for (size_t i = 0; i < b->n; i++)
        b->owner[i] = SIZE_MAX;
    for (size_t p = 0; p < rock->n; p++) {
        int voxel[3];
        voxel_of(s, rock, p, voxel);
        size_t i = box_index(b, voxel);
        if (i == SIZE_MAX)
            continue;
        b->fill[i] += (double)rock->viability[p];
        if (b->owner[i] == SIZE_MAX || rock->id[p] < rock->id[b->owner[i]])
            b->owner[i] = p;
    }
done:
    return st;
}

/* The i-th voxel of the box; returns its share inside the shape. */
static double share_in_shape(const struct sampler *s, const struct box *b, size_t i, int voxel[3])
{
    size_t row = (size_t)b->size[0], slab = row * (size_t)b->size[1];
    voxel[0] = b->low[0] + (int)(i % row);
    voxel[1] = b->low[1] + (int)(i / row % (size_t)b->size[1]);
    voxel[2] = b->low[2] + (int)(i / slab);
    return (double)coverage_at(s->coverage, voxel[0], voxel[1], voxel[2]) / COVERAGE_FULL;
}

static void make_particle(const struct sampler *s, const struct job_addition *add, const int voxel[3],
                          double share, uint64_t id, struct rock *rock, size_t p)
{
    const struct paint_values bare = {1, 1, 1, 0, 0};
    double x[3];
    sampler_position(s, voxel, rock->P + 4 * p);
    rock_position(rock, p, x);
    size_t layer = add->layer >= 0 ? (size_t)add->layer : attitude_layer(s->job, x);
    rock->id[p] = (uint32_t)id;
    rock->viability[p] = (float)share;
    rock->layer[p] = (uint32_t)layer;
    const struct structure_rock built = sampler_structure(s, voxel);
    rock->rate_factor[p] = (float)(sampler_rate_factor(s, layer, x, &bare) * built.rate);
    rock->interlock_factor[p] = (float)built.interlock;
}

static status add_rock(const struct job *job, const struct job_addition *add, uint64_t next_id,
                       struct rock *rock, struct scene_edited *out)
{
    status st = OK;
    struct sampler s;
    struct box box = {0};
    size_t *list = NULL, n = rock->n, more = 0;
    int voxel[3];
    double filled = 0;
    TRY(sampler_init(&s, job, add->shape, COVERAGE_REACH));
    TRY(sampler_prepare(&s, NULL, 0));
    TRY(box_create(&s, rock, &box));
    for (size_t i = 0; i < box.n; i++) {
        double share = share_in_shape(&s, &box, i, voxel), lack = share - box.fill[i];
        more += share > 0 && box.owner[i] == SIZE_MAX;
        if (box.owner[i] == SIZE_MAX || lack <= 0)
            continue;
        float *viability = &rock->viability[box.owner[i]], before = *viability;
        *viability = (float)fmin((double)before + lack, 1);
        filled += (double)(*viability - before);
    }
    if (next_id + more > UINT32_MAX) {
        st = fail(E_MEMORY, "edits: more than 2^32 particles over the whole run: raise domain.spacing_m");
        goto done;
    }
    TRY(memory_alloc(n, sizeof *list, "an edit", &list));
    for (size_t p = 0; p < n; p++)
        list[p] = p;
    TRY(rebuild(rock, list, n, more));
    for (size_t i = 0; i < box.n; i++) {
        double share = share_in_shape(&s, &box, i, voxel);
        if (share > 0 && box.owner[i] == SIZE_MAX) {
            make_particle(&s, add, voxel, share, next_id++, rock, n++);
            filled += share;
        }
    }
    out->added += more;
    out->added_m3 += filled * pow(s.h, 3);
done:
    free(list);
    free(box.fill);
    free(box.owner);
    sampler_deinit(&s);
    return st;
}

static status paint(const struct job *job, const struct job_edit *edit, struct rock *rock)
{
    status st = OK;
    struct sampler s = {.job = job};
    TRY(paint_create(job, edit->paint, edit->n_paint, &s.paint));
    sampler_add_occluders(&s, rock);
#pragma omp parallel for schedule(static)
    for (size_t p = 0; p < rock->n; p++) {
        double x[3];
        rock_position(rock, p, x);
        struct paint_values v = paint_at(s.paint, x, (double)rock->vegetation[p]);
        rock->rate_factor[p] =
            v.inert ? 0 : (float)(v.erodibility / v.viability * (double)rock->rate_factor[p]);
        rock->interlock_factor[p] = (float)(v.interlock * (double)rock->interlock_factor[p]);
        rock->vegetation[p] = (float)v.vegetation;
    }
done:
    paint_destroy(&s.paint);
    return st;
}

status scene_edit(const struct job *job, const struct job_edit *edit, uint64_t next_id, struct rock *rock,
                  struct scene_edited *out)
{
    status st = OK;
    *out = (struct scene_edited){0};
    if (edit->carve)
        TRY(carve(job, edit->carve, rock, &out->carved));
    for (size_t i = 0; i < edit->n_add; i++)
        TRY(add_rock(job, &edit->add[i], next_id + out->added, rock, out));
    if (edit->n_paint)
        TRY(paint(job, edit, rock));
done:
    return st;
}

static status check_edit(const struct job *job, const struct job_edit *e, bool added)
{
    status st = OK;
    struct solid *solid = NULL;
    struct paint_set *set = NULL;
    const double h = job->domain.spacing_m;
    if (e->carve)
        TRY(solid_create(e->carve, h / 2, COVERAGE_REACH * h, &solid));
    solid_destroy(&solid);
    for (size_t k = 0; k < e->n_add && added; k++) {
        TRY(solid_create(e->add[k].shape, h / 2, COVERAGE_REACH * h, &solid));
        solid_destroy(&solid);
    }
    TRY(paint_create(job, e->paint, e->n_paint, &set));
    paint_destroy(&set);
done:
    return st;
}

status scene_edits_check(const struct job *job, int frame)
{
    status st = OK;
    for (size_t i = 0; i < job->n_edits; i++)
        if (job->edits[i].frame > frame && job->edits[i].frame <= job->frames.last)
            TRY(check_edit(job, &job->edits[i], true));
done:
    return st;
}

status scene_paint_check(const struct job *job)
{
    status st = OK;
    struct paint_set *set = NULL;
    TRY(paint_create(job, job->paint, job->n_paint, &set));
    paint_destroy(&set);
    for (size_t i = 0; i < job->n_edits; i++)
        if (job->edits[i].frame <= job->frames.last)
            TRY(check_edit(job, &job->edits[i], false));
done:
    return st;
}
