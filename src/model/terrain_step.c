/* One frame of terrain: its tools, then what slides. */
#include <stdio.h>

#include "base/log.h"
#include "model/terrain.h"
#include "stacks/loosen.h"
#include "stacks/stabilise.h"

static void extend(struct terrain_area *area, const int from[2], const int to[2])
{
    for (int a = 0; a < 2; a++) {
        area->lo[a] = from[a] < area->lo[a] ? from[a] : area->lo[a];
        area->hi[a] = to[a] > area->hi[a] ? to[a] : area->hi[a];
    }
}

status terrain_shape(const struct terrain_work *w, int frame, bool all, struct terrain_area *area)
{
    status st = OK;
    const struct job_arches *job = &w->job->arches;
    const struct tools tools = terrain_tools(w->job, w->stacks, w->table, w->n_materials);
    const int *n = w->stacks->n;
    int from[2], to[2];
    *area = (struct terrain_area){{n[0], n[1]}, {-1, -1}};
    for (size_t i = 0; i < job->n_operations; i++) {
        char path[64];
        if (!operation_active(&job->operations[i], frame))
            continue;
        snprintf(path, sizeof path, "arches.operations.%zu", i);
        TRY(operation_apply(w->stacks, &tools, &job->operations[i], path, frame, from, to));
        if (w->count)
            w->count(w->user, 0);
        extend(area, from, to);
    }
    /* If slides continue from frame to frame, material anywhere may be sliding. */
    if (all || job->sweeps)
        *area = (struct terrain_area){{0, 0}, {n[0] - 1, n[1] - 1}};
    if (job->unheld == UNHELD_FALL && area->lo[0] <= area->hi[0]) {
        TRY(loosen(w->stacks, spaces_kinds(w->table, w->n_materials).solid, from, to));
        extend(area, from, to);
    }
done:
    return st;
}

status terrain_slide(const struct terrain_work *w, int frame, const struct terrain_area *area)
{
    const struct stabilise options = {.table = w->table,
                                      .n_materials = w->n_materials,
                                      .walls = job_walls(w->job),
                                      .sweeps = w->job->arches.sweeps};
    struct stabilised done;
    uint64_t left = 0;
    if (area->lo[0] > area->hi[0])
        return OK;
    const status st = stabilise(w->stacks, &options, area->lo, area->hi, &done);
    if (st != OK)
        return st;
    for (int k = 0; k < MATERIALS_MAX; k++)
        left += done.left[k];
    if (!w->count)
        return OK;
    w->count(w->user, left);
    if (!done.resting && !options.sweeps)
        log_warn("frame %d: after %lld sweeps some loose material still slides", frame,
                 (long long)done.sweeps);
    return OK;
}
