#include "slope_ref.h"

#include <math.h>

#include "shared/params.h"

struct world {
    const uint8_t *solid;
    const int *n;
};

/* The sides go on as they are; there is rock below and none above. */
static int solid_at(const struct world *w, int x, int y, int z)
{
    x = x < 0 ? 0 : x >= w->n[0] ? w->n[0] - 1 : x;
    y = y < 0 ? 0 : y >= w->n[1] ? w->n[1] - 1 : y;
    if (z < 0 || z >= w->n[2])
        return z < 0;
    return w->solid[(z * w->n[1] + y) * w->n[0] + x];
}

static int floor_near(const struct world *w, int x, int y, int top)
{
    int z = top;
    if (solid_at(w, x, y, z)) {
        while (z - top < 16 && solid_at(w, x, y, z))
            z++;
    } else {
        while (top - z < 16 && !solid_at(w, x, y, z - 1))
            z--;
    }
    /* Nothing within sixteen voxels below */
    return z - top < -15 ? -16 : z - top;
}

static double mean(const struct world *w, int x, int y, int nx, int ny, int top)
{
    double sum = 0;
    for (int j = 0; j < ny; j++)
        for (int i = 0; i < nx; i++)
            sum += floor_near(w, x + i, y + j, top);
    return sum / (nx * ny);
}

/* The slope between two sides, and the drop to the lower one. */
static double axis(double a, double b, double repose, double *tip)
{
    double down = fmax(a, b), up = -fmin(a, b);
    *tip = down;
    return up > 2 * repose + 0.5 ? fmax(down, 0) : (down + up) / 2;
}

unsigned slope_ref_room(const uint8_t *solid, const int voxels[3], const struct routing_ref *way, size_t c,
                        double repose_deg, unsigned most)
{
    const struct world w = {solid, voxels};
    const double repose = tan(repose_deg * 3.14159265358979323846 / 180), arm = 2.5;
    size_t row = (size_t)way->cells[0], slab = row * (size_t)way->cells[1];
    int base[3] = {2 * (int)(c % row) - way->shift[0],
                   2 * (int)(c / row % (size_t)way->cells[1]) - way->shift[1],
                   2 * (int)(c / slab) - way->shift[2]};
    if ((way->tag[c] & (WATER_KIND | WATER_OUT)) != WATER_SURF)
        return 0;

    int top = -1000, high = base[2] + 3 < voxels[2] - 1 ? base[2] + 3 : voxels[2] - 1;
    int low = c >= slab && (way->tag[c - slab] & WATER_KIND) != WATER_EMPTY ? base[2] - 2 : base[2];
    unsigned room = 0, free = 0;
    for (int q = 0; q < 4; q++) {
        int x = base[0] + (q & 1), y = base[1] + (q >> 1), z = base[2] + 4;
        while (z > base[2] - 28 && !solid_at(&w, x, y, z - 1))
            z--;
        top = z > top ? z : top;
        if (x >= 0 && x < voxels[0] && y >= 0 && y < voxels[1] && z >= low && z >= 0 && z <= high)
            free += (unsigned)(high - z + 1);
    }
    most = free < most ? free : most;

    double own = mean(&w, base[0], base[1], 2, 2, top), tip_x, tip_y;
    double x = axis((own - mean(&w, base[0] + 2, base[1] - 1, 3, 4, top)) / arm,
                    (own - mean(&w, base[0] - 3, base[1] - 1, 3, 4, top)) / arm, repose, &tip_x);
    double y = axis((own - mean(&w, base[0] - 1, base[1] + 2, 4, 3, top)) / arm,
                    (own - mean(&w, base[0] - 1, base[1] - 3, 4, 3, top)) / arm, repose, &tip_y);
    while (room < most && hypot(x, y) <= repose &&
           hypot(fmax(tip_x + (room + 0.5) * 0.25 / arm, 0), fmax(tip_y + (room + 0.5) * 0.25 / arm, 0)) <=
               1.15 * repose)
        room++;
    int hollow = own <= mean(&w, base[0] + 2, base[1], 2, 2, top) &&
                 own <= mean(&w, base[0] - 2, base[1], 2, 2, top) &&
                 own <= mean(&w, base[0], base[1] + 2, 2, 2, top) &&
                 own <= mean(&w, base[0], base[1] - 2, 2, 2, top);
    return room == 0 && most > 0 && hollow ? 1 : room;
}
