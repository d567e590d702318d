#include "geology/maps.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "geology/attitude.h"
#include "geology/structure.h"

static size_t along_words(const int n[3])
{
    return ((size_t)n[0] * (size_t)n[1] * (size_t)n[2] + 3) / 4;
}

static size_t parted_words(const int n[3])
{
    return 2 * (((size_t)n[0] + 31) / 32) * (size_t)n[1] * (size_t)n[2];
}

static size_t cells(const int n[3])
{
    return (size_t)(n[0] / 2) * (size_t)(n[1] / 2) * (size_t)(n[2] / 2);
}

static bool leads(const struct job *job)
{
    return job->n_strata_from > 0;
}

uint64_t maps_bytes(const struct job *job, const int voxels[3])
{
    return 4 * ((leads(job) ? along_words(voxels) : 0) + (joints_part(job) ? parted_words(voxels) : 0) +
                (joints_soften(job) ? cells(voxels) : 0));
}

static void middle_of(double h, int i, int j, int k, double x[3])
{
    x[0] = (i + 0.5) * h;
    x[1] = (j + 0.5) * h;
    x[2] = (k + 0.5) * h;
}

static status find_along(struct gpu *gpu, const struct structure *s, const int n[3], struct maps *m)
{
    status st = OK;
    const double h = s->job->domain.spacing_m;
    uint8_t *byte = NULL;
    TRY(memory_alloc(along_words(n), 4, "how beds lead", &byte));
#pragma omp parallel for schedule(static)
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++) {
                double x[3];
                middle_of(h, i, j, k, x);
                byte[((size_t)k * (size_t)n[1] + (size_t)j) * (size_t)n[0] + (size_t)i] =
                    (uint8_t)fmin(round(MAPS_OCTAVE * log2(structure_at(s, x, h).along)), 255);
            }
    TRY(gpu_buffer_create(gpu, "how beds lead", along_words(n), 4, &m->along));
    TRY(gpu_upload(gpu, m->along, 0, byte, along_words(n)));
done:
    free(byte);
    return st;
}

static status find_parted(struct gpu *gpu, const struct structure *s, const int n[3], struct maps *m)
{
    status st = OK;
    const double h = s->job->domain.spacing_m;
    const size_t across = ((size_t)n[0] + 31) / 32;
    uint32_t *bits = NULL;
    TRY(memory_alloc(parted_words(n), 4, "where joints part rock", &bits));
#pragma omp parallel for schedule(static)
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++) {
                const size_t word = ((size_t)k * (size_t)n[1] + (size_t)j) * across + (size_t)i / 32;
                double x[3], before[3];
                middle_of(h, i, j, k, x);
                for (int a = 0; a < 2; a++) {
                    middle_of(h, i - (a == 0), j - (a == 1), k, before);
                    bits[2 * word + (size_t)a] |= (uint32_t)joints_between(&s->joints, before, x) << i % 32;
                }
            }
    TRY(gpu_buffer_create(gpu, "where joints part rock", parted_words(n), 4, &m->parted));
    TRY(gpu_upload(gpu, m->parted, 0, bits, parted_words(n)));
done:
    free(bits);
    return st;
}

static status find_stiff(struct gpu *gpu, const struct structure *s, const int n[3], struct maps *m)
{
    status st = OK;
    const double dx = 2 * s->job->domain.spacing_m;
    const int c[3] = {n[0] / 2, n[1] / 2, n[2] / 2};
    float *stiff = NULL;
    TRY(memory_alloc(cells(n), sizeof *stiff, "how stiff rock is", &stiff));
#pragma omp parallel for schedule(static)
    for (int k = 0; k < c[2]; k++)
        for (int j = 0; j < c[1]; j++)
            for (int i = 0; i < c[0]; i++) {
                double x[3];
                middle_of(dx, i, j, k, x);
                const double height = attitude_height(s->job, x, NULL);
                stiff[((size_t)k * (size_t)c[1] + (size_t)j) * (size_t)c[0] + (size_t)i] =
                    (float)joints_at(&s->joints, x, height, dx).stiffness;
            }
    TRY(gpu_buffer_create(gpu, "how stiff rock is", cells(n), sizeof *stiff, &m->stiff));
    TRY(gpu_upload(gpu, m->stiff, 0, stiff, cells(n)));
done:
    free(stiff);
    return st;
}

status maps_create(struct gpu *gpu, const struct job *job, const int voxels[3], struct maps *m)
{
    status st = OK;
    struct structure s = {0};
    *m = (struct maps){0};
    if (!leads(job) && !joints_part(job) && !joints_soften(job))
        return OK;
    TRY(structure_create(job, &s));
    if (leads(job))
        TRY(find_along(gpu, &s, voxels, m));
    if (joints_part(job))
        TRY(find_parted(gpu, &s, voxels, m));
    if (joints_soften(job))
        TRY(find_stiff(gpu, &s, voxels, m));
done:
    structure_destroy(&s);
    if (st != OK)
        maps_destroy(gpu, m);
    return st;
}

void maps_destroy(struct gpu *gpu, struct maps *m)
{
    gpu_buffer_destroy(gpu, &m->along);
    gpu_buffer_destroy(gpu, &m->parted);
    gpu_buffer_destroy(gpu, &m->stiff);
}
