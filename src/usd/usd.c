#include "usd/usd.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "base/version.h"
#include "usd/text.h"

/* ---- tokens */

enum { IDENTIFIER = 80 };

/* Makes a valid prim name: letters, digits and _, not beginning with a digit. */
static void identifier(const char *name, char out[IDENTIFIER])
{
    size_t n = 0;
    if (*name >= '0' && *name <= '9')
        out[n++] = '_';
    for (; *name && n + 1 < IDENTIFIER; name++) {
        const bool letter = (*name >= 'a' && *name <= 'z') || (*name >= 'A' && *name <= 'Z');
        out[n++] = letter || (*name >= '0' && *name <= '9') ? *name : '_';
    }
    if (n == 0)
        out[n++] = '_';
    out[n] = '\0';
}

/* Adds a quoted string, with escapes. */
static void add_quoted(struct text *t, const char *value)
{
    text_add(t, "\"");
    for (; *value; value++)
        if (*value == '"' || *value == '\\')
            text_add(t, "\\%c", *value);
        else if ((unsigned char)*value >= 0x20 && *value != 0x7f)
            text_add(t, "%c", *value);
        else
            text_add(t, " ");
    text_add(t, "\"");
}

void usd_add_number(struct text *t, double value)
{
    char number[32];
    if (value == floor(value) && fabs(value) < 1e15)
        text_add(t, "%.0f", value + 0.0); /* no negative zero */
    else
        text_add(t, "%s", number_text(value, number));
}

void usd_add_vector(struct text *t, const double *v, int n)
{
    text_add(t, "(");
    for (int i = 0; i < n; i++) {
        text_add(t, i ? ", " : "");
        usd_add_number(t, v[i]);
    }
    text_add(t, ")");
}

/* Adds the path of a file, named as by folder_name(). */
static void add_path(struct text *t, const struct usd_sequence *s, const char *folder, int frame,
                     const char *extension)
{
    char number[FRAME_TEXT];
    text_add(t, "@./%s/%s.%s.%s@", folder, s->name, frame_text(frame, number), extension);
}

/* ---- the parts of the stage; `root` is the name of its top prim */

static void add_field(struct text *t, const struct usd_sequence *s, const struct usd_field *f)
{
    static const char *const classes[] = {
        [GRID_LEVEL_SET] = "levelSet", [GRID_FOG] = "fogVolume", [GRID_PLAIN] = "unknown"};
    char name[IDENTIFIER];
    identifier(f->name, name);
    text_add(t,
             "\n        def OpenVDBAsset \"%s\"\n        {\n            token fieldClass = \"%s\"\n"
             "            token fieldDataType = \"%s\"\n            token fieldName = ",
             name, classes[f->kind], f->vector ? "float3" : "float");
    add_quoted(t, f->name);
    text_add(t, "\n");
    if (f->vector)
        text_add(t, "            token vectorDataRoleHint = \"Vector\"\n");
    text_add(t, "            asset filePath.timeSamples = {\n");
    for (size_t i = 0; i < s->n_volumes; i++) {
        text_add(t, "                %d: ", s->volumes_frame[i]);
        add_path(t, s, "volumes", s->volumes_frame[i], "vdb");
        text_add(t, ",\n");
    }
    text_add(t, "            }\n        }\n");
}

static void add_volume(struct text *t, const struct usd_sequence *s, const char *root)
{
    char name[IDENTIFIER];
    text_add(t, "\n    def Volume \"rock\"\n    {\n        float3[] extent = [");
    usd_add_vector(t, s->low, 3);
    text_add(t, ", ");
    usd_add_vector(t, s->high, 3);
    text_add(t, "]\n");
    if (s->n_meshes)
        text_add(t, "        token visibility = \"invisible\"\n");
    for (size_t i = 0; i < s->n_fields; i++) {
        identifier(s->field[i].name, name);
        text_add(t, "        rel field:%s = </%s/rock/%s>\n", name, root, name);
    }
    for (size_t i = 0; i < s->n_fields; i++)
        add_field(t, s, &s->field[i]);
    text_add(t, "    }\n");
}

/* Declares the attributes for which clips have values; without declarations USD ignores them. */
static void add_declarations(struct text *t, const struct usd_prim *prim, const char *indent)
{
    for (size_t i = 0; i < prim->n; i++) {
        const struct usd_attribute *a = &prim->attribute[i];
        text_add(t, "%s%s %s%s%s%s\n", indent, a->type, a->name,
                 *a->interpolation ? " (interpolation = \"" : "", a->interpolation,
                 *a->interpolation ? "\")" : "");
    }
}

/* Begins a prim whose values are clips, one file per frame. Its braces are left open. */
static void begin_clips(struct text *t, const struct usd_sequence *s, const struct usd_prim *prim,
                        const int *frame, size_t n, const char *schemas)
{
    text_add(t,
             "\n    def %s \"%s\" (\n%s        clips = {\n            dictionary default = {\n"
             "                double2[] active = [",
             prim->type, prim->name, schemas);
    for (size_t i = 0; i < n; i++)
        text_add(t, "%s(%d, %zu)", i ? ", " : "", frame[i], i);
    text_add(t, "]\n                asset[] assetPaths = [");
    for (size_t i = 0; i < n; i++) {
        text_add(t, "%s\n                    ", i ? "," : "");
        add_path(t, s, prim->folder, frame[i], "usdc");
    }
    text_add(t,
             "\n                ]\n                asset manifestAssetPath = @./%s/%s.clips.usda@\n"
             "                string primPath = \"/%s\"\n                double2[] times = [",
             prim->folder, s->name, prim->name);
    for (size_t i = 0; i < n; i++)
        text_add(t, "%s(%d, %d)", i ? ", " : "", frame[i], frame[i]);
    text_add(t, "]\n            }\n        }\n    )\n    {\n");
    add_declarations(t, prim, "        ");
}

/* Meshes are rendered without subdivision. */
static void add_meshes(struct text *t, const struct usd_sequence *s, const char *root)
{
    begin_clips(t, s, &s->mesh, s->meshes_frame, s->n_meshes,
                "        prepend apiSchemas = [\"MaterialBindingAPI\"]\n");
    text_add(
        t,
        "        rel material:binding = </%s/looks/sandstone>\n        uniform token orientation = \"rightHanded\"\n        uniform token subdivisionScheme = \"none\"\n    }\n",
        root);
}

/* The material, which has the colours of the strata. */
static void add_looks(struct text *t, const char *root)
{
    text_add(
        t,
        "\n    def Scope \"looks\"\n    {\n        def Material \"sandstone\"\n        {\n"
        "            token outputs:surface.connect = </%s/looks/sandstone/surface.outputs:surface>\n\n"
        "            def Shader \"color\"\n            {\n"
        "                uniform token info:id = \"UsdPrimvarReader_float3\"\n"
        "                float3 inputs:fallback = (0.5, 0.5, 0.5)\n"
        "                string inputs:varname = \"displayColor\"\n"
        "                float3 outputs:result\n            }\n\n"
        "            def Shader \"surface\"\n            {\n"
        "                uniform token info:id = \"UsdPreviewSurface\"\n"
        "                color3f inputs:diffuseColor.connect = </%s/looks/sandstone/color.outputs:result>\n"
        "                float inputs:roughness = 0.9\n                float inputs:specular = 0.1\n"
        "                token outputs:surface\n            }\n        }\n    }\n",
        root, root);
}

static void add_points(struct text *t, const struct usd_sequence *s)
{
    begin_clips(t, s, usd_points_prim(s->moves), s->points_frame, s->n_points, "");
    if (s->n_meshes)
        text_add(t, "        uniform token purpose = \"proxy\"\n");
    text_add(t, "    }\n");
}

/* Prototypes below an instancer are rendered only where it instances them. */
static void add_rocks(struct text *t, const struct usd_sequence *s, const char *root)
{
    begin_clips(t, s, &usd_rocks_prim, s->rocks_frame, s->n_rocks, "");
    text_add(t, "        rel prototypes = [");
    for (size_t i = 0; i < s->n_shapes; i++)
        text_add(t, "%s</%s/rocks/prototypes/rock_%zu>", i ? ", " : "", root, i);
    text_add(
        t,
        "]\n\n        def Scope \"prototypes\" (\n            prepend references = @./rocks/%s.shapes.usda@\n"
        "        )\n        {\n        }\n    }\n",
        s->name);
}

void usd_add_matrix(struct text *t, const double m[16])
{
    text_add(t, "( ");
    for (int row = 0; row < 4; row++) {
        text_add(t, row ? ", " : "");
        usd_add_vector(t, m + 4 * row, 4);
    }
    text_add(t, " )");
}

static bool moves(const struct usd_camera *c)
{
    bool moving = false;
    for (size_t i = 1; i < c->n_keys; i++)
        moving |= memcmp(c->key[i].to_world, c->key[0].to_world, sizeof c->key[0].to_world) != 0;
    return moving;
}

static bool zooms(const struct usd_camera *c)
{
    bool zooming = false;
    for (size_t i = 1; i < c->n_keys; i++)
        zooming |= c->key[i].focal_mm != c->key[0].focal_mm;
    return zooming;
}

/* USD measures film in tenths of the unit, here a metre. */
static double film(double mm)
{
    return mm / 100;
}

static void add_camera(struct text *t, const struct usd_camera *c, const char *name)
{
    text_add(t,
             "\n        def Camera \"%s\"\n        {\n            float2 clippingRange = (0.1, 100000)\n"
             "            float focalLength",
             name);
    if (zooms(c)) {
        text_add(t, ".timeSamples = {\n");
        for (size_t i = 0; i < c->n_keys; i++) {
            text_add(t, "                %d: ", c->key[i].frame);
            usd_add_number(t, film(c->key[i].focal_mm));
            text_add(t, ",\n");
        }
        text_add(t, "            }\n");
    } else {
        text_add(t, " = ");
        usd_add_number(t, film(c->key[0].focal_mm));
        text_add(t, "\n");
    }
    text_add(t, "            float horizontalAperture = ");
    usd_add_number(t, film(c->width_mm));
    text_add(t, "\n            token projection = \"perspective\"\n            float verticalAperture = ");
    usd_add_number(t, film(c->height_mm));
    text_add(t, "\n            matrix4d xformOp:transform");
    if (moves(c)) {
        text_add(t, ".timeSamples = {\n");
        for (size_t i = 0; i < c->n_keys; i++) {
            text_add(t, "                %d: ", c->key[i].frame);
            usd_add_matrix(t, c->key[i].to_world);
            text_add(t, ",\n");
        }
        text_add(t, "            }\n");
    } else {
        text_add(t, " = ");
        usd_add_matrix(t, c->key[0].to_world);
        text_add(t, "\n");
    }
    text_add(t, "            uniform token[] xformOpOrder = [\"xformOp:transform\"]\n        }\n");
}

/* Two cameras may get the same prim name; then the later one is numbered. */
static void add_cameras(struct text *t, const struct usd_sequence *s)
{
    text_add(t, "\n    def Scope \"cameras\"\n    {");
    for (size_t i = 0; i < s->n_cameras; i++) {
        char name[IDENTIFIER], other[IDENTIFIER], numbered[IDENTIFIER + 24];
        size_t same = 0;
        identifier(s->camera[i].name, name);
        for (size_t j = 0; j < i; j++) {
            identifier(s->camera[j].name, other);
            same += strcmp(name, other) == 0;
        }
        snprintf(numbered, sizeof numbered, same ? "%s__%zu" : "%s", name, same + 1);
        add_camera(t, &s->camera[i], numbered);
    }
    text_add(t, "    }\n");
}

static void add_head(struct text *t, const struct usd_sequence *s, const char *root)
{
    text_add(t, "#usda 1.0\n(\n    defaultPrim = \"%s\"\n    doc = ", root);
    char doc[160];
    snprintf(doc, sizeof doc, "hoodoo %s: %.100s", hoodoo_version, s->name);
    add_quoted(t, doc);
    text_add(t, "\n    endTimeCode = %d\n    framesPerSecond = ", s->last);
    usd_add_number(t, s->fps);
    text_add(t, "\n    metersPerUnit = 1\n    startTimeCode = %d\n    timeCodesPerSecond = ", s->first);
    usd_add_number(t, s->fps);
    text_add(t, "\n    upAxis = \"%s\"\n)\n", s->up == OUTPUT_UP_Y ? "Y" : "Z");
}

void usd_stage(const struct usd_sequence *s, struct text *t)
{
    char root[IDENTIFIER];
    identifier(s->name, root);
    add_head(t, s, root);
    text_add(t, "\ndef Xform \"%s\" (\n    kind = \"component\"\n)\n{", root);
    if (s->n_volumes && s->n_fields)
        add_volume(t, s, root);
    if (s->n_meshes)
        add_meshes(t, s, root);
    if (s->n_points)
        add_points(t, s);
    if (s->n_rocks)
        add_rocks(t, s, root);
    if (s->n_cameras)
        add_cameras(t, s);
    if (s->n_lights)
        usd_lights(s, t);
    if (s->n_meshes)
        add_looks(t, root);
    text_add(t, "}\n");
}

void usd_clips(const struct usd_sequence *s, const struct usd_prim *prim, struct text *t)
{
    add_head(t, s, prim->name);
    text_add(t, "\ndef %s \"%s\"\n{\n", prim->type, prim->name);
    add_declarations(t, prim, "    ");
    text_add(t, "}\n");
}
