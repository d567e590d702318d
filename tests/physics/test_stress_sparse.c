/* The stress grid is kept where there is rock: its memory follows the rock, its numbers know nothing of the box around it,
 * and rock may come and go. */
#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stress/elastic.h"
#include "tests/physics/boxes.h"
#include "tests/physics/stress_help.h"
#include "tests/ref/stress_dense.h"

/* A slab on legs, on cells of 1 m, and what may be added to it: at its end, and on its own. */
static const struct box table[] = {
    {{3, 3, 0}, {6, 7, 14}},    {{20, 3, 0}, {23, 9, 14}},  {{2, 2, 13}, {27, 11, 19}},
    {{27, 4, 15}, {37, 9, 19}}, {{38, 20, 0}, {45, 27, 9}},
};
enum { TABLE = 3, MORE = 5 };

struct solver {
    struct gpu *gpu;
    struct gpu_work *work;
    struct particles p;
    struct elastic e;
    int voxels[3];
};

static struct solver solver_of(const int cells[3], double tolerance)
{
    struct solver s = {.voxels = {2 * cells[0], 2 * cells[1], 2 * cells[2]}};
    const struct elastic_options options = {.lambda = 12e9,
                                            .mu = 15e9,
                                            .density = 2300,
                                            .gravity = 9.81,
                                            .tolerance = tolerance,
                                            .max_iterations = 100,
                                            .multigrid = true};
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &s.gpu));
    assert_ok(gpu_work_create(s.gpu, voxel_count(s.voxels) + 2, &s.work));
    assert_ok(elastic_create(s.gpu, s.voxels, 0.5, &options, &s.e));
    return s;
}

static void set_rock(struct solver *s, const struct box *box, size_t n_boxes)
{
    struct rock rock = box_rock(box, n_boxes, s->voxels, 0.5);
    particles_destroy(s->gpu, &s->p);
    assert_ok(particles_create(s->gpu, s->work, &rock, STATE, s->voxels, 0.5, &s->p));
    assert_ok(elastic_assemble(s->gpu, s->work, &s->e, &s->p));
    rock_free(&rock);
}

static void solve(struct solver *s)
{
    assert_ok(elastic_solve(s->gpu, s->work, &s->e));
    elastic_recover(s->gpu, &s->e, &s->p);
}

static void end(struct solver *s)
{
    elastic_destroy(s->gpu, &s->e);
    particles_destroy(s->gpu, &s->p);
    gpu_work_destroy(s->gpu, &s->work);
    gpu_destroy(&s->gpu);
}

static float *field_of(const struct solver *s, enum rock_field field)
{
    float *x = malloc((s->p.n + 1) * sizeof *x);
    assert_non_null(x);
    assert_ok(gpu_download(s->gpu, s->p.field[field], 0, x, s->p.n));
    return x;
}

/* ---- the box around the rock */

static void same_in_a_larger_box(void **state)
{
    struct solver tight = solver_of((int[]){28, 12, 20}, 1e-3), loose = solver_of((int[]){56, 24, 20}, 1e-3);
    (void)state;
    set_rock(&tight, table, TABLE);
    set_rock(&loose, table, TABLE);
    solve(&tight);
    solve(&loose);
    assert_true(tight.p.n > 10000 && tight.p.n == loose.p.n);
    assert_true(tight.e.iterations == loose.e.iterations);
    for (int f = 0; f < 2; f++) {
        const enum rock_field field = f ? ROCK_von_mises : ROCK_stress;
        float *a = field_of(&tight, field), *b = field_of(&loose, field);
        assert_memory_equal(a, b, tight.p.n * sizeof *a);
        free(a);
        free(b);
    }
    const uint64_t least = stress_taken(&tight.e, true), most = stress_taken(&loose.e, true);
    print_message("# %zu particles: %.2f MB in a tight box, %.2f MB in one four times as large\n", tight.p.n,
                  1e-6 * (double)least, 1e-6 * (double)most);
    assert_true((double)most < 1.1 * (double)least);
    end(&tight);
    end(&loose);
}

/* How many ends the particles' rows along x have. */
static size_t row_ends(const struct solver *s)
{
    float *P = malloc((s->p.n + 1) * 16);
    size_t ends = 0;
    assert_non_null(P);
    assert_ok(gpu_download(s->gpu, s->p.field[ROCK_P], 0, P, s->p.n));
    for (size_t i = 0; i < s->p.n; i++) /* one in each voxel, in the order of voxels */
        if (i + 1 == s->p.n || P[4 * i + 4] != P[4 * i] + 0.5F || P[4 * i + 5] != P[4 * i + 1])
            ends += 2;
    free(P);
    return ends;
}

/* What it takes is what a plan says, whatever the shape. */
static void takes_what_is_planned(void **state)
{
    static const struct {
        const char *name;
        struct box box[4];
        size_t n;
    } shapes[] = {
        {"cube", {{{10, 10, 0}, {50, 50, 40}}}, 1},
        {"block that fills the domain", {{{0, 0, 0}, {64, 64, 48}}}, 1},
        {"walls", {{{5, 5, 0}, {9, 60, 40}}, {{20, 5, 0}, {26, 60, 40}}, {{5, 30, 0}, {60, 38, 40}}}, 3},
        {"slab on legs",
         {{{4, 4, 0}, {12, 12, 30}}, {{40, 30, 0}, {52, 40, 30}}, {{2, 2, 28}, {60, 50, 40}}},
         3}};
    (void)state;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        struct solver s = solver_of((int[]){64, 64, 48}, 1e-2);
        set_rock(&s, shapes[i].box, shapes[i].n);
        solve(&s);
        assert_ok(particles_surface(s.gpu, s.work, &s.p));
        const double planned = (double)elastic_bytes(s.voxels, s.p.n, s.p.n_surface, row_ends(&s));
        print_message("# %s: %zu particles, %zu of them bare: %.1f MB, planned %.1f\n", shapes[i].name, s.p.n,
                      s.p.n_surface, 1e-6 * (double)stress_taken(&s.e, true), 1e-6 * planned);
        assert_true(fabs(planned / (double)stress_taken(&s.e, true) - 1) < 0.1);
        end(&s);
    }
}

/* ---- rock that comes and goes */

/* Each node's displacement, and whether it moves: 1 or 0 in the fourth component. */
static float *nodes_of(const struct solver *s)
{
    const struct stress_lattice *l = &s->e.lattice;
    float *u = malloc(dense_nodes(l->cells) * 16);
    uint32_t *flag = calloc(dense_nodes(l->cells), 4), *flags = calloc(lattice_items(l), 4),
             *list = malloc((l->n_active + 1) * 4);
    struct gpu_buffer *moves = NULL;
    assert_true(u && flag && flags && list);
    assert_ok(gpu_download(s->gpu, l->list, 0, list, l->n_active));
    for (size_t i = 0; i < l->n_active; i++)
        flags[list[i]] = 1;
    assert_ok(gpu_buffer_create(s->gpu, "moves", lattice_items(l), 4, &moves));
    assert_ok(gpu_upload(s->gpu, moves, 0, flags, lattice_items(l)));
    assert_ok(dense_download(s->gpu, l, moves, true, flag));
    assert_ok(dense_download(s->gpu, l, s->e.u, true, u));
    for (size_t i = 0; i < dense_nodes(l->cells); i++)
        u[4 * i + 3] = (float)flag[i];
    gpu_buffer_destroy(s->gpu, &moves);
    free(flag);
    free(flags);
    free(list);
    return u;
}

/* From one shape to another: nodes of both keep what they had, all others have 0. */
static void carries(struct solver *s, const struct box *box, size_t n_boxes)
{
    float *before = nodes_of(s);
    set_rock(s, box, n_boxes);
    float *after = nodes_of(s);
    size_t kept = 0, wrong = 0;
    for (size_t i = 0; i < dense_nodes(s->e.lattice.cells); i++) {
        const bool stays = before[4 * i + 3] != 0 && after[4 * i + 3] != 0;
        for (size_t c = 0; c < 3; c++) {
            const float expected = stays ? before[4 * i + c] : 0;
            wrong += memcmp(&after[4 * i + c], &expected, 4) != 0;
        }
        kept += stays;
    }
    assert_true(kept > 1000);
    assert_int_equal(wrong, 0);
    free(before);
    free(after);
}

static void rock_comes_and_goes(void **state)
{
    struct solver s = solver_of((int[]){48, 30, 22}, 2e-5), fresh = solver_of((int[]){48, 30, 22}, 2e-5);
    (void)state;
    set_rock(&s, table, TABLE);
    const uint64_t least = stress_taken(&s.e, true);
    solve(&s);
    carries(&s, table, MORE);
    solve(&s);
    set_rock(&fresh, table, MORE);
    solve(&fresh);
    assert_int_equal(s.e.lattice.n_active, fresh.e.lattice.n_active);
    float *t = field_of(&s, ROCK_stress), *expected = field_of(&fresh, ROCK_stress);
    const double error = stress_p95(t, expected, s.p.n) / stress_p95(expected, NULL, s.p.n);
    print_message("# T after rock was added is within %.2g of that of the same rock from nothing\n", error);
    assert_true(error < 1e-4);
    free(t);
    free(expected);
    /* And back. */
    carries(&s, table, TABLE);
    solve(&s);
    carries(&s, table + 2, 1); /* nothing holds it: what is not joined to the ground is not taken out here */
    assert_ok(elastic_clear(s.gpu, &s.e));
    assert_int_equal(s.e.lattice.n_active, 0);
    assert_true(stress_taken(&s.e, true) < least / 5); /* the table of the whole grid */
    /* From nothing again: the first frame's bits. */
    set_rock(&fresh, table + 2, 0);
    assert_int_equal(fresh.e.lattice.n_active, 0);
    set_rock(&fresh, table, TABLE);
    set_rock(&s, table, TABLE);
    solve(&s);
    solve(&fresh);
    t = field_of(&s, ROCK_stress);
    expected = field_of(&fresh, ROCK_stress);
    assert_memory_equal(t, expected, s.p.n * sizeof *t);
    free(t);
    free(expected);
    end(&s);
    end(&fresh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_in_a_larger_box),
        cmocka_unit_test(takes_what_is_planned),
        cmocka_unit_test(rock_comes_and_goes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
