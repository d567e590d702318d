/* Material points against what is known: equilibrium as conjugate gradients find it, conservation, free flight,
 * contact, and one step against plain C. */
#include "mpm_help.h"

#include "stress/elastic.h"
#include "tests/ref/mpm_ref.h"

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* ---- equilibrium */

/* T at the particles by both solvers; compared in particles two cells or more from any bare face. */
static void rests_as_elastic_does(const char *name, const struct box *box, size_t n_boxes, const int cells[3])
{
    struct mpm_options o = soft_rock();
    o.lambda = 12e9;
    o.mu = 15e9;
    o.lift = 0;
    struct body b = body_of(box, n_boxes, cells, 1, &o);
    struct elastic e;
    struct elastic_options options = {.lambda = 12e9,
                                      .mu = 15e9,
                                      .density = 2300,
                                      .gravity = 9.81,
                                      .tolerance = 1e-4,
                                      .max_iterations = 20000,
                                      .multigrid = true};
    int voxels[3] = {2 * cells[0], 2 * cells[1], 2 * cells[2]}, steps;
    double error, worst;
    size_t n = b.p.n, n_inside = 0;
    float *t = malloc(n * 4), *mises = malloc(n * 4), *x = malloc(n * 16), *share = malloc(n * 4),
          *expected = malloc(n * 4);
    double *difference = malloc(n * sizeof(double)), *size = malloc(n * sizeof(double));
    for (size_t i = 0; i < n; i++)
        share[i] = 1;
    assert_ok(gpu_upload(b.gpu, b.p.field[ROCK_viability], 0, share, n));
    assert_ok(mpm_rest(b.gpu, b.work, &b.m, &b.p, 0.005, 20000, &steps, &error));
    assert_ok(gpu_download(b.gpu, b.p.field[ROCK_stress], 0, t, n));
    assert_ok(elastic_create(b.gpu, voxels, 0.5, &options, &e));
    assert_ok(elastic_assemble(b.gpu, b.work, &e, &b.p));
    assert_ok(elastic_solve(b.gpu, b.work, &e));
    elastic_recover(b.gpu, &e, &b.p);
    assert_ok(gpu_download(b.gpu, b.p.field[ROCK_stress], 0, expected, n));
    assert_ok(gpu_download(b.gpu, b.p.field[ROCK_P], 0, x, n));
    for (size_t i = 0; i < n; i++) {
        size[i] = fabs((double)expected[i]);
        int inside = 1;
        for (int c = 0; c < 125 && inside; c++) {
            double at[3] = {(double)x[4 * i] + 1.25 * (c % 5 - 2),
                            (double)x[4 * i + 1] + 1.25 * (c / 5 % 5 - 2),
                            (double)x[4 * i + 2] + 1.25 * (c / 25 - 2)};
            int any = 0;
            for (size_t k = 0; k < n_boxes; k++)
                any |= at[0] > box[k].min[0] && at[0] < box[k].max[0] && at[1] > box[k].min[1] &&
                       at[1] < box[k].max[1] && at[2] > box[k].min[2] && at[2] < box[k].max[2];
            inside &= any;
        }
        if (inside)
            difference[n_inside++] = fabs((double)t[i] - (double)expected[i]);
    }
    qsort(size, n, sizeof *size, ascending);
    qsort(difference, n_inside, sizeof *difference, ascending);
    assert_true(n_inside > n / 10);
    worst = difference[n_inside * 95 / 100] / size[n * 95 / 100];
    print_message(
        "# %s: at rest after %d steps (estimated error %.2g); T differs from conjugate gradients' by "
        "%.2f %% (median), %.2f %% (95th) of T_p95 = %.0f Pa in %zu of %zu particles\n",
        name, steps, error, 100 * difference[n_inside / 2] / size[n * 95 / 100], 100 * worst,
        size[n * 95 / 100], n_inside, n);
    assert_true(worst < 0.05);
    elastic_destroy(b.gpu, &e);
    body_end(&b);
    free(t);
    free(mises);
    free(x);
    free(share);
    free(expected);
    free(difference);
    free(size);
}

static void column_rests(void **state)
{
    const struct box box = {{0, 0, 0}, {10, 10, 24}};
    (void)state;
    rests_as_elastic_does("column", &box, 1, (int[]){10, 10, 24});
}

static void ledge_rests(void **state)
{
    const struct box box[] = {{{0, 0, 0}, {12, 10, 24}}, {{12, 0, 15}, {22, 10, 24}}};
    (void)state;
    rests_as_elastic_does("ledge", box, 2, (int[]){22, 10, 24});
}

/* ---- one step */

static void step_as_plain_c(void **state)
{
    const struct box box[] = {{{1, 1, 0}, {4, 3, 3}}, {{3, 2, 4}, {5, 5, 6}}};
    const double seconds = 1e-3;
    struct mpm_options o = soft_rock();
    o.viscosity = 0.1;
    o.strength = 4e5;
    o.rebound = 0.3;
    struct body b = body_of(box, 2, (int[]){6, 6, 8}, 1, &o);
    struct points s = points_of(&b);
    struct mpm_ref_particle *p = calloc(s.n, sizeof *p);
    double sine = sin(o.repose_deg * acos(-1) / 180), wave = sqrt((o.lambda + 2 * o.mu) / o.density);
    struct mpm_ref_rock r = {.cells = {6, 6, 8},
                             .dx = 1,
                             .dt = seconds,
                             .density = o.density,
                             .lambda = o.lambda,
                             .mu = o.mu,
                             .viscosity = o.viscosity * o.density * wave,
                             .rebound = o.rebound,
                             .gravity = o.gravity,
                             .friction = o.friction,
                             .alpha = sqrt(2.0 / 3) * 2 * sine / (3 - sine)};
    (void)state;
    for (size_t i = 0; i < s.n; i++) {
        double C[3][3], H[3][3];
        p[i].apart = i % 5 == 0 ? 0.002 * (double)(i % 3) : -1;
        p[i].share = 0.4 + 0.6 * (double)(i % 7) / 6;
        p[i].strength = o.strength;
        s.apart[i] = (float)p[i].apart;
        s.share[i] = (float)p[i].share;
        p[i].share = (double)s.share[i];
        p[i].apart = (double)s.apart[i];
        for (int a = 0; a < 3; a++) {
            s.vector[MPM_PLACE][4 * i + (size_t)a] += (float)(0.2 * sin(1.7 * (double)i + a));
            s.vector[MPM_VELOCITY][4 * i + (size_t)a] = (float)(3 * sin(0.9 * (double)i + 2 * a));
            for (int c = 0; c < 3; c++) {
                C[a][c] = 2 * sin(0.3 * (double)i + 3 * a + c);
                H[a][c] = 0.004 * sin(0.7 * (double)i + a + 5 * c);
            }
        }
        point_set_matrix(&s, MPM_AFFINE_X, i, (const double(*)[3])C);
        point_set_matrix(&s, MPM_STRETCH_X, i, (const double(*)[3])H);
        point_matrix(&s, MPM_AFFINE_X, i, p[i].C);
        point_matrix(&s, MPM_STRETCH_X, i, p[i].F);
        for (int a = 0; a < 3; a++) {
            p[i].F[a][a] += 1;
            p[i].x[a] = (double)point_x(&s, i)[a];
            p[i].v[a] = (double)point_v(&s, i)[a];
        }
    }
    points_put(&b, &s);
    size_t *of_id = calloc(s.n, sizeof *of_id), n_whole = 0, n_broken = 0, n_different = 0;
    for (size_t i = 0; i < s.n; i++)
        of_id[s.id[i]] = i;
    assert_ok(mpm_run(b.gpu, b.work, &b.m, seconds));
    assert_int_equal(b.m.steps, 1);
    mpm_ref_step(&r, p, s.n);
    struct points after = points_of(&b);
    assert_int_equal(after.n, s.n);
    double worst[4] = {0};
    for (size_t i = 0; i < after.n; i++) {
        const struct mpm_ref_particle *q = &p[of_id[after.id[i]]];
        double C[3][3], H[3][3];
        point_matrix(&after, MPM_AFFINE_X, i, C);
        point_matrix(&after, MPM_STRETCH_X, i, H);
        n_whole += q->apart < 0;
        n_broken += q->apart >= 0 && s.apart[of_id[after.id[i]]] < 0;
        /* At the threshold itself either may be right. */
        if ((q->apart < 0) != (after.apart[i] < 0)) {
            n_different++;
            continue;
        }
        for (int a = 0; a < 3; a++) {
            worst[0] = fmax(worst[0], fabs((double)point_x(&after, i)[a] - q->x[a]));
            worst[1] = fmax(worst[1], fabs((double)point_v(&after, i)[a] - q->v[a]));
            for (int c = 0; c < 3; c++) {
                worst[2] = fmax(worst[2], fabs(C[a][c] - q->C[a][c]));
                worst[3] = fmax(worst[3], fabs(H[a][c] + (a == c) - q->F[a][c]));
            }
        }
        assert_true(fabs((double)after.apart[i] - q->apart) < 1e-5);
    }
    print_message(
        "# one step of %zu particles (%zu whole, %zu just broken): x differs by %.1g m, v by %.1g m/s, C by "
        "%.1g 1/s, F by %.1g; %zu at the threshold\n",
        s.n, n_whole, n_broken, worst[0], worst[1], worst[2], worst[3], n_different);
    assert_true(n_broken > 10 && n_whole > 10);
    assert_true(n_different <= 1);
    assert_true(worst[0] < 2e-6 && worst[1] < 2e-4 && worst[2] < 2e-3 && worst[3] < 3e-6);
    points_free(&s);
    points_free(&after);
    free(p);
    free(of_id);
    body_end(&b);
}

/* ---- free flight */

static void set_motion(struct body *b, const double v[3], const double spin[3])
{
    struct points s = points_of(b);
    struct totals t = totals_of(b, &s);
    const double C[3][3] = {{0, -spin[2], spin[1]}, {spin[2], 0, -spin[0]}, {-spin[1], spin[0], 0}};
    for (size_t i = 0; i < s.n; i++) {
        for (int a = 0; a < 3; a++) {
            double sum = v[a];
            for (int c = 0; c < 3; c++)
                sum += C[a][c] * ((double)point_x(&s, i)[c] - t.middle[c]);
            s.vector[MPM_VELOCITY][4 * i + (size_t)a] = (float)sum;
        }
        point_set_matrix(&s, MPM_AFFINE_X, i, C);
    }
    points_put(b, &s);
    b->m.fastest = 10;
    points_free(&s);
}

static void block_falls_freely(void **state)
{
    const struct box box = {{2, 2, 12}, {6, 5, 15}};
    struct mpm_options o = soft_rock();
    struct body b = body_of(&box, 1, (int[]){8, 8, 16}, 1, &o);
    struct points s = points_of(&b);
    double start = totals_of(&b, &s).middle[2];
    (void)state;
    points_free(&s);
    for (int f = 1; f <= 4; f++) {
        double t = 0.3 * f;
        assert_ok(mpm_run(b.gpu, b.work, &b.m, 0.3));
        s = points_of(&b);
        double fallen = start - totals_of(&b, &s).middle[2];
        print_message("# after %.1f s a block has fallen %.4f m: %+.3f %% off g t^2 / 2 (%ld steps)\n", t,
                      fallen, 100 * (fallen / (0.5 * 9.81 * t * t) - 1), b.m.steps);
        if (f > 1) /* a step's length of t is 0.4 % of it at first */
            assert_true(fabs(fallen / (0.5 * 9.81 * t * t) - 1) < 0.005);
        points_free(&s);
    }
    body_end(&b);
}

static void spin_momentum_energy(void **state)
{
    const struct box box = {{5, 6, 6}, {11, 9, 8}};
    const double v[3] = {0.7, -0.4, 0.3}, spin[3] = {0.6, 1.1, 2.0};
    struct mpm_options o = soft_rock();
    o.gravity = 0;
    struct body b = body_of(&box, 1, (int[]){16, 16, 16}, 1, &o);
    const struct mpm_ref_rock r = {.dx = 1, .lambda = o.lambda, .mu = o.mu};
    double energy_before = 1e300, energy_start = 0, drift = 0, turned = 0, growth = 0;
    struct totals first = {0};
    (void)state;
    set_motion(&b, v, spin);
    for (int f = 0; f <= 20; f++) {
        if (f > 0)
            assert_ok(mpm_run(b.gpu, b.work, &b.m, 0.05));
        struct points s = points_of(&b);
        struct totals t = totals_of(&b, &s);
        double energy = t.kinetic, p = 0, l = 0, p0 = 0, l0 = 0;
        for (size_t i = 0; i < s.n; i++) {
            struct mpm_ref_particle q = {.share = (double)s.share[i]};
            point_matrix(&s, MPM_STRETCH_X, i, q.F);
            for (int a = 0; a < 3; a++)
                q.F[a][a] += 1;
            energy += mpm_ref_energy(&r, &q);
        }
        if (f == 0) {
            first = t;
            energy_start = energy;
        }
        growth = fmax(growth, energy / energy_before - 1);
        energy_before = energy;
        for (int a = 0; a < 3; a++) {
            /* about the middle */
            int e = (a + 1) % 3, g = (a + 2) % 3;
            double own = t.l[a] - (t.middle[e] * t.p[g] - t.middle[g] * t.p[e]);
            double was = first.l[a] - (first.middle[e] * first.p[g] - first.middle[g] * first.p[e]);
            p += (t.p[a] - first.p[a]) * (t.p[a] - first.p[a]);
            p0 += first.p[a] * first.p[a];
            l += (own - was) * (own - was);
            l0 += was * was;
        }
        drift = fmax(drift, sqrt(p / p0));
        turned = fmax(turned, sqrt(l / l0));
        if (f == 20)
            print_message(
                "# spinning for 1 s: momentum off by %.1g, angular momentum by %.2g; energy %.4f of the "
                "start, most it grew between two looks %.1g\n",
                drift, turned, energy / energy_start, growth);
        points_free(&s);
    }
    assert_true(drift < 1e-5);
    assert_true(turned < 0.01);
    assert_true(growth < 1e-4);
    body_end(&b);
}

/* ---- contact */

static void slab_hits_and_rests(void **state)
{
    /* A cantilever cut off its wall, one end lower. */
    const struct box box[] = {{{3, 3, 6}, {13, 6, 8}}, {{3, 3, 5}, {5, 6, 6}}};
    struct mpm_options o = soft_rock();
    o.viscosity = 0.3;
    o.rebound = 0.1;
    o.strength = 2e6;
    o.block = 2.5;
    o.joint = 0.05;
    struct body b = body_of(box, 2, (int[]){16, 9, 10}, 1, &o);
    double lowest = 1e30, at_rest = -1, moved = 0;
    float *before = NULL;
    (void)state;
    for (int f = 1; f <= 96; f++) {
        assert_ok(mpm_run(b.gpu, b.work, &b.m, 1.0 / 24));
        struct points s = points_of(&b);
        struct totals whole = totals_of(&b, &s);
        double speed = sqrt(2 * whole.kinetic / whole.mass);
        assert_int_equal(s.n, b.n);
        for (size_t i = 0; i < s.n; i++)
            lowest = fmin(lowest, (double)point_x(&s, i)[2]);
        if (speed < 0.05 && at_rest < 0)
            at_rest = f / 24.0;
        else if (speed >= 0.05)
            at_rest = -1;
        if (f >= 72) {
            float *x = calloc(b.n, 12);
            for (size_t i = 0; i < s.n; i++)
                memcpy(x + 3 * s.id[i], point_x(&s, i), 12);
            for (size_t i = 0; before && i < 3 * b.n; i++)
                moved = fmax(moved, fabs((double)(x[i] - before[i])));
            if (before)
                free(x);
            else
                before = x;
        }
        points_free(&s);
    }
    print_message("# a cantilever let go rests (rms speed below 0.05 m/s from there on) after %.2f s; its "
                  "lowest particle is never below %.4f m; in the "
                  "following second no particle moves more than %.4f m\n",
                  at_rest, lowest, moved);
    assert_true(lowest >= 0);
    assert_true(at_rest > 0 && at_rest <= 3);
    assert_true(moved < 0.15); /* grains trickle on */
    free(before);
    body_end(&b);
}

static void blocks_do_not_pass(void **state)
{
    const struct box box[] = {{{3, 3, 0}, {7, 7, 3}}, {{3.5, 3.5, 8}, {6.5, 6.5, 11}}};
    struct mpm_options o = soft_rock();
    o.viscosity = 0.3;
    o.rebound = 0.1;
    struct body b = body_of(box, 2, (int[]){10, 10, 12}, 1, &o);
    size_t n_low = 4 * 4 * 3 * 8;
    double gap = 1e30, lower = 0, upper = 0;
    (void)state;
    for (int f = 0; f < 24 * 2; f++) {
        assert_ok(mpm_run(b.gpu, b.work, &b.m, 1.0 / 24));
        struct points s = points_of(&b);
        double top = 0, bottom = 1e30;
        lower = upper = 0;
        for (size_t i = 0; i < s.n; i++) {
            double z = (double)point_x(&s, i)[2];
            if (s.id[i] < n_low) {
                top = fmax(top, z);
                lower += z / (double)n_low;
            } else {
                bottom = fmin(bottom, z);
                upper += z / (double)(s.n - n_low);
            }
        }
        gap = fmin(gap, bottom - top);
        points_free(&s);
    }
    print_message(
        "# a block dropped on another: the nearest their faces' particles came is %.3f m (0.5 m apart in "
        "rock); middles end at %.2f m and %.2f m\n",
        gap, lower, upper);
    assert_true(gap > 0);
    assert_true(upper - lower > 2.5);
    body_end(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(step_as_plain_c),      cmocka_unit_test(block_falls_freely),
        cmocka_unit_test(spin_momentum_energy), cmocka_unit_test(slab_hits_and_rests),
        cmocka_unit_test(blocks_do_not_pass),   cmocka_unit_test(column_rests),
        cmocka_unit_test(ledge_rests),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
