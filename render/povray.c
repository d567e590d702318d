/* Scene text. POV-Ray's mesh2 lists vertices, then normals, then faces.
 *
 * Handedness   POV-Ray is left-handed by convention, but a camera given by its four vectors has no handedness: a ray
 *              goes through location + direction + u right + v up. So data and cameras keep the axes of the simulator,
 *              and nothing is mirrored.
 */
#include "render/povray.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/version.h"
#include "job/palette.h"
#include "render/daylight.h"
#include "render/ground.h"
#include "render/pile.h"
#include "render/refine.h"
#include "render/scatter.h"
#include "render/scene_parts.h"

const enum value_id scene_values[SCENE_VALUES] = {[SCENE_VEGETATION] = VALUE_vegetation,
                                                  [SCENE_DEPOSIT] = VALUE_deposit,
                                                  [SCENE_BEDROCK] = VALUE_bedrock,
                                                  [SCENE_SAND] = VALUE_sand};

static void add_vectors(struct text *out, const char *name, const struct scene *s, size_t offset)
{
    text_add(out, "#declare %s = array[%zu] {", name, s->n_cameras);
    for (size_t i = 0; i < s->n_cameras; i++) {
        const double *v = (const double *)(const void *)((const char *)&s->camera[i] + offset);
        text_add(out, "%s\n    <%.9g, %.9g, %.9g>", i ? "," : "", v[0], v[1], v[2]);
    }
    text_add(out, "\n}\n");
}

static void add_strata(struct text *out, const struct scene *s)
{
    size_t n = s->job->n_strata;
    text_add(out, "\n#declare Layers = %zu;\n#declare Layer_Top = array[%zu] {", n, n);
    for (size_t i = 0; i < n; i++)
        text_add(out, "%s%.9g", i ? ", " : "", fmin(s->job->strata[i].to_m, 1e6));
    text_add(out, "}\n#declare Layer_Color = array[%zu] {", n);
    for (size_t i = 0; i < n; i++) {
        float rgb[3];
        palette_color(s->job, i, rgb);
        text_add(out, "%s<%.4f, %.4f, %.4f>", i ? ", " : "", (double)rgb[0], (double)rgb[1], (double)rgb[2]);
    }
    text_add(out, "}\n");
}

static bool is_terrain(const struct scene *s)
{
    return job_model(s->job)->terrain;
}

/* The textures of terrain.inc, indexed by quarters of sand and of the axes. */
enum { QUARTERS = 4, AXIS_SHARES = 15 };

static void add_textures(struct text *out)
{
    text_add(out, "}\ntexture_list { %d", (QUARTERS + 1) * AXIS_SHARES);
    for (int sand = 0; sand <= QUARTERS; sand++)
        for (int axes = 0; axes < AXIS_SHARES; axes++)
            text_add(out, ",\ntexture { Ground[%d][%d] }", sand, axes);
}

/* Weights of the axes are |n|^8, normalised (Arches, section 6); the share of sand is that in the visible material. */
static int texture_of(const struct vdb_mesh *m, uint32_t vertex)
{
    const float *n = m->normal + 3 * (size_t)vertex;
    double power[3], sum = 1e-30, bedrock = (double)m->value[SCENE_BEDROCK * m->n_vertices + vertex];
    double sand = (double)m->value[SCENE_SAND * m->n_vertices + vertex];
    for (int a = 0; a < 3; a++) {
        power[a] = pow(fabs((double)n[a]), 8);
        sum += power[a];
    }
    int x = (int)lrint(QUARTERS * power[0] / sum), y = (int)lrint(QUARTERS * power[1] / sum);
    y = y > QUARTERS - x ? QUARTERS - x : y;
    int before = 0;
    for (int k = 0; k < x; k++)
        before += QUARTERS + 1 - k;
    int share = (int)lrint(QUARTERS * (sand > 0 ? sand / (sand + bedrock) : 0));
    return (share > QUARTERS ? QUARTERS : share) * AXIS_SHARES + before + y;
}

/* The texture of a vertex: rock, scree, or the ground under plants. */
static int ground_of(const struct vdb_mesh *m, size_t vertex)
{
    if (m->value[SCENE_VEGETATION * m->n_vertices + vertex] > 0.3F)
        return 2;
    return m->value[SCENE_DEPOSIT * m->n_vertices + vertex] > 0.5F ? 1 : 0;
}

/* The position of the value on the colour bar is the vertex's texture coordinate, so that POV-Ray interpolates values
 * between vertices and not colours. */
static void add_heat(struct text *out, const struct scene *s)
{
    const struct vdb_mesh *m = s->mesh;
    text_add(out, "}\nuv_vectors { %zu", m->n_vertices);
    for (size_t i = 0; i < m->n_vertices; i++) {
        double t = show_position(s->show, s->range, (double)m->value[i] * value_table[s->show].legend.scale);
        /* A gradient repeats at 1. */
        text_add(out, ",\n<%.4f,0>", 0.001 + 0.998 * t);
    }
    text_add(out, "}\nface_indices { %zu", m->n_triangles);
    for (size_t i = 0; i < m->n_triangles; i++) {
        const uint32_t *t = m->triangle + 3 * i;
        text_add(out, ",\n<%u,%u,%u>", t[0], t[1], t[2]);
    }
    text_add(out, "}\ntexture { uv_mapping Heat }\n}\n\n");
}

static void add_heat_colors(struct text *out, const struct scene *s)
{
    enum { STOPS = 64 };
    text_add(
        out,
        "// %s from %g to %g %s\n#declare Heat = texture {\n    pigment {\n        gradient x\n        color_map {\n",
        value_table[s->show].name, s->range.low, s->range.high, value_table[s->show].legend.unit);
    for (int i = 0; i <= STOPS; i++) {
        unsigned char rgb[3];
        show_color(s->show, s->range, (double)i / STOPS, rgb);
        text_add(out, "            [%.6f srgb <%.4f, %.4f, %.4f>]\n", 0.001 + 0.998 * i / STOPS,
                 rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
    }
    text_add(out, "        }\n    }\n    finish { Even }\n}\n");
}

/* Few digits, since parsing the mesh takes most of the time of a small picture. */
static void add_mesh(struct text *out, const struct scene *s)
{
    const struct vdb_mesh *m = s->mesh;
    int digits = (int)fmax(0, ceil(log10(100000 / s->view.span)));
    text_add(out, "\n#declare Rock = mesh2 {\nvertex_vectors { %zu", m->n_vertices);
    for (size_t i = 0; i < m->n_vertices; i++) {
        const float *v = m->vertex + 3 * i;
        text_add(out, ",\n<%.*f,%.*f,%.*f>", digits, (double)v[0], digits, (double)v[1], digits,
                 (double)v[2]);
    }
    text_add(out, "}\nnormal_vectors { %zu", m->n_vertices);
    for (size_t i = 0; i < m->n_vertices; i++) {
        const float *v = m->normal + 3 * i;
        text_add(out, ",\n<%.3f,%.3f,%.3f>", (double)v[0], (double)v[1], (double)v[2]);
    }
    if (s->show != VALUE_NONE) {
        add_heat(out, s);
        return;
    }
    bool bare = !is_terrain(s);
    for (size_t i = 0; i < m->n_vertices && bare; i++)
        bare = ground_of(m, i) == 0;
    if (is_terrain(s))
        add_textures(out);
    else if (!bare)
        text_add(out, "}\n"
                      "texture_list { 3, texture { Sandstone }, texture { Talus }, texture { Litter }");
    text_add(out, "}\nface_indices { %zu", m->n_triangles);
    for (size_t i = 0; i < m->n_triangles; i++) {
        const uint32_t *t = m->triangle + 3 * i;
        text_add(out, ",\n<%u,%u,%u>", t[0], t[1], t[2]);
        if (is_terrain(s))
            text_add(out, ",%d,%d,%d", texture_of(m, t[0]), texture_of(m, t[1]), texture_of(m, t[2]));
        else if (!bare)
            text_add(out, ",%d,%d,%d", ground_of(m, t[0]), ground_of(m, t[1]), ground_of(m, t[2]));
    }
    text_add(out, "}\n%s}\n\n", bare ? "texture { Sandstone }\n" : "");
}

/* Each shape that is used, once; then the placed rocks. */
static status add_rocks(struct text *out, const struct scene *s)
{
    const struct pile_tile *tile = s->rocks.tile;
    const struct rock *at = s->rocks.at;
    int digits = (int)fmax(0, ceil(log10(200 / tile->radius)));
    for (size_t k = 0; k < tile->n; k++) {
        const struct pile_rock *r = &tile->rock[k];
        text_add(out, "#declare Rock_%zu = mesh2 {\nvertex_vectors { %zu", k, r->n_vertices);
        for (size_t i = 0; i < r->n_vertices; i++)
            text_add(out, ",\n<%.*f,%.*f,%.*f>", digits, (double)r->vertex[3 * i], digits,
                     (double)r->vertex[3 * i + 1], digits, (double)r->vertex[3 * i + 2]);
        text_add(out, "}\nnormal_vectors { %zu", r->n_vertices);
        for (size_t i = 0; i < r->n_vertices; i++)
            text_add(out, ",\n<%.3f,%.3f,%.3f>", (double)r->normal[3 * i], (double)r->normal[3 * i + 1],
                     (double)r->normal[3 * i + 2]);
        text_add(out, "}\nface_indices { %zu", tile->n_triangles);
        for (size_t i = 0; i < tile->n_triangles; i++)
            text_add(out, ",\n<%u,%u,%u>", tile->triangle[3 * i], tile->triangle[3 * i + 1],
                     tile->triangle[3 * i + 2]);
        text_add(out, "}\n}\n");
    }
    for (size_t i = 0; i < at->n; i++) {
        if (at->layer[i] >= tile->n)
            return fail(E_INPUT, "frame %d: rock %zu has shape %u, but the tile has only %zu shapes",
                        s->frame, i, (unsigned)at->layer[i], tile->n);
        text_add(out, "object { Rock_%u texture { Rubble } translate <%.*f,%.*f,%.*f> }\n",
                 (unsigned)at->layer[i], digits, (double)at->P[4 * i], digits, (double)at->P[4 * i + 1],
                 digits, (double)at->P[4 * i + 2]);
    }
    return OK;
}

static void add_color(struct text *out, const char *name, const struct job *job, size_t layer)
{
    float rgb[3];
    palette_color(job, layer, rgb);
    text_add(out, "#declare %s = <%.4f, %.4f, %.4f>;\n", name, (double)rgb[0], (double)rgb[1],
             (double)rgb[2]);
}

static void add_part(struct text *out, const char *const *line)
{
    for (; *line; line++)
        text_add_bytes(out, *line, strlen(*line));
    text_add(out, "\n");
}

/* ---- the scene around it */

static void add_head(struct text *out, const struct scene *s)
{
    const char *care = s->preset == PRESET_DRAFT   ? "-A"
                       : s->preset == PRESET_FINAL ? "+A0.05 +AM2 +R3"
                                                   : "+A0.3 +AM2 +R2";
    text_add(out, "// hoodoo %s: %s, frame %d. Simulator axes: z up, metres.\n", hoodoo_version, s->job->name,
             s->frame);
    text_add(out, "// Complete in itself: povray +I%s +W%d +H%d %s -D Declare=View=0%s\n", s->file,
             s->camera->width, s->camera->height, care, s->show == VALUE_NONE ? " +FP16 File_Gamma=1" : "");
    if (s->show == VALUE_NONE)
        text_add(
            out,
            "// That is scene-linear light, of which 1 is %g here; previews show it through the curve of render/develop.h.\n",
            DAYLIGHT_SCALE);
    if (s->n_cameras > 1)
        text_add(out, "// View: 0 to %zu, around the rock.\n", s->n_cameras - 1);
    text_add(out,
             "#version 3.7;\n#declare Quality = %d; // 0 draft, 1 preview, 2 final\n"
             "global_settings {\n    assumed_gamma 1.0\n    max_trace_level 4\n    adc_bailout 0.0005\n}\n"
             "#ifndef (View) #declare View = 0; #end\n\n",
             (int)s->preset);
    add_vectors(out, "Eye", s, offsetof(struct camera, eye));
    add_vectors(out, "Ahead", s, offsetof(struct camera, ahead));
    add_vectors(out, "Right", s, offsetof(struct camera, right));
    add_vectors(out, "Down", s, offsetof(struct camera, down));
    text_add(
        out,
        "// m: the job's domain, and what a pixel covers there\n#declare Box = <%.9g, %.9g, %.9g>;\n"
        "#declare Center = Box / 2;\n#declare Span = %.9g;\n#declare Pixel = %.6g * (Quality > 0 ? 1 : 2);\n",
        s->view.size[0], s->view.size[1], s->view.size[2], s->view.span, s->view.pixel);
}

/* Sand has the bleached colour of the lowest bed; stones have the colours of all beds. */
static void add_colors(struct text *out, const struct scene *s)
{
    static const double dune[3] = {0.58, 0.42, 0.285};
    double sand[3], stone[3] = {0, 0, 0};
    float rgb[3];
    size_t n = s->job->n_strata;
    if (is_terrain(s)) {
        add_color(out, "Sand_Color", s->job, n);
        add_color(out, "Stone_Color", s->job, n + 1);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        palette_color(s->job, i, rgb);
        for (int k = 0; k < 3; k++) {
            stone[k] += 0.85 * (double)rgb[k] / (double)n;
            if (i == 0)
                sand[k] = 0.42 * (double)rgb[k] + 0.58 * dune[k];
        }
    }
    text_add(out, "#declare Sand_Color = <%.4f, %.4f, %.4f>;\n#declare Stone_Color = <%.4f, %.4f, %.4f>;\n",
             sand[0], sand[1], sand[2], stone[0], stone[1], stone[2]);
}

static status add_looks(struct text *out, const struct scene *s)
{
    status st = OK;
    const struct light light = light_of(s->job, s->frame);
    static const int lights[] = {3, 6, 20}, most_turns[] = {120, 240, 480};
    /* Rings whose triangles are a few pixels wide. */
    int turns = (int)fmin(fmax(s->camera->width / 4.0, 60), most_turns[s->preset]);
    struct ground ground = {0};
    TRY(ground_make(s->job, &s->view, s->mesh, &ground));
    daylight_begin(&light, out);
    pile_write(s->job, out);
    add_strata(out, s);
    add_colors(out, s);
    text_add(out, "#declare Mesh = %.6g; // m: its edges\n", ldexp(s->job->domain.spacing_m, -scene_cuts(s)));
    text_add(out, "// In small pictures, and without antialiasing, grain only sparkles.\n"
                  "#declare Rough = min(1, image_height / 400) * (Quality > 0 ? 1 : 0.5);\n");
    add_part(out, scene_sandstone);
    add_part(out, scene_scree);
    add_part(out, scene_rubble);
    if (is_terrain(s))
        add_part(out, scene_terrain);
    add_mesh(out, s);
    TRY(ground_write(&ground, turns, out));
    text_add(out, "#declare Walls = %d;\n", ground.walls != 0);
    add_part(out, scene_ground);
    TRY(scatter_shapes(out));
    scatter_ground(&ground, s->camera, s->n_cameras, out);
    if (!is_terrain(s)) {
        scatter_plants(s->mesh, s->mesh->value + SCENE_VEGETATION * s->mesh->n_vertices, out);
        scatter_scree(s->mesh, s->mesh->value + SCENE_DEPOSIT * s->mesh->n_vertices, s->view.pixel, out);
    }
    if (s->figure)
        scatter_figure(&ground, s->camera, out);
    daylight_write(&light, &s->view, lights[s->preset], s->preset == PRESET_FINAL, out);
done:
    ground_free(&ground);
    return st;
}

int scene_cuts(const struct scene *s)
{
    static const int most[] = {2, 3, 4};
    /* Edges of 1.5 pixels show all the detail. */
    double wanted = ceil(log2(fmax(s->job->domain.spacing_m / (1.5 * s->view.pixel), 1)));
    return is_terrain(s) || s->show != VALUE_NONE ? 0 : (int)fmin(wanted, most[s->preset]);
}

status scene_write(const struct scene *s, struct text *out)
{
    status st = OK;
    if (s->mesh->n_triangles == 0)
        return fail(E_INPUT, "frame %d: no rock is left to show", s->frame);
    add_head(out, s);
    add_part(out, scene_camera);
    if (s->show != VALUE_NONE) {
        add_part(out, scene_heat);
        add_heat_colors(out, s);
        text_add(out, "#declare Rubble = texture { pigment { rgb 0.3 } finish { Even } }\n");
        add_mesh(out, s);
    } else {
        TRY(add_looks(out, s));
    }
    text_add(out, "object { Rock }\n");
    if (!s->rocks.tile)
        return text_status(out);
    if (s->show != VALUE_NONE || is_terrain(s))
        TRY(add_rocks(out, s));
    else
        scatter_rocks(s->job, s->rocks.at, s->rocks.tile->radius, out);
    st = text_status(out);
done:
    return st;
}
