/* CSG: union, intersection and difference of shapes. Transforms are composed down to the shapes when the tree is made, so that operators
 * only compare distances in world space. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "scene/scene.h"
#include "shape/shape.h"

struct solid {
    enum job_node_kind kind;
    double min[3], max[3]; /* m, bounding box */
    size_t n_child;
    struct solid **child;
    struct shape shape; /* NODE_SHAPE only */
};

static void bound(struct solid *s)
{
    for (int a = 0; a < 3; a++) {
        const struct solid *first = s->n_child ? s->child[0] : NULL;
        s->min[a] = first ? first->min[a] : s->shape.min[a];
        s->max[a] = first ? first->max[a] : s->shape.max[a];
        for (size_t i = 1; i < s->n_child; i++) {
            const struct solid *c = s->child[i];
            if (s->kind == NODE_UNION) {
                s->min[a] = fmin(s->min[a], c->min[a]);
                s->max[a] = fmax(s->max[a], c->max[a]);
            } else if (s->kind == NODE_INTERSECTION) {
                s->min[a] = fmax(s->min[a], c->min[a]);
                s->max[a] = fmin(s->max[a], c->max[a]);
            }
        }
    }
}

static status create(const struct job_node *node, const struct placement *parent, double detail, double reach,
                     struct solid **out)
{
    status st = OK;
    struct solid *s = NULL;
    struct placement place = placement_child(parent, node);
    TRY(memory_alloc(1, sizeof *s, "a solid", &s));
    s->kind = node->kind;
    if (node->kind == NODE_SHAPE) {
        TRY(shape_init(&s->shape, node, &place, detail, reach));
    } else {
        if (node->n_child == 0) {
            st = fail(E_USAGE, "scene: an operator has no shapes: list at least one below it");
            goto done;
        }
        TRY(memory_alloc(node->n_child, sizeof *s->child, "a solid", &s->child));
        for (; s->n_child < node->n_child; s->n_child++)
            TRY(create(node->child[s->n_child], &place, detail, reach, &s->child[s->n_child]));
    }
    bound(s);
    *out = s;
    s = NULL;
done:
    solid_destroy(&s);
    return st;
}

status solid_create(const struct job_node *node, double detail, double reach, struct solid **out)
{
    struct placement world = placement_identity();
    if (!node)
        return fail(
            E_USAGE,
            "scene: there is no shape: add a box, sphere, cylinder, plane, mesh, volume, heightfield, function or jointmap");
    return create(node, &world, detail, reach, out);
}

void solid_destroy(struct solid **solid)
{
    struct solid *s = *solid;
    if (!s)
        return;
    for (size_t i = 0; i < s->n_child; i++)
        solid_destroy(&s->child[i]);
    free(s->child);
    if (s->kind == NODE_SHAPE)
        shape_deinit(&s->shape);
    free(s);
    *solid = NULL;
}

double solid_file_m3(const struct solid *solid)
{
    return solid->kind == NODE_SHAPE ? solid->shape.file_m3 : (double)NAN;
}

const struct solid *solid_child(const struct solid *solid, size_t i)
{
    return solid->child[i];
}

void solid_bounds(const struct solid *solid, double min[3], double max[3])
{
    for (int a = 0; a < 3; a++) {
        min[a] = solid->min[a];
        max[a] = solid->max[a];
    }
}

/* Is x farther than `distance` from the bounding box of s? */
static int beyond(const struct solid *s, const double x[3], double distance)
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        double d = fmax(s->min[a] - x[a], x[a] - s->max[a]);
        square += d > 0 ? d * d : 0;
    }
    return square > distance * distance;
}

/* The surfaces of meshes and stacks are interpolated in single precision and may reach slightly beyond their extents. */
static enum solid_share shape_in_box(const struct solid *s, const double min[3], const double max[3])
{
    if (s->shape.kind == SHAPE_MESH || s->shape.kind == SHAPE_VOLUME || s->shape.kind == SHAPE_STACKS)
        return SOLID_SOME;
    for (int a = 0; a < 3; a++)
        if (min[a] >= s->max[a] || max[a] <= s->min[a])
            return SOLID_NONE;
    return shape_holds_box(&s->shape, min, max) ? SOLID_ALL : SOLID_SOME;
}

/* A child that fills the box decides a union; a child that leaves it empty decides an intersection or difference. The operands that a
 * difference subtracts count inverted. */
enum solid_share solid_in_box(const struct solid *s, const double min[3], const double max[3])
{
    if (s->kind == NODE_SHAPE)
        return shape_in_box(s, min, max);
    const enum solid_share settles = s->kind == NODE_UNION ? SOLID_ALL : SOLID_NONE;
    enum solid_share share = s->kind == NODE_UNION ? SOLID_NONE : SOLID_ALL;
    for (size_t i = 0; i < s->n_child; i++) {
        enum solid_share c = solid_in_box(s->child[i], min, max);
        if (s->kind == NODE_DIFFERENCE && i > 0 && c != SOLID_SOME)
            c = c == SOLID_ALL ? SOLID_NONE : SOLID_ALL;
        if (c == settles)
            return settles;
        if (c == SOLID_SOME)
            share = SOLID_SOME;
    }
    return share;
}

static struct solid_point at_union(const struct solid *s, const double x[3])
{
    struct solid_point p = solid_at(s->child[0], x);
    for (size_t i = 1; i < s->n_child; i++) {
        /* If x is inside already, only parts that contain it matter; if outside, only nearer ones. */
        if (beyond(s->child[i], x, fmax(p.distance, 0)))
            continue;
        struct solid_point c = solid_at(s->child[i], x);
        if (c.distance <= 0 && p.distance <= 0) {
            p.inert |= c.inert;
            p.loose &= c.loose; /* rock wins over loose material */
        } else if (c.distance < p.distance) {
            p.inert = c.inert;
            p.loose = c.loose;
        }
        p.distance = fmin(p.distance, c.distance);
    }
    return p;
}

struct solid_point solid_at(const struct solid *s, const double x[3])
{
    if (s->kind == NODE_SHAPE)
        return (struct solid_point){shape_distance(&s->shape, x), s->shape.place.inert,
                                    shape_loose(&s->shape, x)};
    if (s->kind == NODE_UNION)
        return at_union(s, x);
    struct solid_point p = solid_at(s->child[0], x);
    for (size_t i = 1; i < s->n_child; i++) {
        struct solid_point c = solid_at(s->child[i], x);
        if (s->kind == NODE_INTERSECTION) {
            p.distance = fmax(p.distance, c.distance);
            p.inert |= c.inert;
        } else {
            /* The surface of the subtracted operand belongs to that operand: 0 counts as inside there, too. */
            p.distance = fmax(p.distance, c.distance == 0 ? DBL_MIN : -c.distance);
        }
    }
    return p;
}
