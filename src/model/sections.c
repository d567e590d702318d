#include "model/sections.h"

#include <string.h>

#include "base/memory.h"
#include "scene/scene.h"

status section_add(struct checkpoint *c, const char *name, size_t item, size_t n, void **data)
{
    struct checkpoint_section *s = &c->section[c->n_sections];
    size_t length = strlen(name);
    memcpy(s->name, name, length < sizeof s->name ? length + 1 : sizeof s->name - 1);
    s->item = item;
    s->n = n;
    status st = memory_alloc(n, item, name, &s->data);
    if (st == OK)
        c->n_sections++;
    *data = s->data;
    return st;
}

status section_find(const struct checkpoint *c, const char *name, size_t item, size_t n,
                    const struct checkpoint_section **out)
{
    *out = checkpoint_find(c, name, item);
    if (!*out || (n && (*out)->n != n))
        return fail(E_CHECKPOINT, "the checkpoint of frame %d has no usable section '%s'", c->frame, name);
    return OK;
}

enum { DOMAIN_MODEL, DOMAIN_VOXELS, DOMAIN_SPACING = DOMAIN_VOXELS + 3, DOMAIN_STRATA, DOMAIN_NUMBERS };

static status domain_numbers(const struct job *job, double out[DOMAIN_NUMBERS])
{
    status st = OK;
    int voxels[3];
    TRY(scene_voxels(job, voxels));
    out[DOMAIN_MODEL] = job->model;
    for (int a = 0; a < 3; a++)
        out[DOMAIN_VOXELS + a] = voxels[a];
    out[DOMAIN_SPACING] = job->domain.spacing_m;
    out[DOMAIN_STRATA] = (double)job->n_strata;
done:
    return st;
}

status section_add_domain(struct checkpoint *c, const struct job *job)
{
    status st = OK;
    void *data;
    TRY(section_add(c, "domain", 8, DOMAIN_NUMBERS, &data));
    TRY(domain_numbers(job, data));
done:
    return st;
}

status section_check_domain(const struct checkpoint *c, const struct job *job)
{
    status st = OK;
    const struct checkpoint_section *s;
    double here[DOMAIN_NUMBERS];
    TRY(section_find(c, "domain", 8, DOMAIN_NUMBERS, &s));
    TRY(domain_numbers(job, here));
    const double *there = s->data;
    if (there[DOMAIN_MODEL] != here[DOMAIN_MODEL])
        return fail(E_CHECKPOINT, "the checkpoint of frame %d is of another model than the job's", c->frame);
    if (memcmp(there + DOMAIN_VOXELS, here + DOMAIN_VOXELS, 4 * sizeof *here) != 0)
        return fail(E_CHECKPOINT,
                    "the checkpoint of frame %d has %.0f x %.0f x %.0f voxels of %g m, and this job's domain "
                    "%.0f x %.0f x %.0f of %g m: give it the same domain",
                    c->frame, there[1], there[2], there[3], there[DOMAIN_SPACING], here[1], here[2], here[3],
                    here[DOMAIN_SPACING]);
    if (there[DOMAIN_STRATA] != here[DOMAIN_STRATA])
        return fail(E_CHECKPOINT,
                    "the checkpoint of frame %d has %.0f strata, and this job %.0f: give it as many",
                    c->frame, there[DOMAIN_STRATA], here[DOMAIN_STRATA]);
done:
    return st;
}
