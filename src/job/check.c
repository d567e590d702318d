/* What the table's ranges cannot say: values that must fit each other. */
#include <math.h>
#include <string.h>

#include "base/nearest.h"
#include "job/parse.h"

/* The place of `key` where it is given, else of the mapping that lacks it. */
static const struct yaml *place(const struct yaml *map, const char *key)
{
    const struct yaml *v = yaml_get(map, key);
    return v ? v : map;
}

static double length(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static double distance(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return length(d);
}

static status check_corners(const struct yaml *map, const double min[3], const double max[3])
{
    for (int i = 0; i < 3; i++)
        if (!(max[i] > min[i]))
            return yaml_fail(place(map, "max_m"), NULL, "not above min_m on the %c axis (%g, %g)", "xyz"[i],
                             max[i], min[i]);
    return OK;
}

static status check_direction(const struct yaml *map, const char *key, const double v[3])
{
    return length(v) < 1e-6 ? yaml_fail(place(map, key), NULL, "has no length, so no direction") : OK;
}

static status check_wind(const struct yaml *map, const struct job_wind *w)
{
    const double *d = w->direction;
    if (length(d) >= 1e-6 && w->flow.solver == FLOW_SPH && hypot(d[0], d[1]) < 0.5 * length(d))
        return yaml_fail(place(map, "direction"), NULL,
                         "steeper than 60 degrees, which flow.solver: sph cannot lay flat (use uniform)");
    return check_direction(map, "direction", d);
}

static status check_cylinder(const struct yaml *map, const struct job_cylinder *c)
{
    if (distance(c->from_m, c->to_m) < 1e-6)
        return yaml_fail(place(map, "to_m"), NULL, "the same point as from_m");
    if (c->top_radius_m < 0 && c->top_radius_m != -1)
        return yaml_fail(place(map, "top_radius_m"), NULL,
                         "negative (0 or more, or -1 for the same as radius_m)");
    return OK;
}

static status check_camera(const struct yaml *map, const struct job_camera *c)
{
    /* Where either has a key; between keys it is only a picture. */
    const struct curve *keys[] = {&c->position_m, &c->target_m};
    for (size_t k = 0; k < 2; k++)
        for (size_t i = 0; i < keys[k]->n; i++) {
            double frame = keys[k]->frame[i], eye[3], target[3];
            if (curve_at(&c->orbit.distance_m, frame) > 0)
                continue;
            track_at(&c->position_m, frame, eye);
            track_at(&c->target_m, frame, target);
            if (distance(eye, target) < 1e-6)
                return yaml_fail(place(map, "target_m"), NULL, "the same point as position_m");
        }
    return OK;
}

static status check_material(const struct yaml *map, const struct job_material *m)
{
    if (m->repose_deg < 0 && m->repose_deg != -1)
        return yaml_fail(place(map, "repose_deg"), NULL, "negative (0 to 90, or -1 for its own)");
    if (strcmp(m->name, "air") == 0)
        return yaml_fail(map, NULL, "air is not a material to change");
    return OK;
}

/* What each tool needs. */
static status check_operation(const struct yaml *map, const struct job_operation *op)
{
    if (op->n_points_m == 0 && op->tool != TOOL_NOISE)
        return yaml_fail(place(map, "points_m"), NULL,
                         "this tool needs at least one point [x, y, z, radius]");
    for (size_t i = 0; i < op->n_points_m; i++)
        if (!(op->points_m[i][3] > 0))
            return yaml_fail(yaml_item(yaml_get(map, "points_m"), i), NULL, "a radius of %g m (above 0)",
                             op->points_m[i][3]);
    for (size_t i = 0; i < op->n_arcs; i++)
        for (int end = 0; end < 2; end++) {
            double at = op->arcs[i][end];
            if (at != floor(at) || at >= (double)op->n_points_m || op->arcs[i][0] == op->arcs[i][1])
                return yaml_fail(yaml_item(yaml_get(map, "arcs"), i), NULL,
                                 "[%g, %g] does not join two of the %zu points, which count from 0",
                                 op->arcs[i][0], op->arcs[i][1], op->n_points_m);
        }
    if (op->n_profile && op->n_profile < 3)
        return yaml_fail(yaml_get(map, "profile"), NULL, "%zu points close no curve (at least 3)",
                         op->n_profile);
    if (op->n_end_profile && op->n_end_profile != op->n_profile)
        return yaml_fail(yaml_get(map, "end_profile"), NULL, "%zu points, and profile has %zu",
                         op->n_end_profile, op->n_profile);
    if (op->tool == TOOL_SWEEP && op->n_points_m < 2)
        return yaml_fail(place(map, "points_m"), NULL, "a sweep needs at least two points");
    return OK;
}

status check_section(enum job_section_id section, const struct yaml *map, const void *base)
{
    switch (section) {
    case SECTION_box:
        return check_corners(map, ((const struct job_box *)base)->min_m,
                             ((const struct job_box *)base)->max_m);
    case SECTION_heightfield:
        return check_corners(map, ((const struct job_heightfield *)base)->min_m,
                             ((const struct job_heightfield *)base)->max_m);
    case SECTION_jointmap:
        return check_corners(map, ((const struct job_jointmap *)base)->min_m,
                             ((const struct job_jointmap *)base)->max_m);
    case SECTION_cylinder:
        return check_cylinder(map, base);
    case SECTION_plane:
        return check_direction(map, "normal", ((const struct job_plane *)base)->normal);
    case SECTION_wind:
        return check_wind(map, base);
    case SECTION_camera:
        return check_camera(map, base);
    case SECTION_material:
        return check_material(map, base);
    case SECTION_operation:
        return check_operation(map, base);
    default:
        return OK;
    }
}

static status check_strata(const struct yaml *root, const struct job *job)
{
    const struct yaml *list = yaml_get(root, "strata");
    for (size_t i = 1; i < job->n_strata; i++)
        if (!(job->strata[i].to_m > job->strata[i - 1].to_m))
            return yaml_fail(
                place(yaml_item(list, i), "to_m"), NULL,
                "%g m is not above the layer below, which reaches to %g m (strata are listed bottom up)",
                job->strata[i].to_m, job->strata[i - 1].to_m);
    return OK;
}

static status check_aov_layers(const struct yaml *root, const struct job *job)
{
    const struct job_aov *aov = &job->output.aov;
    const struct yaml *list = yaml_get(yaml_get(yaml_get(root, "output"), "aov"), "layers");
    for (size_t i = 0; i < aov->n_layers; i++) {
        bool found = false;
        for (size_t k = 0; k < AOV_LAYER_COUNT; k++)
            found |= strcmp(aov->layers[i], aov_layer_names[k]) == 0;
        if (!found) {
            const char *near = nearest_word(aov->layers[i], aov_layer_names, AOV_LAYER_COUNT);
            return yaml_fail(yaml_item(list, i), NULL, "no layer '%s'%s%s", aov->layers[i],
                             near ? "; did you mean " : " (see jobs/README.md)", near ? near : "");
        }
    }
    return OK;
}

static status check_aov_cameras(const struct yaml *root, const struct job *job)
{
    const struct job_aov *aov = &job->output.aov;
    if (aov->n_cameras == 0)
        return OK;
    const struct yaml *list = yaml_get(yaml_get(yaml_get(root, "output"), "aov"), "cameras");
    for (size_t i = 0; i < aov->n_cameras; i++) {
        bool found = false, again = false;
        for (size_t k = 0; k < job->n_cameras; k++)
            found |= strcmp(aov->cameras[i], job->cameras[k].name) == 0;
        for (size_t k = 0; k < i; k++)
            again |= strcmp(aov->cameras[i], aov->cameras[k]) == 0;
        if (!found && job->n_cameras == 0)
            return yaml_fail(yaml_item(list, i), NULL, "no camera '%s': cameras has none", aov->cameras[i]);
        if (!found)
            return yaml_fail(yaml_item(list, i), NULL, "no camera '%s' in cameras (the first there is '%s')",
                             aov->cameras[i], job->cameras[0].name);
        if (again)
            return yaml_fail(yaml_item(list, i), NULL, "camera '%s' is listed twice", aov->cameras[i]);
    }
    return OK;
}

/* Lists that are zipped must end together. */
static status check_wedge(const struct yaml *root, const struct job_wedge *wedge)
{
    const struct yaml *map = yaml_get(root, "wedge"), *list = yaml_get(map ? map : root, "over");
    for (size_t i = 0; i < wedge->n_over; i++) {
        const struct yaml *at = yaml_item(list, i);
        if (wedge->over[i].n_values == 0)
            return yaml_fail(place(at, "values"), NULL, "a wedge without values");
        if (wedge->combine == WEDGE_ZIP && wedge->over[i].n_values != wedge->over[0].n_values)
            return yaml_fail(place(at, "values"), NULL,
                             "%zu values, but %s has %zu; zipped lists are of one length (or combine: cross)",
                             wedge->over[i].n_values, wedge->over[0].key, wedge->over[0].n_values);
    }
    if (wedge->n_over && *wedge->csv)
        return yaml_fail(place(map, "csv"), NULL, "given beside over; a wedge has one of the two");
    return OK;
}

status check_job(const struct yaml *root, const struct job *job)
{
    status st = OK;
    TRY(check_strata(root, job));
    TRY(check_aov_cameras(root, job));
    TRY(check_wedge(root, &job->wedge));
    TRY(check_aov_layers(root, job));
done:
    return st;
}
