/* Stress against what is known: the column, the reference shapes' own fields, and the weight on the base. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stress/elastic.h"
#include "tests/physics/boxes.h"
#include "tests/physics/stress_help.h"
#include "tests/ref/multigrid_ref.h"
#include "tests/ref/stress_dense.h"

struct solved {
    struct gpu *gpu;
    struct gpu_work *work;
    struct particles p;
    struct elastic e;
    float *normal; /* [cells][4] */
};

static struct solved solve_by(const struct box *box, size_t n_boxes, const int cells[3], double dx,
                              double tolerance, int max_iterations, bool multigrid)
{
    struct solved s = {0};
    int voxels[3] = {2 * cells[0], 2 * cells[1], 2 * cells[2]};
    struct elastic_options options = {.lambda = 12e9,
                                      .mu = 15e9,
                                      .density = 2300,
                                      .gravity = 9.81,
                                      .tolerance = tolerance,
                                      .max_iterations = max_iterations,
                                      .multigrid = multigrid};
    struct rock rock = box_rock(box, n_boxes, voxels, dx / 2);
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &s.gpu));
    assert_ok(gpu_work_create(s.gpu, (size_t)voxels[0] * (size_t)voxels[1] * (size_t)voxels[2] + 2, &s.work));
    assert_ok(particles_create(s.gpu, s.work, &rock, STATE, voxels, dx / 2, &s.p));
    assert_ok(elastic_create(s.gpu, voxels, dx / 2, &options, &s.e));
    assert_ok(elastic_assemble(s.gpu, s.work, &s.e, &s.p));
    assert_ok(elastic_solve(s.gpu, s.work, &s.e));
    elastic_recover(s.gpu, &s.e, &s.p);
    s.normal = malloc(dense_cells(s.e.lattice.cells) * 16);
    assert_ok(dense_download(s.gpu, &s.e.lattice, s.e.normal_stress, false, s.normal));
    print_message("# %d iterations on %zu nodes, estimated error %.2g\n", s.e.iterations,
                  s.e.lattice.n_active, s.e.error);
    rock_free(&rock);
    return s;
}

static struct solved solve(const struct box *box, size_t n_boxes, const int cells[3], double dx,
                           double tolerance)
{
    return solve_by(box, n_boxes, cells, dx, tolerance, 20000, true);
}

static void end(struct solved *s)
{
    free(s->normal);
    elastic_destroy(s->gpu, &s->e);
    particles_destroy(s->gpu, &s->p);
    gpu_work_destroy(s->gpu, &s->work);
    gpu_destroy(&s->gpu);
}

static const float *cell(const struct solved *s, int i, int j, int k)
{
    return s->normal + 4 * (((size_t)(k + 1) * (size_t)s->e.lattice.cells[1] + (size_t)(j + 1)) *
                                (size_t)s->e.lattice.cells[0] +
                            (size_t)(i + 1));
}

static void column_carries_its_own_weight(void **state)
{
    const struct box box = {{0, 0, 0}, {12, 12, 48}};
    struct solved s = solve(&box, 1, (int[]){12, 12, 48}, 1, 1e-4);
    double worst = 0;
    (void)state;
    /* Away from the held base, which keeps the foot from widening, and from the top. */
    for (int k = 14; k < 46; k++)
        for (int j = 0; j < 12; j++)
            for (int i = 0; i < 12; i++) {
                double expected = -2300 * 9.81 * (48 - (k + 0.5));
                worst = fmax(worst, fabs((double)cell(&s, i, j, k)[2] / expected - 1));
            }
    print_message("# column: szz is within %.3f %%\n", 100 * worst);
    assert_true(worst < 0.01);
    end(&s);
}

static int rock_at(const struct solved *s, int i, int j, int k)
{
    const float *c = i < 0 || j < 0 || k < -1 ? NULL : cell(s, i, j, k);
    return k < 0 || (c && (c[0] != 0 || c[1] != 0 || c[2] != 0));
}

/* Compares T with the shape's reference field at cells at least two cells from any edge (where two faces
 * meet): cells whose two rings of neighbours are bare along no more than one direction. */
static void agrees_with_reference(const char *name, const struct box *box, size_t n_boxes, const int cells[3])
{
    struct solved s = solve(box, n_boxes, cells, 1, 1e-4);
    char command[512];
    const char *top = getenv("HOODOO_TOP");
    snprintf(command, sizeof command, "gzip -dc '%s/tests/physics/reference/%s.csv.gz'", top ? top : ".",
             name);
    FILE *f = popen(command, "r");
    assert_non_null(f);
    char line[512];
    double *error = malloc(1000000 * sizeof *error), *t_all = malloc(1000000 * sizeof *t_all);
    size_t n = 0, n_all = 0;
    assert_non_null(fgets(line, sizeof line, f));
    while (fgets(line, sizeof line, f)) {
        double v[10];
        assert_int_equal(sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3,
                                v + 4, v + 5, v + 6, v + 7, v + 8, v + 9),
                         10);
        int c[3] = {(int)v[0], (int)v[1], (int)v[2]};
        double t = -(v[3] + v[4] + v[5]);
        t_all[n_all++] = fabs(t);
        int bare_axes = 0;
        for (int axis = 0; axis < 3; axis++) {
            int bare = 0;
            for (int d = -2; d <= 2; d++) {
                int at[3] = {c[0], c[1], c[2]};
                at[axis] += d;
                bare |= at[0] < 0 || at[1] < 0 || at[0] >= cells[0] || at[1] >= cells[1] ||
                        at[2] >= cells[2] || !rock_at(&s, at[0], at[1], at[2]);
            }
            /* The held base is an edge where it meets a free face. */
            bare |= axis == 2 && c[2] < 2;
            bare_axes += bare;
        }
        int inner_corner = 0; /* a bare cell off the axes: a re-entrant edge */
        for (int dz = -2; dz <= 2; dz++)
            for (int dy = -2; dy <= 2; dy++)
                for (int dx = -2; dx <= 2; dx++) {
                    int at[3] = {c[0] + dx, c[1] + dy, c[2] + dz};
                    int outside =
                        at[0] < 0 || at[1] < 0 || at[0] >= cells[0] || at[1] >= cells[1] || at[2] >= cells[2];
                    inner_corner |= outside ? 0 : !rock_at(&s, at[0], at[1], at[2]);
                }
        if (bare_axes > 1 || (bare_axes == 0 && inner_corner))
            continue;
        error[n++] = fabs((double)cell(&s, c[0], c[1], c[2])[3] - t);
    }
    pclose(f);
    assert_true(n > 1000);
    qsort(error, n, sizeof *error, stress_ascending);
    qsort(t_all, n_all, sizeof *t_all, stress_ascending);
    double p95 = t_all[n_all * 95 / 100];
    double median_error = error[n / 2] / p95, p95_error = error[n * 95 / 100] / p95;
    print_message(
        "# %s: T differs by %.2f %% (median), %.2f %% (95th) of T_p95 = %.0f Pa in %zu of %zu cells\n", name,
        100 * median_error, 100 * p95_error, p95, n, n_all);
    assert_true(median_error <= 0.015);
    assert_true(p95_error <= 0.04);

    /* The base carries the whole weight. */
    double force = 0, volume = 0;
    for (size_t b = 0; b < n_boxes; b++)
        volume += (box[b].max[0] - box[b].min[0]) * (box[b].max[1] - box[b].min[1]) *
                  (box[b].max[2] - box[b].min[2]);
    for (int j = 0; j < cells[1]; j++)
        for (int i = 0; i < cells[0]; i++)
            force -= (double)cell(&s, i, j, 0)[2];
    /* szz at the centre of the lowest cells: half a cell of weight is below it. */
    double below = 0;
    for (int j = 0; j < cells[1]; j++)
        for (int i = 0; i < cells[0]; i++)
            below += rock_at(&s, i, j, 0) ? 0.5 * 2300 * 9.81 : 0;
    double share = (force + below) / (volume * 2300 * 9.81);
    print_message("# %s: the base carries %.3f %% of the weight\n", name, 100 * share);
    assert_true(fabs(share - 1) < 0.005);
    free(error);
    free(t_all);
    end(&s);
}

static void column_agrees_with_reference(void **state)
{
    const struct box box = {{0, 0, 0}, {12, 12, 48}};
    (void)state;
    agrees_with_reference("column", &box, 1, (int[]){12, 12, 48});
}

static void ledge_agrees_with_reference(void **state)
{
    const struct box box[] = {{{0, 0, 0}, {16, 16, 32}}, {{16, 0, 22}, {32, 16, 32}}};
    (void)state;
    agrees_with_reference("ledge", box, 2, (int[]){32, 16, 32});
}

static void mushroom_agrees_with_reference(void **state)
{
    const struct box box[] = {{{13, 13, 0}, {23, 23, 24}}, {{0, 0, 24}, {36, 36, 36}}};
    (void)state;
    agrees_with_reference("mushroom", box, 2, (int[]){36, 36, 36});
}

/* ---- multigrid */

/* A slab on thin legs, on levels whose sizes are odd. */
static const struct box table[] = {
    {{1, 1, 0}, {3, 3, 12}}, {{9, 7, 0}, {12, 9, 12}}, {{1, 1, 11}, {13, 10, 15}}};

static void cycle_agrees_with_plain_c(void **state)
{
    enum { STEPS = 6 };
    struct solved s = solve_by(table, 3, (int[]){13, 10, 15}, 1, 1e-7, STEPS, true);
    const struct elastic_grid g = {
        {s.e.lattice.cells[0], s.e.lattice.cells[1], s.e.lattice.cells[2]}, 12e9, 15e9, 1};
    const size_t cells = dense_cells(g.cells), nodes = dense_nodes(g.cells);
    float *fill = malloc(cells * sizeof *fill), *u = malloc(nodes * 16), *expected = malloc(nodes * 16),
          scalars[CG_ENERGY + CG_CHECK];
    double taken[STEPS], worst = 0, error = 0, most = 0;
    (void)state;
    assert_ok(dense_download(s.gpu, &s.e.lattice, s.e.lattice.fill, false, fill));
    assert_ok(dense_download(s.gpu, &s.e.lattice, s.e.u, true, u));
    assert_ok(gpu_download(s.gpu, s.e.scalars, 0, scalars, CG_ENERGY + CG_CHECK));
    struct multigrid_ref *ref = multigrid_ref_create(&g, fill);
    assert_non_null(ref);
    multigrid_ref_solve(ref, 2300 * 9.81, STEPS, taken, expected);
    for (int i = 0; i < STEPS; i++)
        worst = fmax(worst, fabs((double)scalars[CG_ENERGY + (uint)i] / taken[i] - 1));
    for (size_t i = 0; i < 4 * nodes; i++) {
        if (i % 4 == 3)
            continue;
        error = fmax(error, fabs((double)u[i] - (double)expected[i]));
        most = fmax(most, fabs((double)expected[i]));
    }
    print_message(
        "# after %d cycles, energies differ from plain C's by %.2g, displacements by %.2g of the largest\n",
        STEPS, worst, error / most);
    assert_true(worst < 0.01);
    assert_true(error < 1e-4 * most);
    multigrid_ref_destroy(ref);
    free(fill);
    free(u);
    free(expected);
    end(&s);
}

/* The mushroom, of ever more cells. */
static void iterations_do_not_grow(void **state)
{
    int most = 0;
    (void)state;
    for (int n = 1; n <= 4; n *= 2) {
        struct box box[] = {{{13, 13, 0}, {23, 23, 24}}, {{0, 0, 24}, {36, 36, 36}}};
        struct solved s = solve_by(box, 2, (int[]){9 * n, 9 * n, 9 * n}, 4.0 / n, 1e-3, 100, true);
        assert_true(s.e.error <= 1e-3);
        most = s.e.iterations > most ? s.e.iterations : most;
        end(&s);
    }
    assert_true(most <= 15);
}

/* What it finds does not depend on the preconditioner. */
static void jacobi_agrees(void **state)
{
    struct solved a = solve_by(table, 3, (int[]){13, 10, 15}, 1, 1e-5, 100, true),
                  b = solve_by(table, 3, (int[]){13, 10, 15}, 1, 1e-5, 20000, false);
    double error = 0, most = 0;
    (void)state;
    for (size_t c = 0; c < dense_cells(a.e.lattice.cells); c++) {
        error = fmax(error, fabs((double)a.normal[4 * c + 3] - (double)b.normal[4 * c + 3]));
        most = fmax(most, fabs((double)b.normal[4 * c + 3]));
    }
    print_message("# T of %d cycles differs from that of %d steps of Jacobi's by %.2g of the largest\n",
                  a.e.iterations, b.e.iterations, error / most);
    assert_true(error < 2e-4 * most);
    assert_true(a.e.iterations * 8 < b.e.iterations);
    end(&a);
    end(&b);
}

/* The demo's frames, as a run solves them and from nothing: the error is within the tolerance. */
static void stop_tells_the_truth(void **state)
{
    struct stress_errors errors = {0};
    char path[512];
    const char *top = getenv("HOODOO_TOP"), *const sets[] = {"domain.spacing_m=1",
                                                             "wind.flow.solver=uniform"};
    (void)state;
    snprintf(path, sizeof path, "%s/jobs/demo.yaml", top ? top : ".");
    stress_errors_of(path, sets, 2, 7, 3, &errors);
    assert_int_equal(errors.beyond, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(column_carries_its_own_weight), cmocka_unit_test(column_agrees_with_reference),
        cmocka_unit_test(ledge_agrees_with_reference),   cmocka_unit_test(mushroom_agrees_with_reference),
        cmocka_unit_test(cycle_agrees_with_plain_c),     cmocka_unit_test(jacobi_agrees),
        cmocka_unit_test(iterations_do_not_grow),        cmocka_unit_test(stop_tells_the_truth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
