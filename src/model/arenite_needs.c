/* The estimate of memory, disk and steps that a job of arenite needs. */
#include "frame/host.h"
#include "model/arenite_deep.h"
#include "model/edits.h"
#include "plants/plants.h"
#include "scene/scene.h"

bool arenite_uses_stress_grid(const struct job *job)
{
    return !collapse_shot(job) && job->stress.solver != STRESS_MPM;
}

size_t arenite_work_items(const struct job *job, const int voxels[3])
{
    const size_t nodes = mpm_nodes(voxels), n = voxel_count(voxels) + 2, stress = elastic_work_items(voxels);
    const size_t most = nodes > n ? nodes : n;
    (void)job;
    return most > stress ? most : stress;
}

_Static_assert(SCENE_NEAR == NEAR_REACH + 1 + NEAR_AHEAD,
               "the estimate counts the voxels that get particles");

static uint64_t device_bytes(const struct job *job, const int voxels[3], const struct scene_size *size,
                             size_t n)
{
    const size_t all = size->n_particles, bare = size->n_surface, ends = size->n_ends;
    uint64_t sum = 0;
#define PART(name, lasts, bytes, create) sum += (bytes);
    ARENITE_PARTS(PART)
#undef PART
    return sum + (job_keeps_exposed(job) ? n * rock_field_size(ROCK_exposed_kyr) : 0) +
           (job_seeps(job) ? n * rock_field_size(ROCK_seepage) : 0);
}

static double steps(const struct job *job)
{
    double sum = 0;
    for (int f = job->frames.first + 1; f <= job->frames.last; f++)
        sum += erosion_steps(job_at(job, f), wind_fastest(job_at(job, f), f));
    return sum;
}

unsigned arenite_has(const struct job *job, bool water, bool plants, bool deposits, bool exposed)
{
    return HAS_ALWAYS | (water ? HAS_WATER : 0U) | (plants ? HAS_PLANTS : 0U) |
           (deposits ? HAS_DEPOSITS : 0U) | (exposed ? HAS_EXPOSED : 0U) |
           (job_seeps(job) ? HAS_SEEPAGE : 0U) | (job->clock.seconds_per_frame > 0 ? HAS_MOTION : 0U);
}

status arenite_estimate(const struct job *job, struct model_needs *needs)
{
    status st = OK;
    TRY(scene_estimate(job, &needs->size));
    TRY(wind_check(job, needs->voxels));
    if (arenite_may_be_deep(job))
        needs->size.n_kept = needs->size.n_near;
    const size_t n = needs->size.n_kept;
    needs->capacity = n < needs->size.n_particles ? particles_capacity_for(n) : n;
    const unsigned has = arenite_has(job, water_ever_flows(job), plants_wanted(job) || edits_plant(job),
                                     edits_ever(job, deposit_wanted), job_keeps_exposed(job));
    needs->device_bytes = device_bytes(job, needs->voxels, &needs->size, needs->capacity);
    needs->frame.samples = host_grid_samples(needs->voxels, needs->size.n_particles, needs->size.n_surface);
    const uint64_t ages = job_keeps_exposed(job) ? n : 0;
    needs->frame.grids = value_grids(has) - value_grids(HAS_ALWAYS);
    needs->frame.kept = arenite_uses_stress_grid(job) ? 2 : 0; /* see inside_values() */
    needs->frame.own =
        ages * rock_field_size(ROCK_exposed_kyr) + (job_seeps(job) ? n * rock_field_size(ROCK_seepage) : 0);
    needs->disk = (struct disk_particle){
        .inside = 15.5, .bare = 45, .volumes_inside = 2.2, .volumes_bare = 88, .channel = 1.9, .has = has};
    needs->checkpoint_bytes = 15 * (uint64_t)n + ages + held_words(needs->voxels) / 4 +
                              (uint64_t)(0.3 * (double)wind_checkpoint_bytes(job, needs->voxels)) +
                              collapse_checkpoint_bytes(job, n);
    needs->steps = steps(job);
    needs->kernels = 80;
done:
    return st;
}
