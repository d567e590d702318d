/* A fourth model, for model.sh: rock that melts evenly. */
#include <math.h>
#include <string.h>

#include "frame/host.h"
#include "model/sections.h"
#include "model/type.h"
#include "particles/particles.h"
#include "scene/scene.h"

struct melt {
    struct model m; /* shared by all models */
    struct rock rock;
};

static struct melt *of(struct model *m)
{
    return (struct melt *)m;
}

static double volume_of(const struct model *m, const struct rock *rock)
{
    return model_sum(rock->viability, rock->n) * pow(m->h, 3);
}

static status estimate(const struct job *job, struct model_needs *needs)
{
    status st = OK;
    TRY(scene_estimate(job, &needs->size));
    needs->disk = (struct disk_particle){.inside = 10, .bare = 30, .volumes_bare = 50, .channel = 1.5};
    needs->frame.samples = host_grid_samples(needs->voxels, needs->size.n_particles, needs->size.n_surface);
    needs->checkpoint_bytes = 4 * (uint64_t)needs->size.n_particles;
    needs->steps = job->frames.last - job->frames.first;
done:
    return st;
}

static size_t work_items(const struct job *job, const int voxels[3])
{
    (void)job;
    return voxel_count(voxels) + 2;
}

static status create(struct model *m)
{
    status st = OK;
    struct rock *rock = &of(m)->rock;
    TRY(scene_sample(m->job, rock));
    m->ledger = (struct ledger){.start = rock->n, .rock = rock->n};
    m->start_volume = volume_of(m, rock);
done:
    return st;
}

static status begin(struct model *m)
{
    (void)m;
    return OK;
}

static status restore(struct model *m, const struct checkpoint *from)
{
    status st = OK;
    struct rock *rock = &of(m)->rock;
    const struct section_rule rule = {"ice", SECTION_FLOAT, rock->n, 1, {{0, 1}}};
    const void *ice;
    TRY(section_get(from, &rule, &ice, NULL));
    memcpy(rock->viability, ice, 4 * rock->n);
done:
    return st;
}

static void destroy(struct model *m)
{
    rock_free(&of(m)->rock);
}

static status step(struct model *m)
{
    struct rock *rock = &of(m)->rock;
    for (size_t i = 0; i < rock->n; i++)
        rock->viability[i] *= 0.9F;
    return OK;
}

static status output(struct model *m, struct frame *out)
{
    status st = OK;
    struct particles *p = &m->made;
    TRY(particles_create(m->gpu, m->work, &of(m)->rock, STATE, m->voxels, m->h, p));
    m->shown = p;
    TRY(particles_surface(m->gpu, m->work, p));
    TRY(field_build(m->gpu, m->work, &m->field, p, 0));
    TRY(particles_download(m->gpu, p, DERIVED, &out->rock));
    TRY(model_grids(m, HAS_ALWAYS, &out->grids));
    TRY(aov_render_all(m->gpu, &m->aov, m->job, &m->field, p, NULL, out));
    out->volume_m3 = volume_of(m, &out->rock);
done:
    return st;
}

static status save(struct model *m, struct checkpoint *out)
{
    status st = OK;
    void *data;
    TRY(section_add(out, "ice", 4, of(m)->rock.n, &data));
    memcpy(data, of(m)->rock.viability, 4 * of(m)->rock.n);
    TRY(sections_add_counts(out, m));
done:
    return st;
}

const struct model_type melt_type = {
    .size = sizeof(struct melt),
    .estimate = estimate,
    .work_items = work_items,
    .create = create,
    .begin = begin,
    .restore = restore,
    .destroy = destroy,
    .step = step,
    .output = output,
    .save = save,
};
