/* Triangles that occur more than once: programs that draw both sides of faces export each face twice. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "meshinput/edges.h"

/* A triangle's corners in ascending order, without the lowest. */
struct item {
    uint32_t middle, highest, triangle;
};

static int compare(const void *a, const void *b)
{
    const struct item *p = a, *q = b;
    if (p->middle != q->middle)
        return p->middle < q->middle ? -1 : 1;
    if (p->highest != q->highest)
        return p->highest < q->highest ? -1 : 1;
    return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

static void in_order(const uint32_t t[3], uint32_t out[3])
{
    memcpy(out, t, 3 * sizeof *out);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++)
            if (out[k] > out[k + 1]) {
                const uint32_t swap = out[k];
                out[k] = out[k + 1];
                out[k + 1] = swap;
            }
}

/* Sorts triangles by their lowest corner: those of v are item[begin[v] .. begin[v + 1]). */
static void list(const struct mesh *mesh, size_t *begin, struct item *item)
{
    uint32_t c[3];
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        in_order(mesh->triangle[t], c);
        begin[c[0] + 2]++;
    }
    for (size_t v = 0; v < mesh->n_vertices; v++)
        begin[v + 2] += begin[v + 1];
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        in_order(mesh->triangle[t], c);
        item[begin[c[0] + 1]++] = (struct item){c[1], c[2], (uint32_t)t};
    }
}

status mesh_drop_duplicates(struct mesh *mesh, size_t *dropped)
{
    status st = OK;
    size_t *begin = NULL, n = 0;
    struct item *item = NULL;
    unsigned char *is_duplicate = NULL;
    *dropped = 0;
    TRY(memory_alloc(mesh->n_vertices + 2, sizeof *begin, "the triangles of a mesh", &begin));
    TRY(memory_alloc(mesh->n_triangles, sizeof *item, "the triangles of a mesh", &item));
    TRY(memory_alloc(mesh->n_triangles, sizeof *is_duplicate, "the triangles of a mesh", &is_duplicate));
    list(mesh, begin, item);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        qsort(item + begin[v], begin[v + 1] - begin[v], sizeof *item, compare);
        for (size_t i = begin[v] + 1; i < begin[v + 1]; i++)
            is_duplicate[item[i].triangle] =
                item[i].middle == item[i - 1].middle && item[i].highest == item[i - 1].highest;
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        if (is_duplicate[t])
            continue;
        memmove(mesh->triangle[n++], mesh->triangle[t], sizeof *mesh->triangle);
    }
    *dropped = mesh->n_triangles - n;
    mesh->n_triangles = n;
done:
    free(begin);
    free(item);
    free(is_duplicate);
    return st;
}
