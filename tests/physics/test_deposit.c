/* Deposits: cones at the angle of repose, round, without steps; every crumb accounted for. */
#include "heap.h"

#include <stdio.h>

static const double pi = 3.14159265358979323846;

/* Slope of the heights of columns within 10 degrees of an azimuth and a rotation of it by quarter turns, by
 * least squares over the radius, from a quarter to 85 % of the foot's. */
static double flank(const struct heap *p, const int *height, double azimuth, double cx, double cy, double ground)
{
    double foot = 0, n = 0, sr = 0, sz = 0, srr = 0, srz = 0;
    for (int y = 0; y < p->n[1]; y++)
        for (int x = 0; x < p->n[0]; x++) {
            if (height[y * p->n[0] + x] > ground)
                n++;
        }
    foot = sqrt(n / pi);
    n = 0;
    for (int y = 0; y < p->n[1]; y++)
        for (int x = 0; x < p->n[0]; x++) {
            double dx = x + 0.5 - cx, dy = y + 0.5 - cy, r = hypot(dx, dy), a = atan2(dy, dx) - azimuth;
            a -= pi / 2 * round(a / (pi / 2));
            if (fabs(a) > 10 * pi / 180 || r < 0.25 * foot || r > 0.8 * foot)
                continue;
            n++, sr += r, sz += height[y * p->n[0] + x], srr += r * r, srz += r * height[y * p->n[0] + x];
        }
    return atan(-(n * srz - sr * sz) / (n * srr - sr * sr)) * 180 / pi;
}

static void cone(double repose, int frames, int per_frame)
{
    const int n[3] = {64, 64, 48};
    struct heap p = heap_begin(n, 0.5, repose);
    heap_box(&p, (int[]){0, 0, 0}, (int[]){64, 64, 2});
    for (int f = 0; f < frames; f++) {
        uint32_t ids[1024];
        for (int i = 0; i < per_frame; i++) {
            uint32_t hash = random_hash(3, (uint32_t)f, (uint32_t)i, 0);
            ids[i] = p.next_id;
            heap_add(&p, 30 + (int)(hash & 3), 30 + (int)(hash >> 2 & 3), 40 + (int)(hash >> 4 & 3));
        }
        heap_step(&p, ids, (size_t)per_frame, 1);
    }
    int *z = heap_heights(&p);
    for (int i = 0; i < 64; i++)
        printf("%d ", z[32 * 64 + i]);
    printf("\n");
    for (int i = 0; i < 64; i++)
        printf("%d ", z[i * 64 + i]);
    printf("\n");
    print_message("# %g deg: axes %.2f, diagonals %.2f; left %llu of %d, slid %llu, rounds %d\n", repose,
                  flank(&p, z, 0, 32, 32, 2), flank(&p, z, pi / 4, 32, 32, 2), (unsigned long long)p.left,
                  frames * per_frame, (unsigned long long)p.slid, p.most_rounds);
    free(z);
    heap_end(&p);
}

static void cones(void **state)
{
    (void)state;
    cone(25, 100, 60);
    cone(34, 100, 80);
    cone(40, 100, 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(cones)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
