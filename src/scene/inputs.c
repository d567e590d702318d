/* Compares the volume of each file with what sampling makes of it. If sampling is too coarse for the file, or its inside and outside are
 * not what was meant, a run would have the wrong rock and nothing else would show it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "image/image.h"
#include "scene/coverage.h"
#include "scene/sampler.h"

/* The approximate number of voxels to sample, one per block. */
enum { SAMPLES = 1 << 15 };

/* The volume of a solid with a finite bounding box, m3, from one voxel of h metres in every block, at a position hashed from the block. */
static double sampled_volume(const struct solid *solid, double h)
{
    double low[3], high[3], total = 1;
    int first[3], n[3];
    solid_bounds(solid, low, high);
    for (int a = 0; a < 3; a++) {
        first[a] = (int)floor(low[a] / h) - 1;
        n[a] = (int)ceil(high[a] / h) + 1 - first[a];
        total *= n[a];
    }
    const int side = (int)ceil(cbrt(total / SAMPLES) - 1e-9);
    int blocks[3];
    for (int a = 0; a < 3; a++)
        blocks[a] = (n[a] + side - 1) / side;
    uint64_t sum = 0;
#pragma omp parallel for reduction(+ : sum) collapse(2)
    for (int k = 0; k < blocks[2]; k++)
        for (int j = 0; j < blocks[1]; j++)
            for (int i = 0; i < blocks[0]; i++) {
                const int block[3] = {i, j, k};
                const uint32_t number = (uint32_t)((k * blocks[1] + j) * blocks[0] + i);
                int voxel[3];
                for (uint32_t a = 0; a < 3; a++)
                    voxel[a] = first[a] + block[a] * side +
                               (int)(random_hash(number, a, 0, RANDOM_ESTIMATE) % (uint32_t)side);
                sum += coverage_of_voxel(solid, h, voxel[0], voxel[1], voxel[2]);
            }
    return (double)sum / COVERAGE_FULL * pow(side * h, 3);
}

/* `solid` was made of `node`, in the same form. */
static status walk(const struct job_node *node, const struct solid *solid, double h, struct scene_survey *out,
                   size_t *capacity)
{
    status st = OK;
    const char *file = node->kind != NODE_SHAPE           ? NULL
                       : node->shape == SHAPE_MESH        ? node->u.mesh.file
                       : node->shape == SHAPE_VOLUME      ? node->u.volume.file
                       : node->shape == SHAPE_VOXELS      ? node->u.voxels.file
                       : node->shape == SHAPE_HEIGHTFIELD ? node->u.heightfield.file
                                                          : NULL;
    if (file) {
        TRY(memory_grow(&out->input, capacity, out->n_inputs + 1, sizeof *out->input, "the scene's files"));
        struct scene_input *in = &out->input[out->n_inputs++];
        *in = (struct scene_input){file, solid_file_m3(solid), sampled_volume(solid, h), {0}, {0}};
        solid_bounds(solid, in->min, in->max);
    }
    for (size_t i = 0; i < node->n_child; i++)
        TRY(walk(node->child[i], solid_child(solid, i), h, out, capacity));
done:
    return st;
}

status inputs_measure(const struct job *job, const struct solid *scene, struct scene_survey *out)
{
    size_t capacity = 0;
    return walk(job->scene, scene, job->domain.spacing_m, out, &capacity);
}

bool scene_input_text(const struct scene_input *in, double h, char text[600])
{
    char bounds[160], more[64] = "";
    const double off = in->sampled_m3 / in->file_m3 - 1;
    const bool differs = in->file_m3 > 0 && fabs(off) > 0.05;
    snprintf(bounds, sizeof bounds, "from (%.4g, %.4g, %.4g) to (%.4g, %.4g, %.4g) m", in->min[0], in->min[1],
             in->min[2], in->max[0], in->max[1], in->max[2]);
    if (differs)
        snprintf(more, sizeof more, ", %.0f %% %s", 100 * fabs(off), off > 0 ? "more" : "less");
    if (in->file_m3 > 0)
        snprintf(text, 600,
                 "%.300s: %.4g m3 by its own measure, %s %.4g m3 as it is sampled every %g m%s; it is %s",
                 in->file, in->file_m3, differs ? "but" : "and", in->sampled_m3, h, more, bounds);
    else
        snprintf(text, 600, "%.300s: %.4g m3 as it is sampled every %g m; it is %s", in->file, in->sampled_m3,
                 h, bounds);
    return differs;
}

status scene_log_inputs(const struct job *job, const struct solid *scene)
{
    status st = OK;
    struct scene_survey survey = {0};
    char text[600];
    TRY(inputs_measure(job, scene, &survey));
    for (size_t i = 0; i < survey.n_inputs; i++) {
        const bool differs = scene_input_text(&survey.input[i], job->domain.spacing_m, text);
        image_log(differs, "scene", text);
    }
done:
    scene_survey_free(&survey);
    return st;
}
