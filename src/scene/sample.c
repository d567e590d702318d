/* Samples the scene at voxels, and estimates its size. */
#include <math.h>
#include <stdlib.h>

#include "base/cores.h"
#include "base/memory.h"
#include "base/random.h"
#include "geology/attitude.h"
#include "scene/sampler.h"
#include "system/threads.h"

#define MAX_VOXELS                                                                                           \
    4294967295.0     /* a voxel is numbered by 32 times its word of bits (particles/held.h) plus its bit */
#define JITTER 0.25f /* in h, to either side of the voxel's centre */

status scene_voxels(const struct job *job, int n[3])
{
    double h = job->domain.spacing_m, count[3];
    for (int a = 0; a < 3; a++) {
        /* Pairs of voxels. A size within a millionth of an integer number of pairs is rounded to it. */
        double pairs = job->domain.size_m[a] / (2 * h), whole = fmax(1, round(pairs));
        count[a] = 2 * (fabs(pairs - whole) <= 1e-6 * whole ? whole : fmax(1, ceil(pairs)));
    }
    /* Rows are padded to whole words. */
    const double total = 32 * ceil(count[0] / 32) * count[1] * count[2];
    if (!(total <= MAX_VOXELS))
        return fail(
            E_USAGE,
            "domain: %.0f x %.0f x %.0f voxels are more than 2^32: raise domain.spacing_m above %.3g m, or reduce domain.size_m",
            count[0], count[1], count[2], h * cbrt(total / MAX_VOXELS));
    for (int a = 0; a < 3; a++)
        n[a] = (int)count[a];
    return OK;
}

void sampler_position(const struct sampler *s, const int voxel[3], float P[4])
{
    const float jitter = job_model(s->job)->centred ? 0 : JITTER;
    for (int a = 0; a < 3; a++) {
        float share = random_float(
            random_hash(s->jitter[a], (uint32_t)voxel[0], (uint32_t)voxel[1], (uint32_t)voxel[2]));
        P[a] = (float)((voxel[a] + 0.5 + (double)(jitter * (2 * share - 1))) * s->h);
    }
    P[3] = 0;
}

struct structure_rock sampler_structure(const struct sampler *s, const int voxel[3])
{
    const double middle[3] = {(voxel[0] + 0.5) * s->h, (voxel[1] + 0.5) * s->h, (voxel[2] + 0.5) * s->h};
    return structure_at(&s->structure, middle, s->h);
}

double sampler_rate_factor(const struct sampler *s, size_t layer, const double x[3],
                           const struct paint_values *paint)
{
    double own = s->job->n_strata ? s->job->strata[layer].noise_amplitude : -1;
    double amplitude = own >= 0 ? own : s->job->noise.amplitude;
    if (paint->inert || solid_at(s->solid, x).inert)
        return 0;
    return paint->erodibility / paint->viability *
           (amplitude > 0 ? exp(amplitude * noise_at(&s->noise[layer], x)) : 1);
}

void rock_position(const struct rock *rock, size_t p, double x[3])
{
    for (size_t a = 0; a < 3; a++)
        x[a] = (double)rock->P[4 * p + a];
}

void sampler_add_occluders(const struct sampler *s, const struct rock *rock)
{
    for (size_t p = 0; paint_needs_occluders(s->paint) && p < rock->n; p++) {
        double x[3];
        rock_position(rock, p, x);
        paint_add_occluder(s->paint, x);
    }
}

status scene_fail_floating(double lowest)
{
    return fail(
        E_USAGE,
        "scene: the rock floats in the air: the lowest rock is at z = %.4g m, but the ground is at z = 0: lower it, or add rock below it",
        lowest);
}

static bool slab_has_rock(const struct sampler *s, int k)
{
    for (int j = 0; j < s->n[1]; j++)
        for (int i = 0; i < s->n[0]; i++)
            if (coverage_at(s->coverage, i, j, k) > 0)
                return true;
    return false;
}

static status no_rock(const struct sampler *s)
{
    double min[3], max[3];
    const double *size = s->job->domain.size_m;
    solid_bounds(s->solid, min, max);
    return fail(
        E_USAGE,
        "scene: there is no rock in the domain: the scene spans x %.4g to %.4g, y %.4g to %.4g, z %.4g to %.4g m, the domain x 0 to %.4g, y 0 to %.4g, z 0 to %.4g m: move the shapes into the domain, or check what a difference or intersection leaves",
        min[0], max[0], min[1], max[1], min[2], max[2], size[0], size[1], size[2]);
}

status sampler_check(const struct sampler *s, bool floats)
{
    int lowest = 0;
    while (lowest < s->n[2] && !slab_has_rock(s, lowest))
        lowest++;
    if (lowest == s->n[2])
        return no_rock(s);
    return lowest > 0 && !floats ? scene_fail_floating(lowest * s->h) : OK;
}

/* The scene minus the beds of its rivers. */
static status solid_of_job(const struct job *job, double detail, double reach, struct solid **out)
{
    status st = OK;
    struct job_node *beds = NULL, **part = NULL;
    struct job_node whole = {.kind = NODE_DIFFERENCE, .u.group = {.scale = {1, 1, 1}}};
    TRY(memory_alloc(job->n_sources, sizeof *beds, "river beds", &beds));
    TRY(memory_alloc(job->n_sources + 1, sizeof *part, "river beds", &part));
    part[whole.n_child++] = job->scene;
    for (size_t i = 0; i < job->n_sources; i++) {
        const struct job_source *source = &job->sources[i];
        if (!(source->bed_m > 0))
            continue;
        beds[i] = (struct job_node){.kind = NODE_SHAPE,
                                    .shape = SHAPE_STROKE,
                                    .u.stroke = {.path_m = source->path_m,
                                                 .n_path_m = source->n_path_m,
                                                 .radius_m = source->bed_m,
                                                 .scale = {1, 1, 1}}};
        part[whole.n_child++] = &beds[i];
    }
    whole.child = part;
    TRY(solid_create(whole.n_child > 1 ? &whole : job->scene, detail, reach, out));
done:
    free(beds);
    free(part);
    return st;
}

const struct solid *sampler_scene(const struct sampler *s)
{
    for (size_t i = 0; i < s->job->n_sources; i++)
        if (s->job->sources[i].bed_m > 0)
            return solid_child(s->solid, 0); /* solid_of_job() */
    return s->solid;
}

status sampler_init(struct sampler *s, const struct job *job, const struct job_node *node, double reach)
{
    status st = OK;
    double h = job->domain.spacing_m;
    *s = (struct sampler){.job = job, .h = h};
    TRY(threads_check(cores())); /* OpenMP's, before a device is opened */
    TRY(scene_voxels(job, s->n));
    TRY(node ? solid_create(node, h / 2, reach * h, &s->solid)
             : solid_of_job(job, h / 2, reach * h, &s->solid));
done:
    return st;
}

status sampler_prepare(struct sampler *s, const struct job_paint *paint, size_t n)
{
    status st = OK;
    uint32_t seed = (uint32_t)s->job->seed;
    TRY(paint_create(s->job, paint, n, &s->paint));
    TRY(memory_alloc(s->job->n_strata + 1, sizeof *s->noise, "noise", &s->noise));
    for (size_t i = 0; i <= s->job->n_strata; i++) {
        struct job_noise own = s->job->noise;
        if (i < s->job->n_strata && s->job->strata[i].noise_scale_m > 0)
            own.scale_m = s->job->strata[i].noise_scale_m;
        s->noise[i] = noise_init(&own, seed);
    }
    for (uint32_t a = 0; a < 3; a++)
        s->jitter[a] = random_hash(seed, a, 0, RANDOM_JITTER);
    TRY(structure_create(s->job, &s->structure));
    TRY(coverage_create(s->solid, s->n, s->h, &s->coverage));
done:
    return st;
}

void sampler_deinit(struct sampler *s)
{
    structure_destroy(&s->structure);
    solid_destroy(&s->solid);
    coverage_destroy(&s->coverage);
    paint_destroy(&s->paint);
    free(s->noise);
}

status scene_grid(const struct job *job, bool floats, float *share, float *factor)
{
    status st = OK;
    struct sampler s;
    TRY(sampler_init(&s, job, NULL, COVERAGE_REACH));
    TRY(sampler_prepare(&s, job->paint, job->n_paint));
    TRY(sampler_check(&s, floats));
    TRY(scene_log_inputs(job, sampler_scene(&s)));
    for (int k = 0; paint_needs_occluders(s.paint) && k < s.n[2]; k++)
        for (int j = 0; j < s.n[1]; j++)
            for (int i = 0; i < s.n[0]; i++)
                if (coverage_at(s.coverage, i, j, k) > 0)
                    paint_add_occluder(s.paint,
                                       (const double[]){(i + 0.5) * s.h, (j + 0.5) * s.h, (k + 0.5) * s.h});
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < s.n[2]; k++) {
        size_t v = (size_t)k * (size_t)s.n[1] * (size_t)s.n[0];
        for (int j = 0; j < s.n[1]; j++)
            for (int i = 0; i < s.n[0]; i++, v++) {
                const double x[3] = {(i + 0.5) * s.h, (j + 0.5) * s.h, (k + 0.5) * s.h};
                unsigned covered = coverage_at(s.coverage, i, j, k);
                share[v] = factor[v] = 0;
                if (covered == 0)
                    continue;
                struct paint_values paint = paint_at(s.paint, x, 0);
                share[v] = (float)covered / COVERAGE_FULL;
                factor[v] = (float)(sampler_rate_factor(&s, attitude_layer(job, x), x, &paint) *
                                    sampler_structure(&s, (const int[]){i, j, k}).rate);
            }
    }
done:
    sampler_deinit(&s);
    return st;
}

/* Is the neighbour of a rock voxel on that side air? Below the domain is ground. `deep`: all neighbours in the domain are rock. */
static bool is_exposed(const struct sampler *s, const int voxel[3], int side, bool deep)
{
    const int a = side / 2;
    int v[3] = {voxel[0], voxel[1], voxel[2]};
    v[a] += side % 2 ? 1 : -1;
    if (a == 2 && v[2] < 0)
        return false;
    if (v[a] < 0 || v[a] >= s->n[a])
        return true;
    return !deep && !coverage_holds_rock(s->solid, s->h, v[0], v[1], v[2]);
}

/* The number of sides in x of a rock voxel that are exposed, and whether any side is. */
static size_t count_ends(const struct sampler *s, const int voxel[3], bool *exposed)
{
    const double middle[3] = {(voxel[0] + 0.5) * s->h, (voxel[1] + 0.5) * s->h, (voxel[2] + 0.5) * s->h};
    const bool deep = solid_at(s->solid, middle).distance < -s->h;
    const size_t ends = (size_t)is_exposed(s, voxel, 0, deep) + (size_t)is_exposed(s, voxel, 1, deep);
    *exposed = ends > 0;
    for (int side = 2; side < 6 && !*exposed; side++)
        *exposed = is_exposed(s, voxel, side, deep);
    return ends;
}

/* Is there air or the domain's boundary within SCENE_NEAR voxels? Probes the corners and face centres of the cube of that half-width. */
static bool is_near(const struct sampler *s, const int voxel[3])
{
    const double middle[3] = {(voxel[0] + 0.5) * s->h, (voxel[1] + 0.5) * s->h, (voxel[2] + 0.5) * s->h};
    for (int a = 0; a < 3; a++)
        if (voxel[a] < SCENE_NEAR || voxel[a] + SCENE_NEAR >= s->n[a])
            return true;
    if (solid_at(s->solid, middle).distance < -sqrt(3) * SCENE_NEAR * s->h)
        return false;
    for (int c = 0; c < 27; c++) {
        const int d[3] = {c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1};
        const int axes = abs(d[0]) + abs(d[1]) + abs(d[2]);
        if ((axes == 1 || axes == 3) &&
            !coverage_holds_rock(s->solid, s->h, voxel[0] + SCENE_NEAR * d[0], voxel[1] + SCENE_NEAR * d[1],
                                 voxel[2] + SCENE_NEAR * d[2]))
            return true;
    }
    return false;
}

/* Samples one voxel of every block, at a position hashed from the block. Exact for scenes of up to 2^18 voxels, except for n_near. */
static status estimate(const struct sampler *s, struct scene_size *out)
{
    status st = OK;
    size_t total = 1, probes = 1, found = 0, exposed = 0, near = 0, ends = 0, blocks[3],
           capacity = out->n_points;
    for (int a = 0; a < 3; a++)
        total *= (size_t)s->n[a];
    int side = (int)ceil(cbrt((double)total / 262144) - 1e-9);
    const size_t weight = (size_t)side * (size_t)side * (size_t)side;
    for (int a = 0; a < 3; a++) {
        blocks[a] = ((size_t)s->n[a] + (size_t)side - 1) / (size_t)side;
        probes *= blocks[a];
    }
    /* is_near() is the most expensive part; one voxel in near_step is enough for an error of a percent or two. */
    const uint32_t near_step = (uint32_t)(probes / 16384) + 1;
    TRY(memory_grow(&out->point, &capacity, out->n_points + probes, sizeof *out->point, "an estimate"));
#pragma omp parallel for reduction(+ : exposed, near, ends)
    for (size_t b = 0; b < probes; b++) {
        const size_t at[3] = {b % blocks[0], b / blocks[0] % blocks[1], b / blocks[0] / blocks[1]};
        int voxel[3], inside = 1;
        size_t place;
        for (uint32_t a = 0; a < 3; a++) {
            uint32_t offset =
                random_hash((uint32_t)s->job->seed, (uint32_t)b, a, RANDOM_ESTIMATE) % (uint32_t)side;
            voxel[a] = (int)at[a] * side + (int)offset;
            inside &= voxel[a] < s->n[a];
        }
        if (!inside || !coverage_holds_rock(s->solid, s->h, voxel[0], voxel[1], voxel[2]))
            continue;
        bool is_surface;
        ends += count_ends(s, voxel, &is_surface);
        exposed += is_surface;
        if (is_surface)
            near++;
        else if (random_hash((uint32_t)s->job->seed, (uint32_t)b, 3, RANDOM_ESTIMATE) % near_step == 0)
            near += is_near(s, voxel) ? near_step : 0;
#pragma omp atomic capture
        place = found++;
        for (int a = 0; a < 3; a++)
            out->point[out->n_points + place][a] = (float)((voxel[a] + 0.5) * s->h);
    }
    out->n_points += found;
    out->n_particles += found * weight;
    out->n_surface += exposed * weight;
    out->n_near += near * weight;
    out->n_kept = out->n_particles;
    out->n_ends += ends * weight;
done:
    return st;
}

/* The lowest layer below `end` with a voxel of which at least `share` is rock; `end`: there is none. */
static int lowest_layer(const struct sampler *s, unsigned share, int end)
{
    for (int k = 0; k < end; k++)
        for (int at = 0; at < s->n[0] * s->n[1]; at++) {
            const int i = at % s->n[0], j = at / s->n[0];
            if (coverage_holds_rock(s->solid, s->h, i, j, k) &&
                (share <= 1 || coverage_of_voxel(s->solid, s->h, i, j, k) >= share))
                return k;
        }
    return end;
}

status scene_check(const struct job *job, bool floats, const struct scene_survey *survey)
{
    enum {
        FEW = 4
    }; /* layers above the lowest rock: if none of their voxels is half rock, the run decides */
    status st = OK;
    const struct scene_size *size = &survey->size;
    struct sampler s = {.job = job, .h = job->domain.spacing_m, .solid = survey->solid};
    double seen = INFINITY;
    TRY(scene_voxels(job, s.n));
    for (size_t i = 0; i < size->n_points; i++)
        seen = fmin(seen, (double)size->point[i][2]);
    const int top = size->n_points ? (int)(seen / s.h) + 1 : 1;
    const int any = lowest_layer(&s, 1, top);
    if (any == top && !size->n_points)
        return no_rock(&s);
    if (floats)
        return OK;
    if (any > 0)
        return scene_fail_floating(any * s.h);
    /* Rock stands on voxels that are at least half full, unless an edit supports it or it may fall. */
    if (job->collapse.blocks == COLLAPSE_FALL || (job->n_edits && job->edits[0].frame <= job->frames.first))
        return OK;
    const int end = any + FEW < s.n[2] ? any + FEW : s.n[2];
    const int half = lowest_layer(&s, COVERAGE_FULL / 2, end);
    if (half > 0 && half < end)
        st = scene_fail_floating(half * s.h);
done:
    return st;
}

/* The scene's own voxels are those of s, the edits' are read here. */
static status estimate_all(const struct sampler *s, struct scene_size *out)
{
    status st = OK;
    const struct job *job = s->job;
    struct sampler added = {0};
    *out = (struct scene_size){0};
    TRY(estimate(s, out));
    for (size_t i = 0; i < job->n_edits; i++)
        for (size_t k = 0; k < job->edits[i].n_add && job->edits[i].frame <= job->frames.last; k++) {
            sampler_deinit(&added);
            TRY(sampler_init(&added, job, job->edits[i].add[k].shape, 1));
            TRY(estimate(&added, out));
        }
done:
    sampler_deinit(&added);
    if (st != OK) {
        free(out->point);
        *out = (struct scene_size){0};
    }
    return st;
}

status scene_estimate(const struct job *job, struct scene_size *out)
{
    status st = OK;
    struct sampler s;
    *out = (struct scene_size){0};
    TRY(sampler_init(&s, job, NULL, 1));
    TRY(estimate_all(&s, out));
done:
    sampler_deinit(&s);
    return st;
}

void scene_bounds(const struct scene_size *size, double low[3], double high[3])
{
    for (int a = 0; a < 3; a++) {
        low[a] = INFINITY;
        high[a] = -INFINITY;
        for (size_t i = 0; i < size->n_points; i++) {
            low[a] = fmin(low[a], (double)size->point[i][a]);
            high[a] = fmax(high[a], (double)size->point[i][a]);
        }
    }
}

status scene_survey(const struct job *job, struct scene_survey *out)
{
    status st = OK;
    struct sampler s;
    *out = (struct scene_survey){0};
    TRY(sampler_init(&s, job, NULL, COVERAGE_REACH));
    TRY(estimate_all(&s, &out->size));
    if (job->scene)
        TRY(inputs_measure(job, sampler_scene(&s), out));
    out->solid = s.solid;
    s.solid = NULL;
done:
    sampler_deinit(&s);
    if (st != OK)
        scene_survey_free(out);
    return st;
}

void scene_survey_free(struct scene_survey *survey)
{
    solid_destroy(&survey->solid);
    free(survey->size.point);
    free(survey->input);
    *survey = (struct scene_survey){0};
}
