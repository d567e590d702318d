/* The end of a fall: fragments become rubble or deposits by size. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "mpm/internal.h"

struct fragments {
    size_t n;
    const int *voxels;
    float *place;                   /* vec4 [n] */
    float *apart;                   /* [n] */
    uint32_t *joint, *piece;        /* [n] */
    uint32_t *parent, *size, *next; /* [n]: trees of particles, their sizes, and lists of those in a voxel */
    uint32_t *first;                /* [voxels] */
    struct mpm_pieces *pieces;
};

static const uint32_t NONE = UINT32_MAX;

static bool is_whole(const struct fragments *f, size_t i)
{
    return f->apart[i] < 0 || !(f->joint[i] & MPM_PARTED);
}

static uint32_t body_of(const struct fragments *f, size_t i)
{
    return f->pieces->n[0] ? f->pieces->body[f->piece[i]] : 0;
}

static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

/* The voxel at `offset` from that of particle i; false outside the domain. */
static bool voxel_of(const struct fragments *f, double h, size_t i, const int offset[3], size_t *out)
{
    long v[3];
    for (int a = 0; a < 3; a++) {
        v[a] = (long)floor((double)f->place[4 * i + (size_t)a] / h) + offset[a];
        if (v[a] < 0 || v[a] >= f->voxels[a])
            return false;
    }
    *out = ((size_t)v[2] * (size_t)f->voxels[1] + (size_t)v[1]) * (size_t)f->voxels[0] + (size_t)v[0];
    return true;
}

/* Joins each whole particle with those of its body in its voxel and in those across three of its faces. */
static void connect(struct fragments *f, double h)
{
    static const int offsets[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    size_t v;
    for (uint32_t i = 0; i < f->n; i++) {
        f->parent[i] = i;
        if (!is_whole(f, i) || !voxel_of(f, h, i, offsets[0], &v))
            continue;
        f->next[i] = f->first[v];
        f->first[v] = i;
    }
    for (uint32_t i = 0; i < f->n; i++)
        for (int w = 0; w < 4 && is_whole(f, i); w++) {
            if (!voxel_of(f, h, i, offsets[w], &v))
                continue;
            for (uint32_t j = f->first[v]; j != NONE; j = f->next[j]) {
                uint32_t a = root_of(f->parent, i), b = root_of(f->parent, j);
                if (body_of(f, i) == body_of(f, j))
                    f->parent[a < b ? b : a] = a < b ? a : b;
            }
        }
    for (uint32_t i = 0; i < f->n; i++)
        f->size[root_of(f->parent, i)]++;
}

status mpm_classify(struct gpu *gpu, struct mpm *m, struct particles *p, double rubble)
{
    status st = OK;
    struct fragments f = {.n = m->n, .voxels = p->voxels, .pieces = &m->pieces};
    struct count_params all = {(uint)m->n};
    size_t voxels = (size_t)p->voxels[0] * (size_t)p->voxels[1] * (size_t)p->voxels[2];
    double least = pow(rubble / p->h, 3);
    if (m->n == 0)
        return OK;
    TRY(memory_alloc(4 * f.n, 4, "places", &f.place));
    TRY(memory_alloc(f.n, 4, "fragments", &f.apart));
    TRY(memory_alloc(f.n, 4, "fragments", &f.joint));
    TRY(memory_alloc(f.n, 4, "fragments", &f.piece));
    TRY(memory_alloc(f.n, 4, "fragments", &f.parent));
    TRY(memory_alloc(f.n, 4, "fragments", &f.size));
    TRY(memory_alloc(f.n, 4, "fragments", &f.next));
    TRY(memory_alloc(voxels, 4, "fragments by voxel", &f.first));
    TRY(gpu_download(gpu, m->vector[MPM_PLACE], 0, f.place, f.n));
    TRY(gpu_download(gpu, m->word[MPM_APART], 0, f.apart, f.n));
    TRY(gpu_download(gpu, m->word[MPM_JOINT], 0, f.joint, f.n));
    TRY(gpu_download(gpu, m->word[MPM_PIECE], 0, f.piece, f.n));
    for (size_t v = 0; v < voxels; v++)
        f.first[v] = NONE;
    connect(&f, p->h);
    for (uint32_t i = 0; i < f.n; i++) {
        bool block = is_whole(&f, i) && f.size[root_of(f.parent, i)] >= least;
        f.next[i] = block ? PHASE_FALLING : PHASE_DEPOSIT;
    }
    TRY(gpu_upload(gpu, m->part, 0, f.next, f.n));
    GPU_RUN(gpu, mpm_classify, f.n, all, m->word[MPM_ORIGIN], m->part, p->field[ROCK_phase]);
done:
    free(f.place);
    free(f.apart);
    free(f.joint);
    free(f.piece);
    free(f.parent);
    free(f.size);
    free(f.next);
    free(f.first);
    return st;
}
