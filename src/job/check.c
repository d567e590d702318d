/* Checks that the ranges in keys.def cannot express: values that depend on each other. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "job/parse.h"
#include "job/values.h"
#include "text/nearest.h"

/* A limit because each edit may require a copy of the job. */
enum { EDITS = 256 };

/* The value of `key` if it is given, else the mapping that lacks it. */
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
    return length(v) < 1e-6 ? yaml_fail(place(map, key), NULL, "is zero, so it gives no direction") : OK;
}

static status check_wind(const struct yaml *map, const struct job_wind *w)
{
    const double *d = w->direction;
    if (length(d) >= 1e-6 && w->flow.solver == FLOW_SPH && hypot(d[0], d[1]) < 0.5 * length(d))
        return yaml_fail(
            place(map, "direction"), NULL,
            "steeper than 60 degrees; flow.solver: sph needs a flatter direction (or use uniform)");
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
    /* Checked at the frames of either curve; if they meet between those, only a picture is affected. */
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

static status check_nodata(const struct yaml *map, const char *value)
{
    double number;
    if (!*value || yaml_decimal(value, &number))
        return OK;
    return yaml_fail(place(map, "nodata_value"), NULL,
                     "'%.40s' is not a finite number (NaN always counts as no data)", value);
}

/* The file determines the size if max_m is omitted or its x and y are 0. Heights of black and white are required unless the values are
 * metres. */
static status check_heightfield(const struct yaml *map, const struct job_heightfield *h)
{
    status st = OK;
    const bool heights = h->scale_m == 0 && !job_heights_are_metres(h);
    TRY(check_nodata(map, h->nodata_value));
    for (int i = 0; i < 3; i++)
        if (!(h->max_m[i] > h->min_m[i]) && (i == 2 ? heights : job_sizes_heightfield(h)))
            return yaml_fail(place(map, "max_m"), NULL, "not above min_m on the %c axis (%g, %g)", "xyz"[i],
                             h -> max_m[i], h -> min_m[i]);
    if ((h->origin_m[0] != 0 || h->origin_m[1] != 0) && job_sizes_heightfield(h))
        return yaml_fail(place(map, "origin_m"), NULL,
                         "conflicts with max_m, which already places the picture: omit one of them");
    if (h->offset_m != 0 && heights)
        return yaml_fail(
            place(map, "offset_m"), NULL,
            "has no effect with heights of black and white (min_m.z and max_m.z): give scale_m, or omit it");
done:
    return st;
}

static status check_image(const struct yaml *map, const struct job_image *i)
{
    status st = OK;
    double along = 0;
    TRY(check_nodata(map, i->nodata_value));
    TRY(check_direction(map, "right_m", i->right_m));
    TRY(check_direction(map, "up_m", i->up_m));
    for (int a = 0; a < 3; a++)
        along += i->right_m[a] * i->up_m[a];
    if (fabs(along) > 1e-6 * length(i->right_m) * length(i->up_m))
        st = yaml_fail(place(map, "up_m"), NULL, "not perpendicular to right_m");
done:
    return st;
}

static status check_paint(const struct yaml *map, const struct job_paint *p)
{
    const bool everywhere = !p->shape && !p->image && !p->mesh_attribute && !p->noise;
    if (everywhere && p->erodibility == 1 && p->interlock == 1 && p->viability == 1 && p->vegetation == -1 &&
        !p->inert)
        return yaml_fail(map, NULL,
                         "paints nothing: add erodibility, interlock, viability, vegetation or inert");
    if (p->falloff_m > 0 && !p->shape)
        return yaml_fail(place(map, "falloff_m"), NULL, "applies to a shape, and none is given");
    if (p->vegetation < 0 && p->vegetation != -1)
        return yaml_fail(place(map, "vegetation"), NULL, "negative (0 to 1, or -1 for unchanged)");
    return OK;
}

static status check_mesh_attribute(const struct yaml *map, const struct job_mesh_attribute *m)
{
    return m->from == m->to
               ? yaml_fail(place(map, "to"), NULL, "equal to from (%g): no value paints", m->from)
               : OK;
}

static status check_light(const struct yaml *map, const struct job_light *l)
{
    if (l->sun && l->solar)
        return yaml_fail_key(yaml_get(map, "solar"), "and sun exclude each other: omit one of them");
    for (size_t i = 0; i < l->temperature_K.n; i++)
        if (l->temperature_K.value[i] > 0 && l->temperature_K.value[i] < 1667)
            return yaml_fail(place(map, "temperature_K"), NULL,
                             "%g K is below 1667 (0: as the atmosphere filters it)",
                             l->temperature_K.value[i]);
    return OK;
}

static status check_material(const struct yaml *map, const struct job_material *m)
{
    if (m->repose_deg < 0 && m->repose_deg != -1)
        return yaml_fail(place(map, "repose_deg"), NULL, "negative (0 to 90, or -1 for the default)");
    if (strcmp(m->name, "air") == 0)
        return yaml_fail(map, NULL, "air is not a material that can be changed");
    return OK;
}

static status check_profiles(const struct yaml *map, const struct job_operation *op)
{
    const struct yaml *list = yaml_get(map, "profiles");
    if (op->n_profiles && !op->n_profile)
        return yaml_fail(list, NULL, "without profile, which the other points have");
    for (size_t i = 0; i < op->n_profiles; i++) {
        const struct job_point_profile *p = &op->profiles[i];
        const struct yaml *item = yaml_item(list, i);
        if (p->point >= (long long)op->n_points_m)
            return yaml_fail(place(item, "point"), NULL,
                             "%lld is not one of the %zu points, which count from 0", (long long)p->point,
                             op->n_points_m);
        if (p->n_profile != op->n_profile)
            return yaml_fail(place(item, "profile"), NULL, "%zu points, but the sweep's profile has %zu",
                             p->n_profile, op->n_profile);
        for (size_t k = 0; k < i; k++)
            if (op->profiles[k].point == p->point)
                return yaml_fail(place(item, "point"), NULL, "point %lld has a profile already",
                                 (long long)p->point);
    }
    return OK;
}

/* Checks what each tool requires. */
static status check_operation(const struct yaml *map, const struct job_operation *op)
{
    if (op->n_points_m == 0 && op->tool != TOOL_NOISE)
        return yaml_fail(place(map, "points_m"), NULL,
                         "this tool needs at least one point [x, y, z, radius]");
    for (size_t i = 0; i < op->n_points_m; i++)
        if (!(op->points_m[i][3] > 0))
            return yaml_fail(yaml_item(yaml_get(map, "points_m"), i), NULL,
                             "a radius of %g m (must be above 0)", op->points_m[i][3]);
    for (size_t i = 0; i < op->n_arcs; i++)
        for (int end = 0; end < 2; end++) {
            double at = op->arcs[i][end];
            if (at != floor(at) || at >= (double)op->n_points_m || op->arcs[i][0] == op->arcs[i][1])
                return yaml_fail(yaml_item(yaml_get(map, "arcs"), i), NULL,
                                 "[%g, %g] does not join two of the %zu points, which count from 0",
                                 op->arcs[i][0], op->arcs[i][1], op->n_points_m);
        }
    if (op->n_profile && op->n_profile < 3)
        return yaml_fail(yaml_get(map, "profile"), NULL, "%zu points do not form a closed curve (at least 3)",
                         op->n_profile);
    if (op->n_end_profile && op->n_end_profile != op->n_profile)
        return yaml_fail(yaml_get(map, "end_profile"), NULL, "%zu points, but profile has %zu",
                         op->n_end_profile, op->n_profile);
    if (op->tool == TOOL_SWEEP && op->n_points_m < 2)
        return yaml_fail(place(map, "points_m"), NULL, "a sweep needs at least two points");
    return check_profiles(map, op);
}

/* Checks a range of stratigraphic heights. */
static status check_heights(const struct yaml *map, double from, double to)
{
    return to > from
               ? OK
               : yaml_fail(place(map, "to_m"), NULL, "%g m is not above from_m, which is %g m", to, from);
}

static status check_attitude(const struct yaml *map, const struct job_attitude *a)
{
    for (size_t i = 1; i < a->n_unconformities; i++)
        if (!(a->unconformities[i].at_m > a->unconformities[i - 1].at_m))
            return yaml_fail(place(yaml_item(yaml_get(map, "unconformities"), i), "at_m"), NULL,
                             "%g m is not above the unconformity below, at %g m (they are listed bottom up)",
                             a->unconformities[i].at_m, a->unconformities[i - 1].at_m);
    return OK;
}

static status check_bedding(const struct yaml *map, const struct job_bedding *b)
{
    status st = check_heights(map, b->from_m, b->to_m);
    for (size_t i = 1; i < b->n_markers && st == OK; i++)
        if (b->markers[i].at_m < b->markers[i - 1].at_m + b->markers[i - 1].thickness_m)
            st = yaml_fail(
                place(yaml_item(yaml_get(map, "markers"), i), "at_m"), NULL,
                "%g m is within the marker below, which reaches to %g m (they are listed bottom up)",
                b->markers[i].at_m, b->markers[i - 1].at_m + b->markers[i - 1].thickness_m);
    return st;
}

status check_section(enum job_section_id section, const struct yaml *map, const void *base)
{
    status st;
    switch (section) {
    case SECTION_box:
        return check_corners(map, ((const struct job_box *)base)->min_m,
                             ((const struct job_box *)base)->max_m);
    case SECTION_heightfield:
        return check_heightfield(map, base);
    case SECTION_cover:
        return check_nodata(map, ((const struct job_cover *)base)->nodata_value);
    case SECTION_jointmap:
        if ((st = check_nodata(map, ((const struct job_jointmap *)base)->nodata_value)) != OK)
            return st;
        return check_corners(map, ((const struct job_jointmap *)base)->min_m,
                             ((const struct job_jointmap *)base)->max_m);
    case SECTION_function:
        return check_corners(map, ((const struct job_function *)base)->min_m,
                             ((const struct job_function *)base)->max_m);
    case SECTION_stroke:
        if (((const struct job_stroke *)base)->n_path_m == 0)
            return yaml_fail(place(map, "path_m"), NULL, "no points: a stroke needs at least one");
        return OK;
    case SECTION_image:
        return check_image(map, base);
    case SECTION_paint:
        return check_paint(map, base);
    case SECTION_mesh_attribute:
        return check_mesh_attribute(map, base);
    case SECTION_cylinder:
        return check_cylinder(map, base);
    case SECTION_plane:
        return check_direction(map, "normal", ((const struct job_plane *)base)->normal);
    case SECTION_wind:
        return check_wind(map, base);
    case SECTION_camera:
        return check_camera(map, base);
    case SECTION_light:
        return check_light(map, base);
    case SECTION_material:
        return check_material(map, base);
    case SECTION_operation:
        return check_operation(map, base);
    case SECTION_attitude:
        return check_attitude(map, base);
    case SECTION_bedding:
        return check_bedding(map, base);
    case SECTION_concretion:
        return check_heights(map, ((const struct job_concretion *)base)->from_m,
                             ((const struct job_concretion *)base)->to_m);
    case SECTION_joint_set:
        return check_heights(map, ((const struct job_joint_set *)base)->from_m,
                             ((const struct job_joint_set *)base)->to_m);
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
    list = yaml_get(root, "strata_from");
    for (size_t i = 1; i < job->n_strata_from; i++)
        if (job->strata_from[i].from_m < job->strata_from[i - 1].to_m)
            return yaml_fail(
                place(yaml_item(list, i), "from_m"), NULL,
                "%g m is within the beds before, which reach to %g m (they are listed bottom up)",
                job->strata_from[i].from_m, job->strata_from[i - 1].to_m);
    return OK;
}

/* On case-insensitive file systems their files would collide. */
static status check_camera_names(const struct yaml *root, const struct job *job)
{
    const struct yaml *map = yaml_get(root, "cameras");
    for (size_t i = 0; map && i < job->n_cameras; i++)
        for (size_t k = 0; k < i; k++)
            if (strcasecmp(job->cameras[i].name, job->cameras[k].name) == 0)
                return yaml_fail_key(yaml_get(map, job->cameras[i].name),
                                     "differs from '%s' in case only; files are named after cameras",
                                     job->cameras[k].name);
    return OK;
}

static status check_farm_cameras(const struct yaml *root, const struct job *job)
{
    const struct yaml *farm = yaml_get(root, "farm"), *list = farm ? yaml_get(farm, "cameras") : NULL;
    for (size_t i = 0; i < job->farm.n_cameras; i++) {
        bool found = false;
        for (size_t k = 0; k < job->n_cameras; k++)
            found |= strcmp(job->farm.cameras[i], job->cameras[k].name) == 0;
        if (!found)
            return yaml_fail(yaml_item(list, i), NULL, "no camera '%s' in cameras", job->farm.cameras[i]);
        /* The pictures of a single AOV camera do not carry its name, so the names cannot clash. */
        for (size_t k = 0; k < job->output.aov.n_cameras && job->output.aov.n_cameras > 1; k++)
            if (strcmp(job->farm.cameras[i], job->output.aov.cameras[k]) == 0)
                return yaml_fail(yaml_item(list, i), NULL,
                                 "camera '%s' is one of output.aov.cameras: the run makes its pictures",
                                 job->farm.cameras[i]);
    }
    return OK;
}

/* Checks that `word` is one of the n known words; if not, the message suggests the closest one. */
static status check_word(const struct yaml *at, const char *what, const char *word, const char *const *known,
                         size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (strcmp(word, known[i]) == 0)
            return OK;
    const char *near = nearest_word(word, known, n);
    return yaml_fail(at, NULL, "no %s '%s'%s%s", what, word,
                     near ? "; did you mean " : " (see jobs/README.md)", near ? near : "");
}

static status check_farm_show(const struct yaml *root, const struct job *job)
{
    status st = OK;
    const struct yaml *farm = yaml_get(root, "farm"), *list = farm ? yaml_get(farm, "show") : NULL;
    const char *known[VALUES];
    size_t n = value_names(IN_SHOW, known);
    for (size_t i = 0; i < job->farm.n_show; i++) {
        const char *name = job->farm.show[i];
        TRY(check_word(yaml_item(list, i), "value", name, known, n));
        for (size_t k = 0; k < i; k++)
            if (strcmp(name, job->farm.show[k]) == 0)
                return yaml_fail(yaml_item(list, i), NULL, "value '%s' is listed twice", name);
    }
done:
    return st;
}

/* Lists of arguments for programs: a list or mapping among them would arrive as its YAML. */
static status check_farm_arguments(const struct yaml *root)
{
    static const struct {
        const char *kind, *key; /* kind NULL: of the farm itself */
    } lists[] = {{"sim", "sbatch"},   {"derive", "sbatch"},   {"preview", "sbatch"},   {"finish", "sbatch"},
                 {"sim", "prologue"}, {"derive", "prologue"}, {"preview", "prologue"}, {"finish", "prologue"},
                 {NULL, "prologue"},  {NULL, "on_done"}};
    const struct yaml *farm = yaml_get(root, "farm");
    for (size_t k = 0; farm && k < sizeof lists / sizeof *lists; k++) {
        const struct yaml *map = lists[k].kind ? yaml_get(farm, lists[k].kind) : farm,
                          *list = map ? yaml_get(map, lists[k].key) : NULL;
        for (const struct yaml *item = list ? list->first : NULL; item; item = item->next)
            if (item->kind != YAML_SCALAR)
                return yaml_fail(
                    item, NULL,
                    "is not an argument: write one text for each, in quotes where it holds ':' or '#'");
    }
    return OK;
}

static status check_aov_layers(const struct yaml *root, const struct job *job)
{
    status st = OK;
    const struct job_aov *aov = &job->output.aov;
    const char *known[VALUES];
    size_t n = value_layers(known);
    if (aov->n_layers == 0)
        return OK;
    const struct yaml *list = yaml_get(yaml_get(yaml_get(root, "output"), "aov"), "layers");
    for (size_t i = 0; i < aov->n_layers; i++)
        TRY(check_word(yaml_item(list, i), "layer", aov->layers[i], known, n));
done:
    return st;
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
            return yaml_fail(yaml_item(list, i), NULL, "no camera '%s': the job has no cameras",
                             aov->cameras[i]);
        if (!found)
            return yaml_fail(yaml_item(list, i), NULL, "no camera '%s' in cameras (the first there is '%s')",
                             aov->cameras[i], job->cameras[0].name);
        if (again)
            return yaml_fail(yaml_item(list, i), NULL, "camera '%s' is listed twice", aov->cameras[i]);
    }
    return OK;
}

/* Checks that either years or seconds pass. */
static status check_clock(const struct yaml *root, const struct job *job)
{
    const struct job_clock *c = &job->clock;
    const struct yaml *map = yaml_get(root, "clock");
    if (c->seconds_per_frame > 0 && c->years_per_frame > 0)
        return yaml_fail(place(map, "seconds_per_frame"), NULL,
                         "conflicts with years_per_frame (%g): omit one of them, or set it to 0",
                         c->years_per_frame);
    if (c->seconds_per_frame == 0 && !(c->years_per_frame >= 1e-3))
        return yaml_fail(place(map, "years_per_frame"), NULL,
                         "%g without seconds_per_frame: no time would pass", c->years_per_frame);
    if (c->seconds_per_frame > 0 && !job_model(job)->seconds)
        return yaml_fail(place(map, "seconds_per_frame"), NULL,
                         "model: %s does not support shots in real time", job_model(job)->name);
    return OK;
}

/* The boundary of the air is the rock itself, without its mirror image behind a wall. */
static status check_walls(const struct yaml *root, const struct job *job)
{
    static const char *const sides[] = {"x_min", "x_max", "y_min", "y_max"};
    const struct yaml *wind = yaml_get(root, "wind"), *flow = wind ? yaml_get(wind, "flow") : NULL;
    unsigned walls = job_walls(job);
    int first = 0;
    if (!walls || job->wind.flow.solver != FLOW_SPH || !job_model(job)->wind)
        return OK;
    while (!(walls >> first & 1))
        first++;
    return yaml_fail(flow ? place(flow, "solver") : root, NULL,
                     "sph does not support walls, and domain.sides.%s is one (use uniform, or open sides)",
                     sides[first]);
}

/* A particle cannot fill more than its voxel. */
static status check_deposition(const struct yaml *root, const struct job *job)
{
    const struct job_deposition *d = &job->deposition;
    const struct yaml *map = yaml_get(root, "deposition");
    if ((1 - d->fines) * d->bulking <= 1)
        return OK;
    return yaml_fail(
        map ? place(map, "bulking") : root, NULL,
        "%g times the share that fines leave (1 - %g) exceeds the rock's volume; at most %g here", d->bulking,
        d->fines, 1 / (1 - d->fines));
}

static status check_sources(const struct yaml *root, const struct job *job)
{
    const struct yaml *list = yaml_get(root, "sources");
    for (size_t i = 0; i < job->n_sources; i++)
        if (job->sources[i].bed_m > 0 && job->sources[i].n_path_m == 0)
            return yaml_fail(place(yaml_item(list, i), "bed_m"), NULL, "a bed needs points in path_m");
    return OK;
}

static status check_edits(const struct yaml *root, const struct job *job)
{
    const struct yaml *list = yaml_get(root, "edits");
    if (job->n_edits > EDITS)
        return yaml_fail(list, NULL, "%zu edits (at most %d)", job->n_edits, EDITS);
    for (size_t i = 0; i < job->n_edits; i++) {
        const struct job_edit *e = &job->edits[i];
        const struct yaml *item = yaml_item(list, i);
        if (!job_model(job)->edits)
            return yaml_fail(list, NULL, "model: %s does not support edits", job_model(job)->name);
        if (i && e->frame < e[-1].frame)
            return yaml_fail(place(item, "frame"), NULL,
                             "frame %lld is before the edit above it, of frame %lld", (long long)e->frame,
                             (long long)e[-1].frame);
        if (e->frame < job->frames.first && !*job->from)
            return yaml_fail(place(item, "frame"), NULL, "frame %lld is before the job's first, %d",
                             (long long)e->frame, job->frames.first);
        if (job->clock.seconds_per_frame > 0 && e->frame > job->frames.first)
            return yaml_fail(
                place(item, "frame"), NULL,
                "a shot in real time (clock.seconds_per_frame) allows edits in its first frame only");
        if (!e->carve && !e->n_add && !e->n_paint && !e->set.n)
            return yaml_fail(item, NULL, "changes nothing: give it carve, add, paint or set");
        for (size_t k = 0; k < e->n_add; k++)
            if (e->add[k].layer >= (long long)job->n_strata)
                return yaml_fail(place(yaml_item(yaml_get(item, "add"), k), "layer"), NULL,
                                 "%lld is not one of the %zu strata (0 is the lowest, -1: by height)",
                                 (long long)e->add[k].layer, job->n_strata);
    }
    return OK;
}

/* Zipped lists must have the same length. */
static status check_wedge(const struct yaml *root, const struct job_wedge *wedge)
{
    const struct yaml *map = yaml_get(root, "wedge"), *list = yaml_get(map ? map : root, "over");
    for (size_t i = 0; i < wedge->n_over; i++) {
        const struct yaml *at = yaml_item(list, i);
        if (wedge->over[i].n_values == 0)
            return yaml_fail(place(at, "values"), NULL, "a wedge without values");
        if (wedge->combine == WEDGE_ZIP && wedge->over[i].n_values != wedge->over[0].n_values)
            return yaml_fail(
                place(at, "values"), NULL,
                "%zu values, but %s has %zu; with combine: zip all lists must have the same length",
                wedge->over[i].n_values, wedge->over[0].key, wedge->over[0].n_values);
    }
    if (wedge->n_over && *wedge->csv)
        return yaml_fail(place(map, "csv"), NULL, "conflicts with over: omit one of them");
    return OK;
}

status check_job(const struct yaml *root, const struct job *job)
{
    status st = OK;
    TRY(check_clock(root, job));
    TRY(check_strata(root, job));
    TRY(check_aov_cameras(root, job));
    TRY(check_sources(root, job));
    TRY(check_walls(root, job));
    TRY(check_deposition(root, job));
    TRY(check_edits(root, job));
    TRY(check_wedge(root, &job->wedge));
    TRY(check_aov_layers(root, job));
    TRY(check_camera_names(root, job));
    TRY(check_farm_cameras(root, job));
    TRY(check_farm_show(root, job));
    TRY(check_farm_arguments(root));
done:
    return st;
}
