#include "groundwater/groundwater.h"

#include "base/log.h"

enum { WET_BYTES = sizeof(struct wet) };
_Static_assert(WET_BYTES == 32, "shaders/groundwater/wet.glsl reads two vectors");

static size_t columns_in(const int voxels[3])
{
    return (size_t)voxels[0] * (size_t)voxels[1];
}

bool groundwater_wanted(const struct job *job)
{
    return job->groundwater.recharge_m_per_yr > 0;
}

uint64_t groundwater_bytes(const struct job *job, const int voxels[3])
{
    size_t beds = contacts_beds(job);
    if (!job_seeps(job))
        return 0;
    for (size_t i = 0; i < job->n_edits; i++)
        if (job->edits[i].set.job && contacts_beds(job->edits[i].set.job) > beds)
            beds = contacts_beds(job->edits[i].set.job);
    return 4 * held_words(voxels) + WET_BYTES * columns_in(voxels) * beds;
}

status groundwater_create(struct gpu *gpu, const struct job *job, const int voxels[3], struct groundwater *g)
{
    status st = OK;
    *g = (struct groundwater){0};
    if (!groundwater_wanted(job))
        return OK;
    TRY(columns_create(job, voxels, &g->columns));
    TRY(gpu_buffer_create(gpu, "groundwater's rock", held_words(voxels), 4, &g->rock));
    if (g->columns.contacts.n_beds)
        TRY(gpu_buffer_create(gpu, "seepage", 2 * columns_in(voxels) * g->columns.contacts.n_beds, 16,
                              &g->wet));
done:
    if (st != OK)
        groundwater_destroy(gpu, g);
    return st;
}

void groundwater_destroy(struct gpu *gpu, struct groundwater *g)
{
    columns_destroy(&g->columns);
    gpu_buffer_destroy(gpu, &g->rock);
    gpu_buffer_destroy(gpu, &g->wet);
}

static struct seep_params params(const struct groundwater *g, const struct job *job,
                                 const struct particles *p)
{
    return (struct seep_params){.n = (uint)p->n_surface,
                                .nx = (uint)p->voxels[0],
                                .ny = (uint)p->voxels[1],
                                .nz = (uint)p->voxels[2],
                                .h = (float)p->h,
                                .walls = p->walls,
                                .beds = (uint)g->columns.contacts.n_beds,
                                .zone = (float)job->groundwater.zone_m,
                                .rate = (float)job->groundwater.sapping,
                                .threshold = (float)job->groundwater.threshold_m_per_yr,
                                .strength = (float)(1 - job->groundwater.weakening),
                                .band = (float)job->rock.interlock_band};
}

status groundwater_find(struct gpu *gpu, struct groundwater *g, const struct job *job, int frame,
                        struct gpu_buffer *layers, struct particles *p)
{
    status st = OK;
    struct columns *c = &g->columns;
    struct voxel_params bits = particles_params(p, held_words(p->voxels));
    gpu_fill(gpu, p->field[ROCK_seepage], 0);
    if (!g->wet)
        return OK;
    GPU_RUN(gpu, groundwater_rock, bits.n, bits, p->held.words, p->start, p->field[ROCK_phase], g->rock);
    TRY(gpu_download(gpu, g->rock, 0, c->rock, bits.n));
    columns_find(c);
    if (c->sums.left > AQUIFER_LEFT)
        log_warn("frame %d: groundwater stopped after %d rounds with %.2g of its recharge unaccounted for",
                 frame, c->sums.rounds, c->sums.left);
    TRY(gpu_upload(gpu, g->wet, 0, c->wet, 2 * c->contacts.n_columns * c->contacts.n_beds));
    const struct seep_params k = params(g, job, p);
    GPU_RUN(gpu, groundwater_seep, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_phase], g->wet, layers,
            p->field[ROCK_layer], p->field[ROCK_rate_factor], p->field[ROCK_interlock_factor],
            p->field[ROCK_stress], p->field[ROCK_seepage], p->field[ROCK_erodibility]);
done:
    return st;
}

void groundwater_sap(struct gpu *gpu, const struct groundwater *g, const struct job *job,
                     const struct particles *p, struct gpu_buffer *intensity, struct gpu_buffer *parts)
{
    if (!g->wet)
        return;
    const struct seep_params k = params(g, job, p);
    GPU_RUN(gpu, groundwater_sap, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_N], p->held.words,
            p->field[ROCK_phase], g->wet, intensity, parts);
}
