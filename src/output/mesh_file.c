#include "output/mesh_file.h"

#include <math.h>
#include <string.h>

#include "job/job.h"
#include "output/axes.h"

/* IEC 61966-2-1 */
static double srgb(float linear)
{
    double x = fmin(fmax((double)linear, 0), 1);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

void mesh_file_ply(const struct mesh_file *f, struct text *out)
{
    text_add(out,
             "ply\nformat binary_little_endian 1.0\ncomment %s\n"
             "element vertex %zu\nproperty float x\nproperty float y\nproperty float z\n"
             "property float nx\nproperty float ny\nproperty float nz\n",
             f->comment, f->n_vertices);
    if (f->velocity)
        text_add(out, "property float vx\nproperty float vy\nproperty float vz\n");
    for (size_t v = 0; v < f->n_values; v++)
        text_add(out, "property float %s\n", f->value_name[v]);
    text_add(out,
             "property int layer\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
             "element face %zu\nproperty list uchar int vertex_indices\nend_header\n",
             f->n_triangles);
    for (size_t i = 0; i < f->n_vertices; i++) {
        float place[6];
        int32_t layer = (int32_t)f->layer[i];
        uint8_t color[3];
        axes_turn(f->vertex + 3 * i, f->up, place);
        axes_turn(f->normal + 3 * i, f->up, place + 3);
        text_add_bytes(out, place, sizeof place);
        if (f->velocity) {
            const float *v = f->velocity + i;
            axes_turn((const float[3]){v[0], v[f->n_vertices], v[2 * f->n_vertices]}, f->up, place);
            text_add_bytes(out, place, 3 * sizeof *place);
        }
        for (size_t v = 0; v < f->n_values; v++)
            text_add_bytes(out, &f->value[v * f->n_vertices + i], sizeof *f->value);
        for (int c = 0; c < 3; c++)
            color[c] = (uint8_t)lround(255 * srgb(f->color[i][c]));
        text_add_bytes(out, &layer, sizeof layer);
        text_add_bytes(out, color, sizeof color);
    }
    for (size_t i = 0; i < f->n_triangles; i++) {
        text_add_bytes(out, "\3", 1);
        text_add_bytes(out, f->triangle + 3 * i, 3 * sizeof *f->triangle);
    }
}

void mesh_file_obj(const struct mesh_file *f, struct text *out)
{
    text_add(out, "# %s\no %s\n", f->comment, f->name);
    for (size_t i = 0; i < f->n_vertices; i++) {
        float at[3];
        axes_turn(f->vertex + 3 * i, f->up, at);
        text_add(out, "v %.9g %.9g %.9g %.4g %.4g %.4g\n", (double)at[0], (double)at[1], (double)at[2],
                 srgb(f->color[i][0]), srgb(f->color[i][1]), srgb(f->color[i][2]));
    }
    for (size_t i = 0; i < f->n_vertices; i++) {
        float n[3];
        axes_turn(f->normal + 3 * i, f->up, n);
        text_add(out, "vn %.4g %.4g %.4g\n", (double)n[0], (double)n[1], (double)n[2]);
    }
    for (size_t i = 0; i < f->n_triangles; i++) {
        const uint32_t *t = f->triangle + 3 * i;
        text_add(out, "f %u//%u %u//%u %u//%u\n", t[0] + 1, t[0] + 1, t[1] + 1, t[1] + 1, t[2] + 1, t[2] + 1);
    }
}
