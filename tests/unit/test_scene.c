/* Scenes: shapes have the volume they should, wherever they stand; operators obey their algebra; particles
 * come out in order, in their voxels, the same for every number of threads. */
#include <omp.h>

#include "particles/held.h"
#include "scene_help.h"

/* ---- volumes */

static void a_box_has_its_volume_wherever_it_stands(void **state)
{
    (void)state;
    struct job_node on_voxels = BOX(.min_m = {4, 4, 4}, .max_m = {12, 14, 16});
    assert_close(volume_of(&on_voxels, 40, 0.5), 8 * 10 * 12, 1e-12);
    struct job_node between = BOX(.min_m = {4.137, 4.211, 4.31}, .max_m = {12.47, 14.02, 16.33});
    assert_close(volume_of(&between, 40, 0.5), 8.333 * 9.809 * 12.02, 0.005);
    struct job_node placed = BOX(.min_m = {-1, -1, -1}, .max_m = {1, 1, 1}, .scale = {4, 3, 5},
                                 .rotate_deg = {31, -17, 64}, .translate_m = {10.1, 10.2, 9.7});
    assert_close(volume_of(&placed, 40, 0.5), 8 * 10 * 6, 0.005);
}

static void a_thin_slab_of_any_height_keeps_its_volume(void **state)
{
    (void)state;
    for (int i = 0; i < 50; i++) {
        struct job_node slab = BOX(.min_m = {0, 0, 0}, .max_m = {8, 8, 1 + i * 0.0237});
        assert_close(volume_of(&slab, 8, 1), 64 * (1 + i * 0.0237), 0.01);
    }
}

static void round_shapes_have_their_volume(void **state)
{
    (void)state;
    struct job_node sphere = SPHERE(.center_m = {10.1, 9.8, 10.3}, .radius_m = 7.3);
    assert_close(volume_of(&sphere, 40, 0.5), 4.0 / 3 * M_PI * 7.3 * 7.3 * 7.3, 0.005);
    struct job_node egg =
        SPHERE(.radius_m = 1, .scale = {8, 4, 6}, .rotate_deg = {10, 20, 30}, .translate_m = {10, 10, 10});
    assert_close(volume_of(&egg, 40, 0.5), 4.0 / 3 * M_PI * 8 * 4 * 6, 0.005);
    struct job_node cylinder = CYLINDER(.from_m = {4, 5, 6}, .to_m = {14, 13, 15}, .radius_m = 3.1);
    assert_close(volume_of(&cylinder, 40, 0.5), M_PI * 3.1 * 3.1 * sqrt(100 + 64 + 81), 0.005);
    struct job_node cone =
        CYLINDER(.from_m = {10, 10, 2}, .to_m = {10, 10, 18}, .radius_m = 7, .top_radius_m = 0);
    assert_close(volume_of(&cone, 40, 0.5), M_PI * 49 * 16 / 3, 0.005);
    struct job_node stump =
        CYLINDER(.from_m = {10, 3, 9}, .to_m = {11, 17, 10}, .radius_m = 2, .top_radius_m = 6);
    assert_close(volume_of(&stump, 40, 0.5), M_PI / 3 * sqrt(1 + 196 + 1) * (4 + 12 + 36), 0.005);
}

static void a_plane_cuts_the_domain(void **state)
{
    (void)state;
    struct job_node flat = PLANE(.point_m = {0, 0, 7.3}, .normal = {0, 0, 12});
    assert_close(volume_of(&flat, 40, 0.5), 20 * 20 * 7.3, 0.005);
    struct job_node corner = PLANE(.point_m = {10, 10, 10}, .normal = {1e-3, 1e-3, 1e-3});
    assert_close(volume_of(&corner, 40, 0.5), 4000, 0.005);
}

/* The order is scale, turn about x, then y, then z, then move; a group's comes after its children's. */
static void placements_follow_their_order(void **state)
{
    (void)state;
    struct job_node box = BOX(.min_m = {0, 0, 0}, .max_m = {1, 1, 1}, .scale = {1, 2, 3},
                              .rotate_deg = {90, 0, 90}, .translate_m = {10, 20, 30});
    struct job_node group = GROUP(NODE_UNION, &box);
    group.u.group.translate_m[0] = 100;
    struct solid *solid;
    assert_int_equal(solid_create(&group, 1, 1, &solid), OK);
    /* x: (x, y, z) -> (x, -z, y), then z: (x, y, z) -> (-y, x, z); so the corner (1, 2, 3) goes to (3, 1, 2).
     */
    double min[3], max[3];
    solid_bounds(solid, min, max);
    const double expected_min[3] = {110, 20, 30}, expected_max[3] = {113, 21, 32};
    for (int a = 0; a < 3; a++) {
        assert_close(min[a], expected_min[a], 1e-12);
        assert_close(max[a], expected_max[a], 1e-12);
    }
    assert_true(solid_at(solid, (const double[]){112.9, 20.9, 31.9}).distance < 0);
    assert_true(solid_at(solid, (const double[]){112.9, 21.1, 31.9}).distance > 0);
    solid_destroy(&solid);
}

/* ---- distances and operators */

static struct job_node *some_shapes(void)
{
    static struct job_node s[4];
    s[0] = BOX(.min_m = {2, 3, 1}, .max_m = {9, 8, 7}, .rotate_deg = {20, 30, 40}, .scale = {1, 1.4, 0.8});
    s[1] = SPHERE(.center_m = {6, 6, 6}, .radius_m = 3.3);
    s[2] = CYLINDER(.from_m = {1, 2, 3}, .to_m = {9, 8, 7}, .radius_m = 2, .top_radius_m = 0.5);
    s[3] = PLANE(.point_m = {5, 5, 5}, .normal = {1, -2, 0.5});
    return s;
}

static struct solid *made(const struct job_node *node)
{
    struct solid *solid;
    assert_int_equal(solid_create(node, 0.5, 5, &solid), OK);
    return solid;
}

static void random_point(uint32_t *x, double p[3])
{
    for (int a = 0; a < 3; a++)
        p[a] = next_random(x) % 100000 * 1.2e-4 - 1;
}

/* |d(p) - d(q)| <= |p - q|: what makes one distance settle a whole brick. */
static void distances_never_overstate(void **state)
{
    (void)state;
    struct job_node *s = some_shapes();
    struct job_node all = GROUP(NODE_UNION, &s[0], &s[1], &s[2]), cut = GROUP(NODE_DIFFERENCE, &all, &s[3]);
    struct job_node *nodes[] = {&s[0], &s[1], &s[2], &s[3], &all, &cut};
    uint32_t x = 1;
    for (size_t n = 0; n < sizeof nodes / sizeof *nodes; n++) {
        struct solid *solid = made(nodes[n]);
        for (int i = 0; i < 20000; i++) {
            double p[3], q[3];
            random_point(&x, p);
            random_point(&x, q);
            double apart = sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                                (p[2] - q[2]) * (p[2] - q[2]));
            double change = fabs(solid_at(solid, p).distance - solid_at(solid, q).distance);
            assert_true(change <= apart * (1 + 1e-9) + 1e-12);
        }
        solid_destroy(&solid);
    }
}

static void operators_obey_their_algebra(void **state)
{
    (void)state;
    struct job_node *s = some_shapes(), *a = &s[0], *b = &s[1], *c = &s[2];
    struct job_node ab = GROUP(NODE_UNION, a, b), ba = GROUP(NODE_UNION, b, a), aa = GROUP(NODE_UNION, a, a);
    struct job_node a_and_b = GROUP(NODE_INTERSECTION, a, b), less = GROUP(NODE_DIFFERENCE, a, b, c);
    struct job_node bc = GROUP(NODE_UNION, b, c), less_both = GROUP(NODE_DIFFERENCE, a, &bc);
    struct job_node none = GROUP(NODE_DIFFERENCE, a, a);
    struct job_node *nodes[] = {a, b, c, &ab, &ba, &aa, &a_and_b, &less, &less_both, &none};
    struct solid *solid[10];
    for (int i = 0; i < 10; i++)
        solid[i] = made(nodes[i]);
    uint32_t x = 99;
    for (int i = 0; i < 50000; i++) {
        double p[3];
        int in[10];
        random_point(&x, p);
        for (int n = 0; n < 10; n++)
            in[n] = solid_at(solid[n], p).distance <= 0;
        assert_int_equal(in[3], in[0] || in[1]);
        assert_int_equal(in[4], in[3]);
        assert_int_equal(in[5], in[0]);
        assert_int_equal(in[6], in[0] && in[1]);
        assert_int_equal(in[7], in[0] && !in[1] && !in[2]);
        assert_int_equal(in[8], in[7]);
        assert_int_equal(in[9], 0);
    }
    for (int i = 0; i < 10; i++)
        solid_destroy(&solid[i]);
}

static void inert_reaches_everything_below(void **state)
{
    (void)state;
    struct job_node soft = BOX(.min_m = {0, 0, 2}, .max_m = {4, 4, 6}),
                    hard = BOX(.min_m = {0, 0, 0}, .max_m = {4, 4, 3});
    struct job_node inner = GROUP(NODE_UNION, &hard), all = GROUP(NODE_UNION, &soft, &inner);
    inner.u.group.inert = true;
    struct solid *solid = made(&all);
    assert_int_equal(solid_at(solid, (const double[]){1, 1, 1}).inert, 1);
    assert_int_equal(solid_at(solid, (const double[]){1, 1, 2.5}).inert, 1); /* in both */
    assert_int_equal(solid_at(solid, (const double[]){1, 1, 4}).inert, 0);
    assert_int_equal(solid_at(solid, (const double[]){4.1, 1, 1}).inert, 1); /* outside: the nearest part */
    assert_int_equal(solid_at(solid, (const double[]){4.1, 1, 5}).inert, 0);
    solid_destroy(&solid);
    struct job_node cut = GROUP(NODE_DIFFERENCE, &soft, &inner),
                    both = GROUP(NODE_INTERSECTION, &soft, &inner);
    solid = made(&cut);
    assert_int_equal(solid_at(solid, (const double[]){1, 1, 4}).inert, 0);
    solid_destroy(&solid);
    solid = made(&both);
    assert_int_equal(solid_at(solid, (const double[]){1, 1, 2.5}).inert, 1);
    solid_destroy(&solid);
}

static void shapes_without_an_inside_are_refused(void **state)
{
    (void)state;
    struct solid *solid;
    struct job_node box = BOX(.min_m = {0, 1, 0}, .max_m = {1, 1, 1});
    assert_failed(solid_create(&box, 1, 1, &solid), E_USAGE, "box", "on y");
    struct job_node plane = PLANE(.normal = {0, 0, 0});
    assert_failed(solid_create(&plane, 1, 1, &solid), E_USAGE, "normal", "plane");
    struct job_node cylinder = CYLINDER(.from_m = {1, 1, 1}, .to_m = {1, 1, 1}, .radius_m = 1);
    assert_failed(solid_create(&cylinder, 1, 1, &solid), E_USAGE, "cylinder", "from_m");
    struct job_node sphere = SPHERE(.radius_m = 1), bad = GROUP(NODE_UNION, &sphere, &box);
    assert_failed(solid_create(&bad, 1, 1, &solid), E_USAGE, "box", "on y");
    struct job_node empty = {.kind = NODE_UNION, .u.group = {PLACED}};
    assert_failed(solid_create(&empty, 1, 1, &solid), E_USAGE, "operator", "");
    assert_failed(solid_create(NULL, 1, 1, &solid), E_USAGE, "no shape", "");
}

/* ---- sampling */

static void voxels_are_even_and_cover_the_domain(void **state)
{
    (void)state;
    int n[3];
    struct job job = {.domain = {.size_m = {60, 24, 48}, .spacing_m = 0.5}};
    assert_int_equal(scene_voxels(&job, n), OK);
    assert_true(n[0] == 120 && n[1] == 48 && n[2] == 96);
    job.domain = (struct job_domain){.size_m = {1.0000005, 1.1, 0.001}, .spacing_m = 0.1};
    assert_int_equal(scene_voxels(&job, n), OK);
    assert_true(n[0] == 10 && n[1] == 12 && n[2] == 2);
    job.domain = (struct job_domain){.size_m = {0.6, 1.8, 5.4}, .spacing_m = 0.3};
    assert_int_equal(scene_voxels(&job, n), OK);
    assert_true(n[0] == 2 && n[1] == 6 && n[2] == 18);
    /* A voxel's number fits into 32 bits, also where rows end within a word of bits. */
    job.domain = (struct job_domain){.size_m = {1600, 1600, 1676}, .spacing_m = 1};
    assert_int_equal(scene_voxels(&job, n), OK);
    assert_true(32 * held_words(n) <= UINT32_MAX && voxel_count(n) > UINT32_MAX - 5120000);
    job.domain.size_m[2] = 1678;
    assert_failed(scene_voxels(&job, n), E_USAGE, "2^32", "spacing_m");
    job.domain = (struct job_domain){.size_m = {1602, 1600, 1666}, .spacing_m = 1};
    assert_failed(scene_voxels(&job, n), E_USAGE, "2^32", "spacing_m");
    job.domain = (struct job_domain){.size_m = {1e6, 1e6, 1e6}, .spacing_m = 1e-4};
    assert_failed(scene_voxels(&job, n), E_USAGE, "2^32", "spacing_m");
}

static void particles_come_in_order_inside_their_voxels(void **state)
{
    (void)state;
    struct job_node a = SPHERE(.center_m = {5, 5, 4}, .radius_m = 4.5);
    struct job job = cube_job(&a, 20, 0.5);
    struct rock rock;
    assert_int_equal(scene_sample(&job, &rock), OK);
    double volume = 0, moved[3] = {0}, square = 0;
    long last = -1;
    for (size_t p = 0; p < rock.n; p++) {
        long voxel[3];
        for (int c = 0; c < 3; c++) {
            double x = (double)rock.P[4 * p + (size_t)c] / 0.5, off;
            voxel[c] = (long)floor(x);
            off = x - (double)voxel[c] - 0.5;
            assert_true(fabs(off) <= 0.4001);
            moved[c] += off;
            square += off * off;
        }
        long number = (voxel[2] * 20 + voxel[1]) * 20 + voxel[0];
        assert_true(number > last);
        last = number;
        assert_int_equal(rock.id[p], p);
        assert_true(rock.P[4 * p + 3] == 0 && rock.phase[p] == 0 && rock.layer[p] == 0);
        assert_true(rock.rate_factor[p] == 1 && rock.interlock_factor[p] == 1);
        assert_true(rock.viability[p] >= 1.0f / 64 && rock.viability[p] <= 1);
        volume += (double)rock.viability[p] * 0.125;
    }
    /* A ball of radius 4.5 whose lowest half metre is below the ground. */
    assert_close(volume, M_PI / 3 * (4 * 91.125 - 0.25 * (3 * 4.5 - 0.5)), 0.005);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(moved[c] / (double)rock.n) < 0.02);
    assert_close(square / (3 * (double)rock.n), 0.25 / 12, 0.05);
    assert_null(rock.stress);
    rock_free(&rock);
}

static void threads_do_not_show(void **state)
{
    (void)state;
    struct job_node *s = some_shapes();
    struct job_node all = GROUP(NODE_UNION, &s[0], &s[1], &s[2]),
                    ground = BOX(.min_m = {0, 0, 0}, .max_m = {9, 9, 2});
    struct job_node scene = GROUP(NODE_UNION, &all, &ground);
    struct job job = cube_job(&scene, 40, 0.25);
    struct job_paint paint = {
        .shape = &s[1], .falloff_m = 2, .erodibility = 3, .interlock = 0.5, .viability = 0.7};
    job.noise.amplitude = 0.5;
    job.paint = &paint;
    job.n_paint = 1;
    struct rock rock[2];
    for (int t = 0; t < 2; t++) {
        omp_set_num_threads(t + 1);
        assert_int_equal(scene_sample(&job, &rock[t]), OK);
    }
    assert_int_equal(rock[0].n, rock[1].n);
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (rock_field_table[f].keep == STATE &&
            (rock[0].field[f] || rock[1].field[f])) /* not all jobs have all */
            assert_memory_equal(rock[0].field[f], rock[1].field[f],
                                rock[0].n * rock_field_size((enum rock_field)f));
    job.seed = 8;
    rock_free(&rock[1]);
    assert_int_equal(scene_sample(&job, &rock[1]), OK);
    assert_int_equal(rock[0].n, rock[1].n);
    assert_memory_not_equal(rock[0].P, rock[1].P, rock[0].n * 16);
    assert_memory_equal(rock[0].viability, rock[1].viability, 64);
    rock_free(&rock[0]);
    rock_free(&rock[1]);
}

static void layers_go_by_height(void **state)
{
    (void)state;
    struct job_node all = BOX(.min_m = {0, 0, 0}, .max_m = {8, 8, 8});
    struct job job = cube_job(&all, 16, 0.5);
    struct job_layer strata[3] = {{.to_m = 2.2, .noise_amplitude = -1},
                                  {.to_m = 5, .noise_amplitude = -1},
                                  {.to_m = 6, .noise_amplitude = -1}};
    job.strata = strata;
    job.n_strata = 3;
    struct rock rock;
    assert_int_equal(scene_sample(&job, &rock), OK);
    assert_int_equal(rock.n, 16 * 16 * 16);
    for (size_t p = 0; p < rock.n; p++) {
        double z = (double)rock.P[4 * p + 2];
        assert_int_equal(rock.layer[p], z < 2.2 ? 0 : z < 5 ? 1 : 2);
    }
    rock_free(&rock);
}

static void inert_and_paint_reach_the_particles(void **state)
{
    (void)state;
    struct job_node rock_box = BOX(.min_m = {0, 0, 4}, .max_m = {16, 16, 16});
    struct job_node foot = BOX(.min_m = {0, 0, 0}, .max_m = {16, 16, 4}, .inert = true);
    struct job_node scene = GROUP(NODE_UNION, &rock_box, &foot);
    struct job_node left = BOX(.min_m = {0, 0, 0}, .max_m = {4, 16, 16}),
                    top = BOX(.min_m = {0, 0, 12}, .max_m = {16, 16, 16});
    struct job_node cap = BOX(.min_m = {12, 12, 12}, .max_m = {16, 16, 16});
    struct job_paint paint[3] = {
        {.shape = &left, .falloff_m = 4, .erodibility = 5, .interlock = 2, .viability = 0.5},
        {.shape = &top, .erodibility = 3, .interlock = 1, .viability = 1},
        {.shape = &cap, .erodibility = 1, .interlock = 1, .viability = 1, .inert = true},
    };
    struct job job = cube_job(&scene, 16, 1);
    job.paint = paint;
    job.n_paint = 3;
    struct rock rock;
    assert_int_equal(scene_sample(&job, &rock), OK);
    assert_int_equal(rock.n, 16 * 16 * 16);
    for (size_t p = 0; p < rock.n; p++) {
        double x = (double)rock.P[4 * p], y = (double)rock.P[4 * p + 1], z = (double)rock.P[4 * p + 2];
        double t = fmin(fmax(1 - (x - 4) / 4, 0), 1), w = t * t * (3 - 2 * t);
        double rate = z < 12 ? 1 + 4 * w : 3; /* the later entry covers the earlier */
        rate /= 1 - 0.5 * w;                  /* a shorter life, and no less rock */
        if (z < 4 || (x > 12 && y > 12 && z > 12))
            rate = 0;
        assert_true(fabs((double)rock.rate_factor[p] - rate) < 1e-5);
        assert_true(fabs((double)rock.interlock_factor[p] - (1 + w)) < 1e-5); /* 1 covers nothing */
        assert_true(rock.viability[p] == 1);
    }
    rock_free(&rock);
}

static void nothing_to_erode_is_an_error(void **state)
{
    (void)state;
    struct rock rock;
    struct job_node away = BOX(.min_m = {70, 0, 0}, .max_m = {80, 4, 4});
    struct job job = cube_job(&away, 16, 1);
    assert_failed(scene_sample(&job, &rock), E_USAGE, "no rock in the domain", "x 70 to 80");
    assert_int_equal(rock.n, 0);
    struct job_node high = BOX(.min_m = {2, 2, 5.5}, .max_m = {9, 9, 9});
    job.scene = &high;
    assert_failed(scene_sample(&job, &rock), E_USAGE, "floats in the air", "z = 5 m");
    struct scene_size size;
    assert_int_equal(scene_estimate(&job, &size), OK);
    assert_int_equal(size.n_particles, 7 * 7 * 4);
    assert_int_equal(size.n_points, 7 * 7 * 4);
    assert_int_equal(size.n_surface, 7 * 7 * 4 - 5 * 5 * 2);
    free(size.point);
}

static void estimates_are_close(void **state)
{
    (void)state;
    struct job_node a = SPHERE(.center_m = {5, 5, 4}, .radius_m = 4.5);
    struct job job = cube_job(&a, 150, 10.0 / 150);
    struct rock rock;
    struct scene_size size;
    assert_int_equal(scene_sample(&job, &rock), OK);
    assert_int_equal(scene_estimate(&job, &size), OK);
    assert_close((double)size.n_particles, (double)rock.n, 0.01);
    free(size.point);
    rock_free(&rock);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_has_its_volume_wherever_it_stands),
        cmocka_unit_test(a_thin_slab_of_any_height_keeps_its_volume),
        cmocka_unit_test(round_shapes_have_their_volume),
        cmocka_unit_test(a_plane_cuts_the_domain),
        cmocka_unit_test(placements_follow_their_order),
        cmocka_unit_test(distances_never_overstate),
        cmocka_unit_test(operators_obey_their_algebra),
        cmocka_unit_test(inert_reaches_everything_below),
        cmocka_unit_test(shapes_without_an_inside_are_refused),
        cmocka_unit_test(voxels_are_even_and_cover_the_domain),
        cmocka_unit_test(particles_come_in_order_inside_their_voxels),
        cmocka_unit_test(threads_do_not_show),
        cmocka_unit_test(layers_go_by_height),
        cmocka_unit_test(inert_and_paint_reach_the_particles),
        cmocka_unit_test(nothing_to_erode_is_an_error),
        cmocka_unit_test(estimates_are_close),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
