#include "farm/kinds.h"

#include <string.h>

#include "farm/graph.h"

static size_t wants_meshes(const struct job *job)
{
    return job->farm.meshes;
}

static size_t wants_pictures(const struct job *job)
{
    return job->farm.n_cameras > 0;
}

static size_t wants_stills(const struct job *job)
{
    return job->farm.still_every > 0;
}

static size_t wants_values(const struct job *job)
{
    return job->farm.n_show;
}

static const char *value_shown(const struct job *job, size_t i)
{
    return job->farm.show[i];
}

static size_t wants_turntable(const struct job *job)
{
    return job->farm.turntable > 0;
}

/* AOVs from files need the particles too. */
static bool has_points(const struct job *job, int frame)
{
    return job_writes(job, JOB_VOLUMES, frame) && job_writes(job, JOB_POINTS, frame);
}

static size_t parts_of_pictures(const struct job *job)
{
    return job->farm.n_cameras;
}

static const char *camera_of_part(const struct job *job, size_t i)
{
    return job->farm.cameras[i];
}

static size_t items_of_pictures(const struct job *job, const struct farm_task *task)
{
    return range_count(task->frames) * job->farm.n_cameras;
}

static size_t items_of_views(const struct job *job, const struct farm_task *task)
{
    (void)job;
    return range_count(task->views);
}

static size_t items_of_turntable(const struct job *job, const struct farm_task *task)
{
    (void)task;
    return (size_t)job->farm.turntable;
}

const struct farm_kind_info farm_kinds[FARM_KINDS] = {
#define KIND(word, ...) [FARM_##word] = {__VA_ARGS__},
#include "farm/kinds.def"
};

const char *farm_stage_name(enum farm_kind kind)
{
    static const char *const names[] = {
#define FARM_STAGE(constant, word) #word,
        FARM_STAGES(FARM_STAGE)
#undef FARM_STAGE
    };
    return names[farm_kinds[kind].stage];
}

bool farm_kind_is_cut(enum farm_kind kind)
{
    const enum farm_cut cut = farm_kinds[kind].cut;
    return cut == CUT_BLOCKS || cut == CUT_CHUNKS || cut == CUT_LIST || cut == CUT_VIEWS;
}

bool farm_wants_gpu(enum farm_kind kind, const char *device)
{
    return farm_kinds[kind].device && !(device && strcmp(device, "cpu") == 0);
}
