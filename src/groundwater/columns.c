#include "groundwater/columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geology/attitude.h"
#include "shared/params.h"

/* Least distance, in spacings, over which the seepage of a face is averaged. */
static const double LOOK = 1.5;

status columns_create(const struct job *job, const int voxels[3], struct columns *c)
{
    status st = OK;
    const size_t n = (size_t)voxels[0] * (size_t)voxels[1],
                 words = ((size_t)voxels[0] + 31) / 32 * (size_t)voxels[1] * (size_t)voxels[2];
    *c = (struct columns){.job = job, .voxels = {voxels[0], voxels[1], voxels[2]}};
    TRY(contacts_create(job, voxels, &c->contacts));
    TRY(aquifer_create(voxels, job->domain.spacing_m, &c->aquifer));
    TRY(fivepoint_create(voxels, &c->solver));
    TRY(memory_alloc(words, 4, "groundwater's rock", &c->rock));
    TRY(memory_alloc(n, sizeof *c->down, "groundwater", &c->down));
    TRY(memory_alloc(n, sizeof *c->from, "groundwater", &c->from));
    TRY(memory_alloc(n, sizeof *c->flow, "groundwater", &c->flow));
    TRY(memory_alloc(n, sizeof *c->length, "groundwater", &c->length));
    TRY(memory_alloc(n * c->contacts.n_beds, sizeof *c->wet, "groundwater", &c->wet));
done:
    if (st != OK)
        columns_destroy(c);
    return st;
}

void columns_destroy(struct columns *c)
{
    contacts_destroy(&c->contacts);
    aquifer_destroy(&c->aquifer);
    fivepoint_destroy(&c->solver);
    free(c->rock);
    free(c->down);
    free(c->from);
    free(c->flow);
    free(c->length);
    free(c->wet);
    *c = (struct columns){0};
}

static bool is_rock(const struct columns *c, size_t column, int k)
{
    const size_t nx = (size_t)c->voxels[0], i = column % nx, j = column / nx, across = (nx + 31) / 32;
    if (k < 0)
        return true;
    return k < c->voxels[2] &&
           (c->rock[((size_t)k * (size_t)c->voxels[1] + j) * across + i / 32] >> i % 32 & 1) != 0;
}

/* The lowest voxel whose centre is above a height. */
static int voxel_above(const struct columns *c, double z)
{
    return (int)floor(z / c->job->domain.spacing_m + 0.5);
}

/* ---- down */

/* Percolates a column's water down to voxel k; it drips where it meets air. */
static void sink(struct columns *c, size_t column, int k)
{
    while (c->down[column] > 0 && c->from[column] > k)
        if (!is_rock(c, column, --c->from[column])) {
            c->sums.ceilings += c->down[column];
            c->down[column] = 0;
        }
}

/* Recharge of a column: none where a bed that holds water is bare, since rain runs off there. */
static void rain(struct columns *c, size_t column)
{
    const double h = c->job->domain.spacing_m;
    const size_t nx = (size_t)c->voxels[0];
    int k = c->voxels[2] - 1;
    while (k >= 0 && !is_rock(c, column, k))
        k--;
    c->from[column] = k;
    c->down[column] = 0;
    const double x[3] = {((double)(column % nx) + 0.5) * h, ((double)(column / nx) + 0.5) * h, (k + 0.5) * h};
    if (k < 0 || contacts_holds(c->job, attitude_layer(c->job, x)))
        return;
    c->down[column] = c->job->groundwater.recharge_m_per_yr * h * h;
    c->sums.recharge += c->down[column];
}

/* ---- along a bed */

/* The lowest voxel of rock on the bed within the wet zone, or -1 if there is none or the bed is missing. */
static int foot_of(const struct columns *c, const struct contact *at, size_t column)
{
    if (isnan(at->z))
        return -1;
    const int first = voxel_above(c, (double)at->z),
              last = (int)fmax(first, voxel_above(c, (double)at->z + c->job->groundwater.zone_m) - 1);
    for (int k = first; k <= last && is_rock(c, column, first - 1); k++)
        if (is_rock(c, column, k))
            return k;
    return -1;
}

static double top_of(const struct columns *c, const struct contact *at, size_t column, int foot)
{
    int k = foot;
    while (is_rock(c, column, k))
        k++;
    return fmin(k * c->job->domain.spacing_m, (double)at->lid);
}

static enum aquifer_face side_of(const struct columns *c, int d)
{
    static const unsigned wall[NEIGHBOURS] = {WALL_X_MIN, WALL_X_MAX, WALL_Y_MIN, WALL_Y_MAX};
    return job_walls(c->job) & wall[d] ? FACE_CLOSED : FACE_SIDE;
}

/* Kind and sill of the face towards d of a column with water on the bed. */
static enum aquifer_face face_of(const struct columns *c, const struct contact *at, size_t column, int d,
                                 double *sill)
{
    const struct aquifer *a = &c->aquifer;
    const ptrdiff_t beside = fivepoint_beside(a->n, column, d);
    const double base = a->base[column], top = base + a->room[column];
    *sill = base;
    if (beside < 0)
        return side_of(c, d);
    const size_t o = (size_t)beside;
    const int level = voxel_above(c, base);
    if (a->conductivity[o] > 0) {
        if (a->base[o] > base)
            return top > a->base[o] ? FACE_JOINED : FACE_CLOSED;
        if (a->base[o] + a->room[o] > base)
            return FACE_JOINED;
    } else if ((double)at[o].z > base) { /* a bare ledge above the bed */
        *sill = (double)at[o].z;
        return top > *sill ? FACE_OPEN : FACE_CLOSED;
    } else if (!isnan(at[o].z)) {
        return FACE_OPEN;
    }
    return is_rock(c, o, level) ? FACE_DEEP : FACE_OPEN;
}

/* Fills the aquifer's input for a bed: columns with rock on it, and their recharge. */
static void lay(struct columns *c, const struct contact *at)
{
    struct aquifer *a = &c->aquifer;
    const double h = c->job->domain.spacing_m;
    for (size_t i = 0; i < c->contacts.n_columns; i++) {
        const int foot = foot_of(c, &at[i], i);
        a->conductivity[i] = a->recharge[i] = 0;
        if (!isnan(at[i].z))
            sink(c, i, foot >= 0 ? foot : voxel_above(c, (double)at[i].z));
        if (foot < 0)
            continue;
        a->base[i] = (double)at[i].z;
        a->room[i] = fmax(top_of(c, &at[i], i, foot) - a->base[i], h / 2);
        a->conductivity[i] = contacts_conductivity(c->job, at[i].above);
        if (c->from[i] >= foot) {
            a->recharge[i] = c->down[i];
            c->down[i] = 0;
        }
    }
    for (size_t i = 0; i < c->contacts.n_columns; i++)
        for (int d = 0; d < NEIGHBOURS; d++)
            a->face[d][i] =
                a->conductivity[i] > 0 ? (uint8_t)face_of(c, at, i, d, &a->sill[d][i]) : FACE_CLOSED;
}

/* ---- out */

static bool is_open(enum aquifer_face face)
{
    return face == FACE_OPEN || face == FACE_SIDE;
}

/* Length of the front through a column, m, from the direction towards the columns around it that have no rock on the bed. */
static double front_in(const struct columns *c, size_t column, int look)
{
    const struct aquifer *a = &c->aquifer;
    const int nx = a->n[0], ny = a->n[1], ci = (int)(column % (size_t)nx), cj = (int)(column / (size_t)nx);
    double out[2] = {0, 0}, length = 0;
    for (int j = -look; j <= look; j++)
        for (int i = -look; i <= look; i++) {
            const int x = ci + i, y = cj + j;
            if ((i == 0 && j == 0) || i * i + j * j > look * look)
                continue;
            const int wx = x < 0 && side_of(c, WEST) == FACE_CLOSED     ? -1 - x
                           : x >= nx && side_of(c, EAST) == FACE_CLOSED ? 2 * nx - 1 - x
                                                                        : x,
                      wy = y < 0 && side_of(c, SOUTH) == FACE_CLOSED     ? -1 - y
                           : y >= ny && side_of(c, NORTH) == FACE_CLOSED ? 2 * ny - 1 - y
                                                                         : y;
            const bool rock = wx >= 0 && wx < nx && wy >= 0 && wy < ny &&
                              a->conductivity[(size_t)wy * (size_t)nx + (size_t)wx] > 0;
            out[0] += rock ? 0 : i / hypot(i, j);
            out[1] += rock ? 0 : j / hypot(i, j);
        }
    const double size = hypot(out[0], out[1]);
    for (int d = 0; d < NEIGHBOURS; d++)
        if (is_open(a->face[d][column]))
            length += a->dx * (size > 1e-9 ? fabs(out[d / 2]) / size : 1);
    return length;
}

/* Seepage per metre of front, averaged over the front near by: water and weathering spread along a face, and corners of voxels must
 * not get more. */
static void spread(const struct columns *c, struct wet *wet, int look)
{
    const struct aquifer *a = &c->aquifer;
    const int nx = a->n[0], ny = a->n[1];
    for (int cj = 0; cj < ny; cj++)
        for (int ci = 0; ci < nx; ci++) {
            double flow = 0, length = 0;
            if (c->flow[cj * nx + ci] <= 0)
                continue;
            for (int j = cj - look; j <= cj + look; j++)
                for (int i = ci - look; i <= ci + look; i++)
                    if (i >= 0 && i < nx && j >= 0 && j < ny &&
                        (i - ci) * (i - ci) + (j - cj) * (j - cj) <= look * look) {
                        flow += c->flow[j * nx + i];
                        length += c->length[j * nx + i];
                    }
            wet[cj * nx + ci].front = (float)(c->length[cj * nx + ci] / a->dx);
            wet[cj * nx + ci].face = length > 0 ? (float)(flow / length / c->job->groundwater.zone_m) : 0;
        }
}

/* Adds a bed to the sums and fills its `wet`. */
static void drain(struct columns *c, const struct contact *at, struct wet *wet)
{
    const struct aquifer *a = &c->aquifer;
    const double area = a->dx * a->dx;
    const int look = (int)fmax(1, floor(fmax(c->job->groundwater.zone_m / a->dx, LOOK)));
    for (size_t i = 0; i < c->contacts.n_columns; i++) {
        c->flow[i] = c->length[i] = 0;
        wet[i] = (struct wet){0};
        if (a->conductivity[i] == 0)
            continue;
        wet[i].base = (float)a->base[i];
        wet[i].top = (float)(a->base[i] + a->room[i]);
        wet[i].over = wet[i].top < at[i].lid ? (float)(a->over[i] / area) : 0;
        c->sums.tops += a->over[i];
        for (int d = 0; d < NEIGHBOURS; d++) {
            const enum aquifer_face face = a->face[d][i];
            if (face == FACE_CLOSED || face == FACE_JOINED)
                continue;
            const double out = aquifer_flow(a, i, d);
            const ptrdiff_t o = fivepoint_beside(a->n, i, d);
            if (face == FACE_DEEP && isnan(at[o].z)) {
                const int level = voxel_above(c, a->base[i]);
                sink(c, (size_t)o, level);
                c->from[o] = c->from[o] < level ? c->from[o] : level;
                c->down[o] += out;
            } else if (face == FACE_DEEP) {
                c->sums.deep += out;
            } else {
                c->flow[i] += out;
                *(face == FACE_SIDE ? &c->sums.sides : &c->sums.faces) += out;
            }
        }
    }
    for (size_t i = 0; i < c->contacts.n_columns; i++)
        if (c->flow[i] > 0)
            c->length[i] = front_in(c, i, look);
    spread(c, wet, look);
}

void columns_find(struct columns *c)
{
    const struct contacts *all = &c->contacts;
    const int most = 100 + 8 * (c->voxels[0] + c->voxels[1]);
    c->sums = (struct groundwater_sums){0};
    for (size_t i = 0; i < all->n_columns; i++)
        rain(c, i);
    for (size_t b = 0; b < all->n_beds; b++) {
        const struct contact *at = &all->at[b * all->n_columns];
        lay(c, at);
        aquifer_solve(&c->aquifer, c->solver, most);
        c->sums.left = fmax(c->sums.left, c->aquifer.left);
        c->sums.rounds = c->aquifer.rounds > c->sums.rounds ? c->aquifer.rounds : c->sums.rounds;
        drain(c, at, &c->wet[b * all->n_columns]);
    }
    for (size_t i = 0; i < all->n_columns; i++) {
        sink(c, i, -1);
        c->sums.deep += c->down[i];
    }
}
