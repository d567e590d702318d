/* Kernels against plain C twins: stress, normals, surface, blocks, erodibility, and the distance field
 * against a sphere. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "blocks/blocks.h"
#include "erosion/erosion.h"
#include "field/field.h"
#include "physics/model_help.h"
#include "stress/elastic.h"
#include "tests/ref/elastic_ref.h"
#include "tests/ref/rock_ref.h"
#include "tests/ref/stress_dense.h"

static uint32_t noise(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (word >> 22) ^ word;
}

/* 0 <= x < 1 */
static float chance(uint32_t *state)
{
    return (float)(noise(state) >> 8) / 16777216.0f;
}

static struct gpu_buffer *buffer_of(struct gpu *gpu, const void *data, size_t n, size_t item)
{
    struct gpu_buffer *b = NULL;
    assert_ok(gpu_buffer_create(gpu, "test", n, item, &b));
    if (data)
        assert_ok(gpu_upload(gpu, b, 0, data, n));
    return b;
}

static struct gpu *open_gpu(void)
{
    struct gpu *gpu = NULL;
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &gpu));
    return gpu;
}

/* ---- stress */

static void stress_agrees_with_quadrature(void **state)
{
    struct elastic_grid g = {{9, 8, 7}, 12e9, 15e9, 0.7};
    size_t n_cells = elastic_ref_cell(&g, 0, 0, g.cells[2]),
           n_nodes = elastic_ref_node(&g, 0, 0, g.cells[2] + 1), n = 0;
    float *fill = calloc(n_cells, sizeof *fill), *u = calloc(n_nodes, 16), *image = calloc(n_nodes, 16);
    float *normal = calloc(n_cells, 16), *shear = calloc(n_cells, 16), *product = calloc(n_nodes, 4);
    uint32_t *list = calloc(n_nodes, 4), *place = calloc(n_nodes, 4), random = 1;
    double *force = calloc(4 * n_nodes, sizeof *force);
    struct gpu *gpu = open_gpu();
    struct gpu_work *work = NULL;
    struct stress_lattice lattice;
    (void)state;
    assert_ok(gpu_work_create(gpu, 4 * n_nodes, &work));
    assert_ok(dense_create(gpu, work, g.cells, &lattice));
    for (int k = 1; k < g.cells[2]; k++)
        for (int j = 1; j < g.cells[1]; j++)
            for (int i = 1; i < g.cells[0]; i++) {
                /* Some cells are empty, some nearly. */
                float share = chance(&random) * 1.4f - 0.2f;
                if (i < g.cells[0] - 1 && j < g.cells[1] - 1 && k < g.cells[2] - 1)
                    fill[elastic_ref_cell(&g, i, j, k)] = fminf(fmaxf(share, 0), 1);
                place[n] = dense_place(g.cells, i, j, k);
                list[n++] = (uint32_t)elastic_ref_node(&g, i, j, k);
            }
    for (size_t i = 0; i < n_nodes; i++)
        for (size_t c = 0; c < 3; c++)
            u[4 * i + c] = chance(&random) - 0.5f;
    const size_t items = lattice_items(&lattice);
    struct gpu_buffer *b_list = buffer_of(gpu, place, n, 4), *b_u = buffer_of(gpu, NULL, items, 16),
                      *b_q = buffer_of(gpu, NULL, n_nodes, 16), *b_product = buffer_of(gpu, NULL, n_nodes, 4),
                      *b_normal = buffer_of(gpu, NULL, items, 16), *b_shear = buffer_of(gpu, NULL, items, 16);
    assert_ok(dense_upload(gpu, &lattice, b_u, true, u));
    assert_ok(dense_upload(gpu, &lattice, lattice.fill, false, fill));
    struct stress_params params = {.n = (uint)n,
                                   .cx = (uint)g.cells[0],
                                   .cy = (uint)g.cells[1],
                                   .cz = (uint)g.cells[2],
                                   .lambda = (float)g.lambda,
                                   .mu = (float)g.mu,
                                   .dx = (float)g.dx};
    GPU_RUN(gpu, stress_matvec, n, params, b_list, lattice.run, lattice.table, b_u, lattice.fill, b_q,
            b_product);
    params.n = (uint)items;
    GPU_RUN(gpu, stress_recover, items, params, lattice.run, lattice.table, b_u, lattice.fill, b_normal,
            b_shear, b_product);
    assert_ok(gpu_download(gpu, b_q, 0, image, n));
    assert_ok(gpu_download(gpu, b_product, 0, product, n));
    assert_ok(dense_download(gpu, &lattice, b_normal, false, normal));
    assert_ok(dense_download(gpu, &lattice, b_shear, false, shear));

    double most = 0, worst = 0, worst_product = 0;
    elastic_ref_apply(&g, fill, u, force);
    for (size_t i = 0; i < 4 * n_nodes; i++)
        most = fmax(most, fabs(force[i]));
    for (size_t i = 0; i < n; i++) {
        double energy = 0;
        for (size_t c = 0; c < 3; c++) {
            worst = fmax(worst, fabs((double)image[4 * i + c] - force[4 * list[i] + c]) / most);
            energy += force[4 * list[i] + c] * (double)u[4 * list[i] + c];
        }
        worst_product = fmax(worst_product, fabs((double)product[i] - energy) / most);
    }
    print_message("# K u differs by %.2g, u . K u by %.2g of the largest force\n", worst, worst_product);
    assert_true(worst < 1e-5 && worst_product < 1e-5);

    double largest = 0, error = 0;
    for (int k = 0; k < g.cells[2]; k++)
        for (int j = 0; j < g.cells[1]; j++)
            for (int i = 0; i < g.cells[0]; i++) {
                size_t c = elastic_ref_cell(&g, i, j, k);
                double s[6] = {0};
                if (fill[c] > 0)
                    elastic_ref_stress(&g, u, i, j, k, s);
                double expected[8] = {
                    s[0],
                    s[1],
                    s[2],
                    -(s[0] + s[1] + s[2]),
                    s[3],
                    s[4],
                    s[5],
                    sqrt(0.5 * (pow(s[0] - s[1], 2) + pow(s[1] - s[2], 2) + pow(s[2] - s[0], 2)) +
                         3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]))};
                for (size_t e = 0; e < 8; e++) {
                    double got = (double)(e < 4 ? normal[4 * c + e] : shear[4 * c + e - 4]);
                    largest = fmax(largest, fabs(expected[e]));
                    error = fmax(error, fabs(got - expected[e]));
                }
            }
    print_message("# stress differs by %.2g of the largest\n", error / largest);
    assert_true(error < 1e-5 * largest);

    struct gpu_buffer **all[] = {&b_list, &b_u, &b_q, &b_product, &b_normal, &b_shear};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(gpu, all[i]);
    lattice_destroy(gpu, &lattice);
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
    free(fill);
    free(u);
    free(image);
    free(normal);
    free(shear);
    free(product);
    free(list);
    free(place);
    free(force);
}

/* ---- rock */

struct bed {
    struct gpu *gpu;
    struct gpu_work *work;
    struct particles p;
    struct rock rock; /* as on the device, in its order */
    int n[3];
    double h;
};

/* A particle somewhere in each voxel for which `inside` (of its middle, in voxels) holds. */
static struct bed bed_of(const int n[3], double h,
                         int (*inside)(const int n[3], double x, double y, double z, uint32_t *random),
                         uint32_t seed)
{
    struct bed bed = {.gpu = open_gpu(), .n = {n[0], n[1], n[2]}, .h = h};
    size_t voxels = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    struct rock rock;
    uint32_t random = seed;
    assert_ok(rock_alloc(&rock, voxels, STATE));
    rock.n = 0;
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++) {
                if (!inside(n, i + 0.5, j + 0.5, k + 0.5, &random))
                    continue;
                int v[3] = {i, j, k};
                for (size_t a = 0; a < 3; a++)
                    rock.P[4 * rock.n + a] = (float)(h * (v[a] + 0.2 + 0.6 * (double)chance(&random)));
                rock.id[rock.n] = (uint32_t)rock.n;
                rock.viability[rock.n] = 0.4f + 0.6f * chance(&random);
                rock.rate_factor[rock.n] = chance(&random);
                rock.interlock_factor[rock.n] = 0.5f + chance(&random);
                rock.layer[rock.n] = noise(&random) % 2;
                rock.n++;
            }
    assert_ok(gpu_work_create(bed.gpu, voxels + 2, &bed.work));
    assert_ok(particles_create(bed.gpu, bed.work, &rock, STATE, n, h, &bed.p));
    assert_ok(particles_surface(bed.gpu, bed.work, &bed.p));
    assert_ok(particles_download(bed.gpu, &bed.p, DERIVED, &bed.rock));
    rock_free(&rock);
    return bed;
}

static void bed_end(struct bed *bed)
{
    rock_free(&bed->rock);
    particles_destroy(bed->gpu, &bed->p);
    gpu_work_destroy(bed->gpu, &bed->work);
    gpu_destroy(&bed->gpu);
}

static int in_boulder(const int n[3], double x, double y, double z, uint32_t *random)
{
    (void)random;
    double dx = x - 0.5 * n[0], dy = y - 0.5 * n[1], dz = z - 0.3 * n[2];
    return dx * dx + 1.4 * dy * dy + dz * dz < 0.16 * n[0] * n[0] && z < 0.55 * n[2];
}

static int in_rubble(const int n[3], double x, double y, double z, uint32_t *random)
{
    (void)n;
    (void)x;
    (void)y;
    (void)z;
    return chance(random) < 0.78f;
}

static void surface_and_normals_agree(void **state)
{
    struct bed bed = bed_of((int[]){24, 22, 20}, 0.4, in_boulder, 3);
    uint8_t *rock = rock_ref_voxels(&bed.rock, bed.n, bed.h);
    size_t n_bare = 0, n_close = 0, n_distinct = 0;
    (void)state;
    for (size_t i = 0; i < bed.rock.n; i++) {
        const float *N = &bed.rock.N[4 * i];
        double normal[3], margin;
        int bare = rock_ref_bare(rock, bed.n, bed.h, &bed.rock.P[4 * i]);
        n_bare += (size_t)bare;
        assert_true(bare == (N[0] != 0 || N[1] != 0 || N[2] != 0));
        if (!bare)
            continue;
        rock_ref_normal(&bed.rock, i, 20, bed.h, normal, &margin);
        double cosine = (double)N[0] * normal[0] + (double)N[1] * normal[1] + (double)N[2] * normal[2];
        double angle = acos(fmin(cosine, 1)) * 57.29578;
        n_close += angle < 5;
        /* Where the 20th and the 21st neighbour are apart by more than the kernel's bins, the sets are the
         * same. */
        if (margin > 0.03) {
            n_distinct++;
            if (angle > 0.5)
                print_message("# particle %zu: %.2f degrees, margin %.3f\n", i, angle, margin);
            assert_true(angle < 0.5);
        }
    }
    assert_int_equal(n_bare, bed.p.n_surface);
    print_message("# %zu of %zu normals within 5 degrees; %zu with one set of neighbours, all the same\n",
                  n_close, n_bare, n_distinct);
    assert_true(n_distinct > n_bare / 4);
    assert_true((double)n_close > 0.95 * (double)n_bare);
    free(rock);
    bed_end(&bed);
}

static bool all_around(const uint8_t *rock, const int n[3], int i, int j, int k)
{
    for (int c = 0; c < 27; c++) {
        const int v[3] = {i + c % 3 - 1, j + c / 3 % 3 - 1, k + c / 9 - 1};
        if (v[2] < 0)
            continue; /* below the ground is more rock */
        for (int a = 0; a < 3; a++)
            if (v[a] < 0 || v[a] >= n[a])
                return false;
        if (!rock[((size_t)v[2] * (size_t)n[1] + (size_t)v[1]) * (size_t)n[0] + (size_t)v[0]])
            return false;
    }
    return true;
}

/* Lumps of a few voxels, whole; of those with rock all around, most are to be deep. Bits of these. */
static struct rock lumps(const int n[3], double h, uint32_t seed, uint32_t *deep, size_t *n_deep)
{
    struct rock rock;
    uint32_t random = seed;
    const size_t voxels = (size_t)n[0] * (size_t)n[1] * (size_t)n[2], across = ((size_t)n[0] + 31) / 32;
    uint8_t *is = calloc(voxels, 1);
    float lump[4096];
    for (size_t i = 0; i < 4096; i++)
        lump[i] = chance(&random);
    assert_ok(rock_alloc(&rock, voxels, STATE));
    rock.n = *n_deep = 0;
    for (size_t v = 0; v < voxels; v++) {
        const size_t at[3] = {v % (size_t)n[0], v / (size_t)n[0] % (size_t)n[1],
                              v / (size_t)n[0] / (size_t)n[1]};
        is[v] = lump[at[0] / 5 + 16 * (at[1] / 4) + 128 * (at[2] / 4)] < 0.55f;
    }
    for (size_t v = 0; v < voxels; v++) {
        const size_t at[3] = {v % (size_t)n[0], v / (size_t)n[0] % (size_t)n[1],
                              v / (size_t)n[0] / (size_t)n[1]};
        if (!is[v])
            continue;
        for (size_t a = 0; a < 3; a++)
            rock.P[4 * rock.n + a] = (float)(h * ((double)at[a] + 0.5));
        rock.id[rock.n] = (uint32_t)rock.n;
        rock.viability[rock.n++] = 1;
        if (all_around(is, n, (int)at[0], (int)at[1], (int)at[2]) && chance(&random) < 0.9f) {
            deep[(at[2] * (size_t)n[1] + at[1]) * across + at[0] / 32] |= 1U << at[0] % 32;
            ++*n_deep;
        }
    }
    free(is);
    return rock;
}

static bool bit_at(const uint32_t *bits, const int n[3], double h, const float P[3])
{
    const size_t v[3] = {(size_t)((double)P[0] / h), (size_t)((double)P[1] / h), (size_t)((double)P[2] / h)};
    return bits[(v[2] * (size_t)n[1] + v[1]) * (((size_t)n[0] + 31) / 32) + v[0] / 32] >> v[0] % 32 & 1;
}

/* Those of `all` whose voxel's bit is as `is`. */
static struct rock pick(const struct rock *all, const uint32_t *bits, const int n[3], double h, bool is)
{
    struct rock out;
    assert_ok(rock_alloc(&out, all->n, STATE));
    out.n = 0;
    for (size_t i = 0; i < all->n; i++) {
        if (bit_at(bits, n, h, &all->P[4 * i]) != is)
            continue;
        memcpy(&out.P[4 * out.n], &all->P[4 * i], 4 * sizeof *out.P);
        out.id[out.n] = all->id[i];
        out.viability[out.n++] = all->viability[i];
    }
    return out;
}

/* Rock that has no particles holds as if it had, and what of it falls is found, run by run. */
static void deep_rock_holds_as_particles_do(void **state)
{
    static const int n[3] = {75, 30, 31};
    const double h = 0.5;
    size_t cut_in_all = 0;
    (void)state;
    for (uint32_t seed = 1; seed <= 6; seed++) {
        const size_t words = held_words(n);
        uint32_t *deep = calloc(words, 4), *cut = calloc(words, 4), n_fallen;
        struct gpu *gpu = open_gpu();
        struct gpu_work *work;
        struct particles p;
        struct blocks blocks;
        size_t n_deep, n_cut, expected = 0, falling = 0;
        struct rock all = lumps(n, h, seed, deep, &n_deep), some = pick(&all, deep, n, h, false), missing;
        uint8_t *falls = rock_ref_falls(&all, n, h);
        assert_ok(gpu_work_create(gpu, voxel_count(n) + 2, &work));
        assert_ok(particles_create(gpu, work, &some, STATE, n, h, &p));
        assert_ok(particles_set_deep(gpu, work, &p, deep, n_deep));
        assert_ok(blocks_create(gpu, p.held.n, NULL, &blocks));
        assert_ok(blocks_find(gpu, work, &blocks, &p, &n_cut));
        if (n_cut)
            assert_ok(particles_due(gpu, work, &p, DUE_CHOSEN, cut, &n_cut));
        for (size_t i = 0; i < all.n; i++) {
            const bool is = bit_at(deep, n, h, &all.P[4 * i]);
            expected += is && falls[i];
            falling += falls[i];
            assert_int_equal(bit_at(cut, n, h, &all.P[4 * i]), is && falls[i]);
        }
        assert_int_equal(n_cut, expected);
        if (n_cut) {
            missing = pick(&all, cut, n, h, true);
            assert_ok(particles_reserve(gpu, &p, p.n + missing.n));
            assert_ok(particles_add(gpu, work, &p, &missing));
            rock_free(&missing);
            assert_ok(blocks_find(gpu, work, &blocks, &p, &n_cut));
            assert_int_equal(n_cut, 0);
        }
        assert_ok(blocks_fall(gpu, work, &blocks, &p, &n_fallen));
        assert_int_equal(n_fallen, falling);
        print_message("# %zu of %zu fall; %zu were deep, %zu of them fall\n", falling, all.n, n_deep,
                      expected);
        cut_in_all += expected;
        blocks_destroy(gpu, &blocks);
        particles_destroy(gpu, &p);
        gpu_work_destroy(gpu, &work);
        gpu_destroy(&gpu);
        rock_free(&all);
        rock_free(&some);
        free(falls);
        free(deep);
        free(cut);
    }
    assert_true(cut_in_all > 0);
}

static void the_same_blocks_fall(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 6; seed++) {
        struct bed bed = bed_of((int[]){20, 18, 16}, 0.5, seed % 2 ? in_rubble : in_boulder, seed);
        struct blocks blocks;
        uint32_t n_fallen = 0;
        size_t n_cut;
        uint8_t *falls = rock_ref_falls(&bed.rock, bed.n, bed.h);
        float *viability = malloc(bed.rock.n * sizeof *viability);
        size_t expected = 0;
        assert_ok(blocks_create(bed.gpu, bed.p.held.n, NULL, &blocks));
        assert_ok(blocks_find(bed.gpu, bed.work, &blocks, &bed.p, &n_cut));
        assert_int_equal(n_cut, 0);
        assert_ok(blocks_fall(bed.gpu, bed.work, &blocks, &bed.p, &n_fallen));
        assert_ok(gpu_download(bed.gpu, bed.p.field[ROCK_viability], 0, viability, bed.rock.n));
        for (size_t i = 0; i < bed.rock.n; i++) {
            assert_int_equal(falls[i], viability[i] == 0);
            expected += falls[i];
        }
        assert_int_equal(n_fallen, expected);
        print_message("# %zu of %zu particles fall\n", expected, bed.rock.n);
        free(falls);
        free(viability);
        blocks_destroy(bed.gpu, &blocks);
        bed_end(&bed);
    }
}

static void erodibility_jumps_where_grains_interlock(void **state)
{
    const float layer[2][8] = {{0.2f, 0.002f, 1e6f}, {0.05f, 0, 0.5e6f}};
    (void)state;
    for (int smooth = 0; smooth < 2; smooth++) {
        struct bed bed = bed_of((int[]){16, 16, 16}, 0.5, in_rubble, 5);
        struct interlock_params k = {(uint)bed.p.n, smooth ? 0.6f : 0.0f};
        uint32_t random = 9;
        float *stress = malloc(bed.p.n * sizeof *stress), *got = malloc(bed.p.n * sizeof *got);
        for (size_t i = 0; i < bed.p.n; i++)
            stress[i] = 2.5e6f * chance(&random) - 0.5e6f;
        assert_ok(gpu_upload(bed.gpu, bed.p.field[ROCK_stress], 0, stress, bed.p.n));
        struct gpu_buffer *layers = buffer_of(bed.gpu, layer, 4, 16);
        GPU_RUN(bed.gpu, erosion_interlock, bed.p.n, k, layers, bed.p.field[ROCK_layer],
                bed.p.field[ROCK_rate_factor], bed.p.field[ROCK_interlock_factor], bed.p.field[ROCK_stress],
                bed.p.field[ROCK_phase], bed.p.field[ROCK_erodibility]);
        assert_ok(gpu_download(bed.gpu, bed.p.field[ROCK_erodibility], 0, got, bed.p.n));
        for (size_t i = 0; i < bed.p.n; i++) {
            const float *l = layer[bed.rock.layer[i]];
            double expected =
                rock_ref_retreat((double)l[0], (double)l[1], (double)(l[2] * bed.rock.interlock_factor[i]),
                                 (double)bed.rock.rate_factor[i], (double)stress[i], (double)k.band);
            assert_true(fabs((double)got[i] - expected) <= 1e-5 * fmax(expected, 1e-3));
        }
        free(stress);
        free(got);
        gpu_buffer_destroy(bed.gpu, &layers);
        bed_end(&bed);
    }
}

/* ---- the surface field */

static void distance_to_a_sphere(void **state)
{
    const double center[3] = {8, 8.13, 4.2}, radius = 5.1;
    struct sim s =
        sim_begin("hoodoo: 1\nname: ball\nframes: 1-2\ndomain: {size_m: [16, 16, 12], spacing_m: 0.25}\n"
                  "scene: {sphere: {center_m: [8, 8.13, 4.2], radius_m: 5.1}}\n");
    struct frame frame = sim_output(&s);
    const struct frame_grids *grids = &frame.grids;
    const struct grid_lattice *g = &grids->lattice;
    const struct frame_grid *phi = &grids->grid[0];
    size_t near = 0, within = 0, band = 0;
    double worst = 0, mean = 0, slope = 0, steepest = 0, flattest = 9;
    (void)state;
    for (int k = 1; k < g->n[2] - 1; k++)
        for (int j = 1; j < g->n[1] - 1; j++)
            for (int i = 1; i < g->n[0] - 1; i++) {
                double x[3] = {g->origin[0] + i * g->voxel, g->origin[1] + j * g->voxel,
                               g->origin[2] + k * g->voxel};
                double exact =
                    sqrt(pow(x[0] - center[0], 2) + pow(x[1] - center[1], 2) + pow(x[2] - center[2], 2)) -
                    radius;
                if (x[2] < 2.5) /* away from the ground, on which it stands cut off */
                    continue;
                if (fabs(exact) < 0.5 * g->voxel) {
                    double error = fabs((double)grid_at(grids, phi, i, j, k) - exact) / g->voxel;
                    worst = fmax(worst, error);
                    mean += error;
                    within += error < 0.1;
                    near++;
                }
                if (fabs(exact) < 1.5 * g->voxel) {
                    double sum = 0;
                    for (int a = 0; a < 3; a++) {
                        const int dx = a == 0, dy = a == 1, dz = a == 2;
                        sum += pow((double)(grid_at(grids, phi, i + dx, j + dy, k + dz) -
                                            grid_at(grids, phi, i - dx, j - dy, k - dz)) /
                                       (2 * g->voxel),
                                   2);
                    }
                    slope += sqrt(sum);
                    steepest = fmax(steepest, sqrt(sum));
                    flattest = fmin(flattest, sqrt(sum));
                    band++;
                }
            }
    print_message("# near the surface it is off by %.3f voxels on average, %.3f at most; |grad| is %.3f "
                  "(%.2f .. %.2f)\n",
                  mean / (double)near, worst, slope / (double)band, flattest, steepest);
    assert_true(near > 500);
    assert_true(mean / (double)near < 0.05 && worst < 0.12);
    assert_true((double)within > 0.99 * (double)near);
    assert_true(fabs(slope / (double)band - 1) < 0.05);
    assert_true(flattest > 0.85 && steepest < 1.15);
    frame_free(&frame);
    sim_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stress_agrees_with_quadrature),
        cmocka_unit_test(surface_and_normals_agree),
        cmocka_unit_test(the_same_blocks_fall),
        cmocka_unit_test(deep_rock_holds_as_particles_do),
        cmocka_unit_test(erodibility_jumps_where_grains_interlock),
        cmocka_unit_test(distance_to_a_sphere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
