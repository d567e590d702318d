/* The arrays of arenite that outlive a stage, besides its particles: the displacement and its stress, the air, material points, and the
 * intensity of erosion. */
#include <string.h>

#include "model/arenite.h"

static void watch_mpm(struct watch_list *list, const struct mpm *m)
{
    for (int v = 0; v < MPM_VECTORS; v++)
        watch_add(list, mpm_vector_names[v], m->vector[v], m->n);
    for (int w = 0; w <= MPM_STRENGTH; w++)
        watch_add(list, mpm_word_names[w], m->word[w], m->n);
}

static void watch_air(struct watch_list *list, const struct flow *f)
{
    struct flow_array array[FLOW_ARRAYS];
    flow_arrays(f, array);
    for (int i = 0; i < FLOW_ARRAYS; i++)
        if (!array[i].words)
            watch_add(list, array[i].name, array[i].buffer, array[i].n);
    watch_add(list, "the air's mean velocity", f->mean, f->mean ? gpu_buffer_count(f->mean) : 0);
}

void arenite_watch(const struct model *m, struct watch_list *list)
{
    const struct arenite *a = (const struct arenite *)m;
    const struct elastic *e = &a->elastic;
    if (e->u && watch_between(list, "stress", "stress")) {
        watch_add(list, "displacement", e->u, gpu_buffer_count(e->u));
        watch_add(list, "normal stress", e->normal_stress, gpu_buffer_count(e->normal_stress));
        watch_add(list, "shear stress", e->shear_stress, gpu_buffer_count(e->shear_stress));
    }
    /* The next stage reads it; afterwards it is scratch memory. */
    if (strcmp(list->stage, "wind") == 0 || strcmp(list->stage, "water") == 0)
        watch_add(list, "intensity", a->erosion.intensity, a->particles.n_surface);
    if (a->wind.flows && watch_between(list, "wind", "wind"))
        watch_air(list, &a->wind.flow);
    if (watch_between(list, "collapse", "collapse"))
        watch_mpm(list, &a->collapse.mpm);
    if (watch_between(list, "stress", "stress"))
        watch_mpm(list, &a->mpm);
}
