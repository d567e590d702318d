#include "shape/shape.h"

#include <math.h>

#include "shape/mesh.h"

/* ---- distances, in the shape's own space */

static double box_distance(const double lo[3], const double hi[3], const double x[3])
{
    double outside = 0, inside = -INFINITY;
    for (int a = 0; a < 3; a++) {
        double d = fmax(lo[a] - x[a], x[a] - hi[a]);
        inside = fmax(inside, d);
        outside += d > 0 ? d * d : 0;
    }
    return inside > 0 ? sqrt(outside) : inside;
}

/* A capped cone is a trapezoid rotated about its axis: the distance is computed in the plane through the axis and the point. */
static double cylinder_distance(const double from[3], const double axis[3], double length,
                                const double radius[2], const double x[3])
{
    double along = 0, square = 0;
    for (int a = 0; a < 3; a++)
        along += (x[a] - from[a]) * axis[a];
    for (int a = 0; a < 3; a++) {
        double side = x[a] - from[a] - along * axis[a];
        square += side * side;
    }
    double r = sqrt(square);
    double past = fabs(along - length / 2) - length / 2; /* beyond the caps */
    double cap = fmax(0, r - radius[along < length / 2 ? 0 : 1]);
    double slope = radius[1] - radius[0];
    double t = ((r - radius[0]) * slope + along * length) / (slope * slope + length * length);
    t = fmin(fmax(t, 0), 1);
    double wall_r = r - radius[0] - t * slope, wall_z = along - t * length;
    double d = sqrt(fmin(cap * cap + past * past, wall_r * wall_r + wall_z * wall_z));
    return past <= 0 && r <= radius[0] + slope * along / length ? -d : d;
}

static double sphere_distance(const double center[3], double radius, const double x[3])
{
    double d[3] = {x[0] - center[0], x[1] - center[1], x[2] - center[2]};
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - radius;
}

double shape_distance(const struct shape *shape, const double x[3])
{
    if (shape->kind == SHAPE_MESH || shape->kind == SHAPE_VOLUME)
        return vdb_sdf_at(shape->u.mesh, x);
    double p[3], d = INFINITY;
    placement_apply(shape->place.local_from_world, x, p);
    switch (shape->kind) {
    case SHAPE_BOX:
        d = box_distance(shape->u.box.min_m, shape->u.box.max_m, p);
        break;
    case SHAPE_SPHERE:
        d = sphere_distance(shape->u.sphere.center_m, shape->u.sphere.radius_m, p);
        break;
    case SHAPE_CYLINDER:
        d = cylinder_distance(shape->u.cylinder.from, shape->u.cylinder.axis, shape->u.cylinder.length,
                              shape->u.cylinder.radius, p);
        break;
    case SHAPE_PLANE: {
        const double *n = shape->u.plane.normal;
        d = p[0] * n[0] + p[1] * n[1] + p[2] * n[2] - shape->u.plane.offset;
        break;
    }
    case SHAPE_HEIGHTFIELD:
        d = heightfield_distance(shape->u.heightfield, p);
        break;
    case SHAPE_JOINTMAP:
        d = jointmap_distance(shape->u.jointmap, p);
        break;
    case SHAPE_STROKE:
        d = stroke_distance(shape->u.stroke, p);
        break;
    case SHAPE_STACKS:
        d = terrain_shape_distance(shape->u.terrain, p);
        break;
    case SHAPE_VOXELS:
        d = voxel_shape_distance(shape->u.voxels, p);
        break;
    case SHAPE_FUNCTION:
        d = function_distance(shape->u.function, p);
        break;
    case SHAPE_MESH:
    case SHAPE_VOLUME:
        break;
    }
    return d * shape->place.min_scale;
}

bool shape_holds_box(const struct shape *shape, const double min[3], const double max[3])
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    if (shape->kind != SHAPE_BOX)
        return false;
    placement_box_local(&shape->place, min, max, lo, hi);
    for (int a = 0; a < 3; a++)
        if (!(lo[a] >= shape->u.box.min_m[a] && hi[a] <= shape->u.box.max_m[a]))
            return false;
    return true;
}

bool shape_loose(const struct shape *shape, const double x[3])
{
    double p[3];
    if (shape->kind != SHAPE_STACKS)
        return false;
    placement_apply(shape->place.local_from_world, x, p);
    return terrain_shape_loose(shape->u.terrain, p);
}

/* ---- shapes from the job */

/* Normalises v and returns its length, in two steps so that tiny and huge vectors neither underflow nor overflow. */
static double normalize(double v[3])
{
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2]))), length = 0;
    if (!(largest > 0))
        return 0;
    for (int a = 0; a < 3; a++) {
        v[a] /= largest;
        length += v[a] * v[a];
    }
    length = sqrt(length);
    for (int a = 0; a < 3; a++)
        v[a] /= length;
    return length * largest;
}

static status cylinder_init(struct shape *s, const struct job_cylinder *c)
{
    double lo[3], hi[3], top = c->top_radius_m < 0 ? c->radius_m : c->top_radius_m;
    double widest = fmax(c->radius_m, top);
    for (int a = 0; a < 3; a++) {
        s->u.cylinder.from[a] = c->from_m[a];
        s->u.cylinder.axis[a] = c->to_m[a] - c->from_m[a];
        lo[a] = fmin(c->from_m[a], c->to_m[a]) - widest;
        hi[a] = fmax(c->from_m[a], c->to_m[a]) + widest;
    }
    s->u.cylinder.radius[0] = c->radius_m;
    s->u.cylinder.radius[1] = top;
    s->u.cylinder.length = normalize(s->u.cylinder.axis);
    if (!(s->u.cylinder.length > 0))
        return fail(E_USAGE, "scene: a cylinder's from_m and to_m are the same point: move one of them");
    placement_box(&s->place, lo, hi, s->min, s->max);
    return OK;
}

static status plane_init(struct shape *s, const struct job_plane *p)
{
    double *n = s->u.plane.normal;
    for (int a = 0; a < 3; a++)
        n[a] = p->normal[a];
    if (!(normalize(n) > 0))
        return fail(E_USAGE, "scene: a plane's normal is 0: set it to the direction out of the rock");
    s->u.plane.offset = p->point_m[0] * n[0] + p->point_m[1] * n[1] + p->point_m[2] * n[2];
    for (int a = 0; a < 3; a++) {
        s->min[a] = -INFINITY;
        s->max[a] = INFINITY;
    }
    return OK;
}

/* Checks min_m < max_m. */
static status check_corners(const char *what, const double min[3], const double max[3])
{
    for (int a = 0; a < 3; a++)
        if (!(min[a] < max[a]))
            return fail(E_USAGE, "scene: a %s has min_m %g and max_m %g on %c: max_m must be larger", what,
                        min[a], max[a], "xyz"[a]);
    return OK;
}

status shape_init(struct shape *s, const struct job_node *node, const struct placement *place, double detail,
                  double reach)
{
    status st = OK;
    *s = (struct shape){
        .kind = node->shape,
        .place = *place,
        .min = {INFINITY, INFINITY, INFINITY},
        .max = {-INFINITY, -INFINITY, -INFINITY},
        .file_m3 = (double)NAN,
    };
    switch (node->shape) {
    case SHAPE_BOX:
        s->u.box = node->u.box;
        TRY(check_corners("box", s->u.box.min_m, s->u.box.max_m));
        placement_box(place, s->u.box.min_m, s->u.box.max_m, s->min, s->max);
        break;
    case SHAPE_SPHERE: {
        const struct job_sphere *sphere = &node->u.sphere;
        double lo[3], hi[3];
        s->u.sphere = *sphere;
        for (int a = 0; a < 3; a++) {
            lo[a] = sphere->center_m[a] - sphere->radius_m;
            hi[a] = sphere->center_m[a] + sphere->radius_m;
        }
        placement_box(place, lo, hi, s->min, s->max);
        break;
    }
    case SHAPE_CYLINDER:
        TRY(cylinder_init(s, &node->u.cylinder));
        break;
    case SHAPE_PLANE:
        TRY(plane_init(s, &node->u.plane));
        break;
    case SHAPE_MESH:
        TRY(mesh_shape_create(&node->u.mesh, place, detail, reach, &s->u.mesh, s->min, s->max, &s->file_m3));
        break;
    case SHAPE_VOLUME:
        TRY(volume_shape_create(&node->u.volume, place, detail, reach, &s->u.mesh, s->min, s->max,
                                &s->file_m3));
        break;
    case SHAPE_FUNCTION: {
        const struct job_function *f = &node->u.function;
        TRY(check_corners("function", f->min_m, f->max_m));
        TRY(function_create(f, detail / place->min_scale, &s->u.function));
        placement_box(place, f->min_m, f->max_m, s->min, s->max);
        break;
    }
    case SHAPE_HEIGHTFIELD: {
        const struct job_heightfield *h = &node->u.heightfield;
        double lo[3], hi[3];
        TRY(heightfield_create(h, reach / place->min_scale, &s->u.heightfield));
        heightfield_bounds(s->u.heightfield, lo, hi);
        s->file_m3 = heightfield_volume(s->u.heightfield) * placement_volume_scale(place);
        placement_box(place, lo, hi, s->min, s->max);
        break;
    }
    case SHAPE_JOINTMAP: {
        const struct job_jointmap *j = &node->u.jointmap;
        TRY(check_corners("jointmap", j->min_m, j->max_m));
        TRY(jointmap_create(j, &s->u.jointmap));
        placement_box(place, j->min_m, j->max_m, s->min, s->max);
        break;
    }
    case SHAPE_STROKE: {
        double lo[3], hi[3];
        TRY(stroke_create(&node->u.stroke, &s->u.stroke));
        stroke_bounds(s->u.stroke, lo, hi);
        placement_box(place, lo, hi, s->min, s->max);
        break;
    }
    case SHAPE_STACKS: {
        const double origin[3] = {0, 0, 0};
        double size[3];
        TRY(terrain_shape_create(&node->u.stacks, reach / place->min_scale, &s->u.terrain));
        terrain_shape_size(s->u.terrain, size);
        placement_box(place, origin, size, s->min, s->max);
        break;
    }
    case SHAPE_VOXELS: {
        const double origin[3] = {0, 0, 0};
        double size[3];
        TRY(voxel_shape_create(&node->u.voxels, &s->u.voxels));
        voxel_shape_size(s->u.voxels, size);
        s->file_m3 = voxel_shape_volume(s->u.voxels) * placement_volume_scale(place);
        placement_box(place, origin, size, s->min, s->max);
        break;
    }
    }
done:
    return st;
}

void shape_deinit(struct shape *shape)
{
    if (shape->kind == SHAPE_MESH || shape->kind == SHAPE_VOLUME)
        vdb_sdf_destroy(&shape->u.mesh);
    if (shape->kind == SHAPE_HEIGHTFIELD)
        heightfield_destroy(&shape->u.heightfield);
    if (shape->kind == SHAPE_JOINTMAP)
        jointmap_destroy(&shape->u.jointmap);
    if (shape->kind == SHAPE_STROKE)
        stroke_destroy(&shape->u.stroke);
    if (shape->kind == SHAPE_STACKS)
        terrain_shape_destroy(&shape->u.terrain);
    if (shape->kind == SHAPE_VOXELS)
        voxel_shape_destroy(&shape->u.voxels);
    if (shape->kind == SHAPE_FUNCTION)
        function_destroy(&shape->u.function);
}
