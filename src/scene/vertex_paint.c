#include "scene/vertex_paint.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "meshinput/nearest.h"
#include "shape/mesh.h"

struct vertex_paint {
    const struct job_mesh_attribute *job;
    struct mesh mesh;
    struct nearest *nearest;
};

status vertex_paint_create(const struct job_mesh_attribute *job, struct vertex_paint **out)
{
    status st = OK;
    struct vertex_paint *p = NULL;
    double min[3] = {INFINITY, INFINITY, INFINITY}, max[3] = {-INFINITY, -INFINITY, -INFINITY};
    const struct placement world = placement_identity();
    const struct placement place = placement_transform(&world, job->scale, job->rotate_deg, job->translate_m);
    TRY(memory_alloc(1, sizeof *p, "a painted mesh", &p));
    p->job = job;
    TRY(mesh_read_placed(&(struct mesh_source){.file = job->file,
                                               .key = "mesh_attribute",
                                               .attribute = job->attribute,
                                               .y_up = job->up == MESH_ATTRIBUTE_UP_Y,
                                               .auto_origin = job->origin == MESH_ATTRIBUTE_ORIGIN_AUTO,
                                               .place = &place},
                         &p->mesh, min, max));
    TRY(nearest_create(&p->mesh, &p->nearest));
    *out = p;
    p = NULL;
done:
    vertex_paint_destroy(&p);
    return st;
}

void vertex_paint_destroy(struct vertex_paint **paint)
{
    if (!*paint)
        return;
    nearest_destroy(&(*paint)->nearest);
    mesh_free(&(*paint)->mesh);
    free(*paint);
    *paint = NULL;
}

double vertex_paint_at(const struct vertex_paint *p, const double x[3])
{
    struct nearest_point at;
    double value = 0;
    if (!nearest_find(p->nearest, x, p->job->depth_m > 0 ? p->job->depth_m : INFINITY, &at))
        return 0;
    for (int k = 0; k < 3; k++)
        value += at.weight[k] * (double)p->mesh.value[p->mesh.triangle[at.triangle][k]];
    return fmin(fmax((value - p->job->from) / (p->job->to - p->job->from), 0), 1);
}
