#include "shape/placement.h"

#include <math.h>
#include <string.h>

struct placement placement_identity(void)
{
    return (struct placement){
        .world_from_local = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
        .local_from_world = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
        .min_scale = 1,
    };
}

void placement_apply(const double m[3][4], const double x[3], double out[3])
{
    for (int r = 0; r < 3; r++)
        out[r] = m[r][0] * x[0] + m[r][1] * x[1] + m[r][2] * x[2] + m[r][3];
}

static void multiply(double a[3][4], double b[3][4], double out[3][4])
{
    double m[3][4];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++)
            m[r][c] = a[r][0] * b[0][c] + a[r][1] * b[1][c] + a[r][2] * b[2][c] + (c == 3 ? a[r][3] : 0);
    memcpy(out, m, sizeof m);
}

/* The rotation about x, then y, then z. */
static void rotation(const double degrees[3], double r[3][3])
{
    double s[3], c[3];
    for (int a = 0; a < 3; a++) {
        s[a] = sin(degrees[a] * (M_PI / 180));
        c[a] = cos(degrees[a] * (M_PI / 180));
    }
    const double m[3][3] = {
        {c[2] * c[1], c[2] * s[1] * s[0] - s[2] * c[0], c[2] * s[1] * c[0] + s[2] * s[0]},
        {s[2] * c[1], s[2] * s[1] * s[0] + c[2] * c[0], s[2] * s[1] * c[0] - c[2] * s[0]},
        {-s[1], c[1] * s[0], c[1] * c[0]},
    };
    memcpy(r, m, sizeof m);
}

/* Each kind of node has the same four keys (PLACE in job/keys.def), in a struct of its own. */
struct keys {
    const double *scale, *rotate_deg, *translate_m;
    bool inert;
};

#define KEYS(member)                                                                                         \
    (struct keys)                                                                                            \
    {                                                                                                        \
        member.scale, member.rotate_deg, member.translate_m, member.inert                                    \
    }

static struct keys keys_of(const struct job_node *node)
{
    if (node->kind != NODE_SHAPE)
        return KEYS(node->u.group);
    switch (node->shape) {
    case SHAPE_SPHERE:
        return KEYS(node->u.sphere);
    case SHAPE_CYLINDER:
        return KEYS(node->u.cylinder);
    case SHAPE_PLANE:
        return KEYS(node->u.plane);
    case SHAPE_MESH:
        return KEYS(node->u.mesh);
    case SHAPE_HEIGHTFIELD:
        return KEYS(node->u.heightfield);
    case SHAPE_JOINTMAP:
        return KEYS(node->u.jointmap);
    case SHAPE_STROKE:
        return KEYS(node->u.stroke);
    case SHAPE_STACKS:
        return KEYS(node->u.stacks);
    case SHAPE_VOXELS:
        return KEYS(node->u.voxels);
    case SHAPE_VOLUME:
        return KEYS(node->u.volume);
    case SHAPE_FUNCTION:
        return KEYS(node->u.function);
    case SHAPE_BOX:
        break;
    }
    return KEYS(node->u.box);
}

struct placement placement_transform(const struct placement *parent, const double scale[3],
                                     const double rotate_deg[3], const double translate_m[3])
{
    struct placement above = *parent, p = {.inert = parent->inert};
    double rotated[3][3], forward[3][4], back[3][4];
    rotation(rotate_deg, rotated);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            forward[r][c] = rotated[r][c] * scale[c];
            back[r][c] = rotated[c][r] / scale[r];
        }
        forward[r][3] = translate_m[r];
    }
    for (int r = 0; r < 3; r++)
        back[r][3] = -(back[r][0] * forward[0][3] + back[r][1] * forward[1][3] + back[r][2] * forward[2][3]);
    multiply(above.world_from_local, forward, p.world_from_local);
    multiply(back, above.local_from_world, p.local_from_world);
    p.min_scale = parent->min_scale * fmin(scale[0], fmin(scale[1], scale[2]));
    return p;
}

struct placement placement_child(const struct placement *parent, const struct job_node *node)
{
    const struct keys k = keys_of(node);
    struct placement p = placement_transform(parent, k.scale, k.rotate_deg, k.translate_m);
    p.inert |= k.inert;
    return p;
}

/* Extends min..max by the box lo..hi transformed by m. */
static void extend(const double m[3][4], const double lo[3], const double hi[3], double min[3], double max[3])
{
    for (int corner = 0; corner < 8; corner++) {
        double x[3], seen[3];
        for (int a = 0; a < 3; a++)
            x[a] = corner >> a & 1 ? hi[a] : lo[a];
        placement_apply(m, x, seen);
        for (int a = 0; a < 3; a++) {
            min[a] = fmin(min[a], seen[a]);
            max[a] = fmax(max[a], seen[a]);
        }
    }
}

void placement_box(const struct placement *place, const double lo[3], const double hi[3], double min[3],
                   double max[3])
{
    extend(place->world_from_local, lo, hi, min, max);
}

void placement_box_local(const struct placement *place, const double min[3], const double max[3],
                         double lo[3], double hi[3])
{
    extend(place->local_from_world, min, max, lo, hi);
}

double placement_volume_scale(const struct placement *place)
{
    const double(*m)[4] = place->world_from_local;
    return fabs(m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]));
}
