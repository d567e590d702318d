/* Water on a bed that does not let it through: Dupuit's parabola, sheets on beds that dip, water tables as high as the land, and that nothing is lost. */
#include "check.h"

#include <math.h>
#include <stdbool.h>

#include "groundwater/aquifer.h"

static const double wide = 96, rain = 0.05, K = 30; /* m, m/yr, m/yr */

struct case_of {
    double base_x, base_wave; /* m: how much the bed falls along x, and the height of its waves */
    double room, room_y;      /* m: of the rock on it, and how that grows away from the middle */
    bool open[NEIGHBOURS];
};

static void solve(const struct case_of *t, int n, struct aquifer *a)
{
    const double dx = wide / n;
    struct fivepoint_solver *solver;
    assert_ok(aquifer_create((const int[]){n, n}, dx, a));
    assert_ok(fivepoint_create((const int[]){n, n}, &solver));
    for (size_t c = 0; c < (size_t)n * (size_t)n; c++) {
        const double x = ((double)(c % (size_t)n) + 0.5) * dx, y = ((double)(c / (size_t)n) + 0.5) * dx;
        a->conductivity[c] = K;
        a->recharge[c] = rain * dx * dx;
        a->base[c] = t->base_x * (1 - x / wide) + t->base_wave * sin(x / 5) * sin(y / 7);
        a->room[c] = t->room + t->room_y * fabs(y - wide / 2);
    }
    for (size_t c = 0; c < (size_t)n * (size_t)n; c++)
        for (int d = 0; d < NEIGHBOURS; d++) {
            const bool edge = fivepoint_beside(a->n, c, d) < 0;
            a->face[d][c] = !edge ? FACE_JOINED : t->open[d] ? FACE_OPEN : FACE_CLOSED;
            a->sill[d][c] = a->base[c];
        }
    aquifer_solve(a, solver, 8 * 2 * n);
    fivepoint_destroy(&solver);
}

static double sum_out(const struct aquifer *a, double *over)
{
    double sum = 0;
    *over = 0;
    for (size_t c = 0; c < (size_t)a->n[0] * (size_t)a->n[1]; c++) {
        *over += a->over[c];
        for (int d = 0; d < NEIGHBOURS; d++)
            sum += a->face[d][c] == FACE_JOINED ? 0 : aquifer_flow(a, c, d);
    }
    return sum;
}

/* Between two drains L apart b^2 = R / K x (L - x). */
static void between_two_drains_it_is_dupuits_parabola(void **state)
{
    static const struct case_of drains = {.room = 50, .open = {[WEST] = true, [EAST] = true}};
    (void)state;
    for (int n = 24; n <= 48; n *= 2) {
        struct aquifer a;
        double worst = 0, over;
        solve(&drains, n, &a);
        for (int i = 0; i < n; i++) {
            const double x = (i + 0.5) * a.dx, expected = sqrt(rain / K * x * (wide - x));
            worst = fmax(worst, fabs(a.thick[n / 2 * n + i] / expected - 1));
        }
        const double out = sum_out(&a, &over);
        print_message("# %g m: %.2f %% off at most; %.9g of %.9g m3/yr come out, %d rounds\n", a.dx,
                      100 * worst, out, rain * wide * wide, a.rounds);
        assert_true(worst < 0.03);
        assert_true(fabs(out / (rain * wide * wide) - 1) < 1e-6 && over == 0);
        assert_true(a.left <= AQUIFER_LEFT);
        aquifer_destroy(&a);
    }
}

/* On a bed that dips, far from its ends, all rain from above flows past: K b slope = R x. */
static void on_a_bed_that_dips_it_is_a_sheet(void **state)
{
    static const struct case_of dips = {.base_x = 48, .room = 50, .open = {[EAST] = true}};
    (void)state;
    for (int n = 24; n <= 48; n *= 2) {
        struct aquifer a;
        double over, worst = 0;
        solve(&dips, n, &a);
        for (int i = n / 4; i < 3 * n / 4; i++) {
            const double x = (i + 1) * a.dx, expected = rain * x / (K * 0.5);
            worst = fmax(worst, fabs(a.thick[i] / expected - 1));
        }
        print_message("# %g m: %.2f %% off at most, %d rounds\n", a.dx, 100 * worst, a.rounds);
        assert_true(worst < 0.03 && fabs(sum_out(&a, &over) / (rain * wide * wide) - 1) < 1e-6);
        aquifer_destroy(&a);
    }
}

/* Where rock is thin, water comes out at its top; on uneven beds there are ponds; and where no water leaves, all of it comes out at the top. In any case as
 * much comes out as sinks in, nowhere is less than nothing or more than there is room for, and twice the same is the same to the bit. */
static void nothing_is_lost(void **state)
{
    static const struct case_of any[] = {
        {.room = 0.5, .room_y = 0.05, .open = {[EAST] = true}},
        {.base_x = 48, .base_wave = 3, .room = 50, .open = {[EAST] = true}},
        {.base_x = 20, .base_wave = 2, .room = 1.5, .room_y = 0.02, .open = {[EAST] = true, [NORTH] = true}},
        {.room = 1, .room_y = 0.1}};
    (void)state;
    for (size_t t = 0; t < sizeof any / sizeof *any; t++) {
        struct aquifer a, again;
        double over, least = 1;
        solve(&any[t], 48, &a);
        solve(&any[t], 48, &again);
        const double out = sum_out(&a, &over);
        for (size_t c = 0; c < 48 * 48; c++) {
            least = fmin(least, a.thick[c]);
            assert_true(a.thick[c] > 0 && a.thick[c] <= a.room[c]);
            assert_true(a.over[c] >= 0 && (a.over[c] == 0 || a.thick[c] == a.room[c]));
        }
        print_message("# %zu: %.6g m3/yr at faces, %.6g at tops, of %.6g; %d rounds, %.1e left\n", t, out,
                      over, rain * wide * wide, a.rounds, a.left);
        assert_true(a.left <= AQUIFER_LEFT && fabs((out + over) / (rain * wide * wide) - 1) < 1e-6);
        assert_memory_equal(a.thick, again.thick, 48 * 48 * sizeof *a.thick);
        aquifer_destroy(&a);
        aquifer_destroy(&again);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(between_two_drains_it_is_dupuits_parabola),
        cmocka_unit_test(on_a_bed_that_dips_it_is_a_sheet),
        cmocka_unit_test(nothing_is_lost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
