#include "farm/needs.h"

#include <math.h>
#include <stdio.h>

#include "run/memory.h"

enum { SPARE_S = 600, NOTICE_MOST_S = 65535 };

const struct job_tasks *farm_requests(const struct job *job, enum farm_kind kind)
{
    switch (farm_kinds[kind].stage) {
#define FARM_STAGE(constant, word)                                                                           \
    case STAGE_##constant:                                                                                   \
        return &job->farm.word;
        FARM_STAGES(FARM_STAGE)
#undef FARM_STAGE
    }
    return &job->farm.finish;
}

int64_t farm_units(uint64_t bytes, uint64_t unit)
{
    return (int64_t)(bytes / unit + (bytes % unit != 0));
}

/* The machine's memory at the task's peak. */
static uint64_t peak(const struct farm *f, const struct farm_task *t, bool gpu, int cpus)
{
    const struct farm_kind_info *kind = &farm_kinds[t->kind];
    const struct model_estimate *e = NULL;
    for (size_t i = 0; i < f->n_wedges; i++)
        if (f->wedge[i].job == farm_job(f, t))
            e = &f->wedge[i].estimate;
    if (t->kind == FARM_SIM)
        return e->host_bytes + run_memory_process(NULL, e) + (gpu ? 0 : e->device_bytes);
    /* Pictures are made side by side, by a process on each core. */
    const double each = kind->memory + kind->particle_memory * (double)e->n_particles;
    return (uint64_t)(MEMORY_OF_HOODOO + each * (kind->side_by_side ? cpus : 1));
}

void farm_needs(const struct farm *f, const struct farm_task *t, const char *device, struct farm_needs *out)
{
    const struct farm_kind_info *kind = &farm_kinds[t->kind];
    const struct job_tasks *keys = farm_requests(farm_job(f, t), t->kind);
    const bool sim = t->kind == FARM_SIM;
    *out = (struct farm_needs){.gpu = farm_wants_gpu(t->kind, device), .seconds = t->seconds};
    out->cpus = keys->cpus ? (int)keys->cpus : kind->device && !out->gpu ? 4 : sim ? 2 : 1;
    snprintf(out->cpus_text, sizeof out->cpus_text, "%d", out->cpus);
    out->gpu_bytes = out->gpu ? t->device_bytes : 0;
    out->peak_bytes = peak(f, t, out->gpu, out->cpus);
    out->memory_bytes = keys->memory_GB > 0 ? (uint64_t)(1e9 * keys->memory_GB)
                                            : (uint64_t)(NEEDS_MARGIN * (double)out->peak_bytes);
    out->notice_s = farm_notice_seconds(f->wedge, sim ? f->n_wedges : 0, NEEDS_NOTICE_S, NOTICE_MOST_S);
    if (keys->hours > 0)
        out->limit_s = (int64_t)ceil(3600 * keys->hours);
    else if (t->seconds > 0)
        out->limit_s = (int64_t)ceil((sim ? 1.5 : 3) * t->seconds) + SPARE_S + out->notice_s;
}
