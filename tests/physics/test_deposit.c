/* Deposits: round cones at the angle of repose, without steps of the grid; over edges; the same bits. Every
 * fragment is accounted for in every frame (heap_step). */
#include "heap.h"
#include "model_help.h"
#include "surface.h"

#include "../ref/heap_ref.h"
#include "../ref/slope_ref.h"
#include "field/field.h"

static const double pi = 3.14159265358979323846;

static int odd_ones(int n, int k)
{
    return n & (1 << k) ? 1 : 0;
}

/* n fragments fall somewhere into the box. */
static void rain_down(struct heap *p, const int low[3], const int high[3], int n)
{
    uint32_t ids[512];
    size_t first = heap_grow(p, (size_t)n);
    for (int i = 0; i < n; i++) {
        uint32_t hash = random_hash(3, (uint32_t)p->frame, (uint32_t)i, 0);
        ids[i] = heap_set(p, first + (size_t)i, low[0] + (int)(hash & 255) % (high[0] - low[0]),
                          low[1] + (int)(hash >> 8 & 255) % (high[1] - low[1]),
                          low[2] + (int)(hash >> 16 & 255) % (high[2] - low[2]));
    }
    heap_step(p, ids, (size_t)n, 1);
}

/* Fragments from one place onto a plain. */
static struct heap pour(double repose, int frames, int per_frame, int unshifted)
{
    const int n[3] = {64, 64, 48};
    struct heap p = heap_begin(n, 0.5, repose);
    p.unshifted = unshifted;
    heap_box(&p, (int[]){0, 0, 0}, (int[]){64, 64, 2});
    for (int f = 0; f < frames; f++)
        rain_down(&p, (int[]){30, 30, 40}, (int[]){34, 34, 44}, per_frame);
    return p;
}

/* The slope of a cone's columns within 10 degrees of an azimuth and the three at right angles to it, degrees:
 * least squares over the radius, from a quarter to four fifths of the foot's. */
static double flank(const struct heap *p, const int *height, double azimuth)
{
    double foot = 0, n = 0, sr = 0, sz = 0, srr = 0, srz = 0;
    for (int c = 0; c < 64 * 64; c++)
        foot += height[c] > 2;
    foot = sqrt(foot / pi);
    for (int y = 0; y < p->n[1]; y++)
        for (int x = 0; x < p->n[0]; x++) {
            double dx = x + 0.5 - 32, dy = y + 0.5 - 32, r = hypot(dx, dy), a = atan2(dy, dx) - azimuth,
                   z = height[y * p->n[0] + x];
            a -= pi / 2 * round(a / (pi / 2));
            if (fabs(a) > 10 * pi / 180 || r < 0.25 * foot || r > 0.8 * foot)
                continue;
            n++, sr += r, sz += z, srr += r * r, srz += r * z;
        }
    return -atan((n * srz - sr * sz) / (n * srr - sr * sr)) * 180 / pi;
}

static void cones_have_the_angle_of_repose_all_round(void **state)
{
    (void)state;
    static const struct {
        double repose;
        int frames, per_frame;
    } of[] = {{25, 40, 120}, {34, 50, 150}, {34, 80, 40}, {40, 50, 180}};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        struct heap p = pour(of[i].repose, of[i].frames, of[i].per_frame, 0);
        int *z = heap_heights(&p);
        double axes = flank(&p, z, 0), diagonals = flank(&p, z, pi / 4);
        print_message(
            "# repose %g: %.1f along the axes, %.1f along the diagonals (%d frames of %d fragments; %u "
            "rounds at most; %llu slid, %llu left)\n",
            of[i].repose, axes, diagonals, of[i].frames, of[i].per_frame, p.most_rounds,
            (unsigned long long)p.slid, (unsigned long long)p.left);
        assert_true(fabs(axes - of[i].repose) <= 2 && fabs(diagonals - of[i].repose) <= 2);
        assert_true(p.left < 0.02 * of[i].frames * of[i].per_frame);
        free(z);
        heap_end(&p);
    }
}

static void a_slope_below_a_cliff_has_it_too(void **state)
{
    const int n[3] = {64, 64, 48};
    struct heap p = heap_begin(n, 0.5, 34);
    double mean[64] = {0};
    int low = 10, high = 12;
    (void)state;
    heap_box(&p, (int[]){0, 0, 0}, (int[]){64, 64, 2});
    heap_box(&p, (int[]){0, 0, 2}, (int[]){8, 64, 36});
    for (int f = 0; f < 40; f++)
        rain_down(&p, (int[]){8, 0, 40}, (int[]){10, 64, 44}, 200);
    int *z = heap_heights(&p);
    for (int x = 0; x < 64; x++)
        for (int y = 20; y < 44; y++)
            mean[x] += z[y * 64 + x] / 24.0;
    while (mean[high] > 4)
        high++;
    double slope = atan((mean[low] - mean[high]) / (high - low)) * 180 / pi;
    print_message("# below a cliff: %.1f, over %d columns\n", slope, high - low);
    assert_true(fabs(slope - 34) <= 2);
    free(z);
    heap_end(&p);
}

/* The share of a cone's descent that lies between columns 2 k - 1 and 2 k of either axis, where a grid of cells
 * that does not move has its seams; and of its columns, those with even heights. */
static void seams(const struct heap *p, double *descent, double *even)
{
    int *z = heap_heights(p);
    double at[2] = {0}, n[2] = {0};
    for (int y = 1; y < 64; y++)
        for (int x = 1; x < 64; x++) {
            int here = z[y * 64 + x];
            at[x & 1] += abs(here - z[y * 64 + x - 1]);
            at[y & 1] += abs(here - z[y * 64 + x - 64]);
            if (here > 2)
                n[here & 1]++;
        }
    *descent = at[0] / (at[0] + at[1]);
    *even = n[0] / (n[0] + n[1]);
    free(z);
}

static void cells_leave_no_steps(void **state)
{
    double descent, even, still_descent, still_even;
    (void)state;
    struct heap p = pour(34, 50, 120, 0), still = pour(34, 50, 120, 1);
    seams(&p, &descent, &even);
    seams(&still, &still_descent, &still_even);
    print_message("# descent at seams of cells: %.3f of it (0.5: no seams; %.3f on a grid that keeps still); "
                  "even heights: %.3f of the columns (%.3f)\n",
                  descent, still_descent, even, still_even);
    assert_true(fabs(descent - 0.5) < 0.025 && fabs(even - 0.5) < 0.05);
    assert_true(still_descent - 0.5 > 0.025); /* or this would say nothing */
    heap_end(&p);
    heap_end(&still);
}

static uint8_t *solid_voxels(const struct heap *p)
{
    uint8_t *solid = calloc((size_t)p->n[0] * (size_t)p->n[1] * (size_t)p->n[2], 1);
    for (size_t i = 0; i < p->rock.n; i++) {
        const float *P = &p->rock.P[4 * i];
        int v[3];
        for (int a = 0; a < 3; a++)
            v[a] = (int)((double)P[a] / p->h);
        uint8_t *s = &solid[(v[2] * p->n[1] + v[1]) * p->n[0] + v[0]];
        assert_int_equal(*s, 0); /* one particle a voxel */
        *s = p->rock.phase[i] == 1 ? 2 : 1;
    }
    return solid;
}

static void crumbs_fall_over_an_edge_and_lie_on_what_is_below(void **state)
{
    const int n[3] = {48, 32, 40};
    struct heap p = heap_begin(n, 0.5, 34);
    int shelf = 0, ground = 0, first = 48;
    (void)state;
    heap_box(&p, (int[]){0, 0, 0}, (int[]){48, 32, 2});
    heap_box(&p, (int[]){0, 0, 2}, (int[]){6, 32, 30});
    heap_box(&p, (int[]){6, 0, 18}, (int[]){16, 32, 20});
    for (int f = 0; f < 30; f++)
        rain_down(&p, (int[]){6, 4, 32}, (int[]){9, 28, 36}, 60);
    uint8_t *solid = solid_voxels(&p);
    for (size_t i = 0; i < p.rock.n; i++) {
        const float *P = &p.rock.P[4 * i];
        int x = (int)((double)P[0] / p.h), y = (int)((double)P[1] / p.h), z = (int)((double)P[2] / p.h);
        if (p.rock.phase[i] != 1)
            continue;
        assert_true(solid[((z - 1) * n[1] + y) * n[0] + x] != 0);
        if (z >= 20)
            shelf++;
        else {
            ground++;
            first = x < first ? x : first;
        }
    }
    print_message("# %d fragments lie on the shelf, %d below its edge (x = 16), from x = %d on; %llu left\n",
                  shelf, ground, first, (unsigned long long)p.left);
    assert_true(shelf > 300 && ground > 300 && first >= 2);
    free(solid);
    heap_end(&p);
}

static void room_is_what_plain_c_finds(void **state)
{
    const int n[3] = {40, 36, 30};
    size_t cells = 0, open = 0, differ = 0;
    (void)state;
    for (uint32_t scene = 0; scene < 4; scene++) {
        struct heap p = heap_begin(n, 0.5, 25 + 5 * (double)scene);
        p.job.seed = scene;
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++) {
                uint32_t hash = random_hash(scene, (uint32_t)x, (uint32_t)y, 5);
                int top = 7 + (int)(4 * sin(0.3 * x) * cos(0.23 * y + scene)) + odd_ones((int)hash, 3) +
                          odd_ones((int)hash, 5);
                heap_box(&p, (int[]){x, y, 0}, (int[]){x + 1, y + 1, top});
                if (x > 20 && y > 10 && y < 24) /* a roof with holes */
                    heap_box(&p, (int[]){x, y, 18}, (int[]){x + 1, y + 1, 18 + (int)(hash >> 8) % 3});
            }
        uint8_t *solid = solid_voxels(&p);
        uint32_t id = heap_set(&p, heap_grow(&p, 1), 10, 10, 26);
        heap_step(&p, &id, 1, 1);
        assert_int_equal(p.last.landed, 1); /* in the last round: the ground was the same in all */
        size_t all = (size_t)p.way.cells[0] * (size_t)p.way.cells[1] * (size_t)p.way.cells[2];
        uint32_t *room = malloc(all * sizeof *room);
        assert_ok(gpu_download(p.gpu, p.deposit.room, 0, room, all));
        for (size_t c = 0; c < all; c++) {
            unsigned expected =
                slope_ref_room(solid, n, &p.way, c, p.job.deposition.repose_deg, DEPOSIT_ROOM);
            cells += (p.way.tag[c] & (WATER_KIND | WATER_OUT)) == WATER_SURF;
            open += expected > 0;
            differ += room[c] != expected;
        }
        free(room);
        free(solid);
        heap_end(&p);
    }
    print_message("# room in %zu of %zu cells of the ground; the kernel differs in %zu\n", open, cells,
                  differ);
    assert_true(open > 200 && cells - open > 200);
    assert_true(differ <= cells / 1000); /* slopes within rounding of the threshold */
}

static void threads_change_no_bit(void **state)
{
    static const char *const threads[] = {"0", "1", "2"};
    struct rock first = {0};
    (void)state;
    for (int t = 0; t < 3; t++) {
        setenv("LP_NUM_THREADS", threads[t], 1);
        struct heap p = pour(34, 6, 150, 0);
        unsetenv("LP_NUM_THREADS");
        if (t == 0) {
            first = p.rock;
            p.rock = (struct rock){0};
        } else {
            assert_int_equal(p.rock.n, first.n);
            for (int f = 0; f < ROCK_FIELDS; f++)
                if (first.field[f])
                    assert_memory_equal(p.rock.field[f], first.field[f],
                                        first.n * rock_field_size((enum rock_field)f));
        }
        heap_end(&p);
    }
    rock_free(&first);
}

/* Of rock that erodes the fines leave, and what is coarse takes more room. Deposits that break off again have no fines. */
static void the_wind_takes_the_fines(void **state)
{
    const int n[3] = {64, 64, 48};
    (void)state;
    struct heap p = heap_begin(n, 0.5, 34);
    p.job.deposition.fines = 0.4;
    p.job.deposition.bulking = 1.2;
    heap_box(&p, (int[]){0, 0, 0}, (int[]){64, 64, 2});
    const size_t rock = p.rock.n;
    for (int f = 0; f < 20; f++)
        rain_down(&p, (int[]){24, 24, 40}, (int[]){40, 40, 44}, 200);
    const double lie = (double)(p.rock.n - rock) / (20 * 200);
    const uint64_t left = p.left;
    uint32_t ids[100];
    size_t n_ids = 0;
    for (size_t i = p.rock.n; i-- > 0 && n_ids < 100;) /* from the top */
        if (p.rock.phase[i] == PHASE_DEPOSIT)
            ids[n_ids++] = p.rock.id[i];
    heap_step(&p, ids, n_ids, 0);
    print_message("# %.3f of the fragments came to rest, of 0.72; of %zu deposits that broke off %llu left\n",
                  lie, n_ids, (unsigned long long)(p.left - left));
    assert_true(fabs(lie - 0.72) < 0.03); /* four standard deviations */
    assert_int_equal(p.left, left);
    heap_end(&p);
}

/* A cone by the wall of a house, partly weathered. */
static struct heap beside_a_wall(void)
{
    const int n[3] = {48, 40, 40};
    struct heap p = heap_begin(n, 0.5, 34);
    heap_box(&p, (int[]){0, 0, 0}, (int[]){48, 40, 2});
    heap_box(&p, (int[]){4, 4, 2}, (int[]){20, 36, 20});
    heap_box(&p, (int[]){20, 10, 12}, (int[]){26, 30, 14}); /* a roof */
    for (int f = 0; f < 30; f++)
        rain_down(&p, (int[]){20, 16, 16}, (int[]){28, 24, 30}, 120);
    for (size_t i = 0; i < p.rock.n; i++)
        p.rock.viability[i] = 1 - 0.5f * (float)(random_hash(9, p.rock.id[i], 0, 0) & 1023) / 1024;
    return p;
}

static size_t voxels_of(const struct heap *p)
{
    return (size_t)p->n[0] * (size_t)p->n[1] * (size_t)p->n[2];
}

/* What fills each voxel: 1 deposits, below 0 rock. */
static float *loose_of(const struct heap *p)
{
    float *loose = calloc(voxels_of(p), sizeof *loose);
    for (size_t i = 0; i < p->rock.n; i++) {
        const float *P = &p->rock.P[4 * i];
        size_t v = 0;
        for (int a = 2; a >= 0; a--)
            v = v * (size_t)p->n[a] + (size_t)((double)P[a] / p->h);
        loose[v] = p->rock.phase[i] == PHASE_DEPOSIT ? 1 : -p->rock.viability[i];
    }
    return loose;
}

/* The share of each voxel that the kernels find filled; -1 where they keep none. */
static float *share_shown(struct heap *p)
{
    struct particles rock;
    struct field f;
    float *out = calloc(voxels_of(p), sizeof *out);
    for (size_t v = 0; v < voxels_of(p); v++)
        out[v] = -1;
    assert_ok(particles_create(p->gpu, p->work, &p->rock, STATE, p->n, p->h, &rock));
    assert_ok(field_create(p->gpu, p->n, p->h, &f));
    f.whole = true;
    /* Voxels without particles, beside those that have some. */
    assert_ok(particles_hold_around(p->gpu, p->work, &rock));
    assert_ok(field_build(p->gpu, p->work, &f, &rock, 34));
    uint32_t *list = calloc(f.n_bricks, sizeof *list);
    float *share = calloc(f.n_bricks * BRICK_SAMPLES, sizeof *share);
    assert_ok(gpu_download(p->gpu, f.list, 0, list, f.n_bricks));
    assert_ok(gpu_download(p->gpu, f.share, 0, share, f.n_bricks * BRICK_SAMPLES));
    const unsigned across[2] = {((unsigned)f.n[0] + 7) / 8, ((unsigned)f.n[1] + 7) / 8};
    for (size_t i = 0; i < f.n_bricks * BRICK_SAMPLES; i++) {
        const unsigned brick = list[i / BRICK_SAMPLES], s = (unsigned)(i % BRICK_SAMPLES);
        const int v[3] = {(int)(8 * (brick % across[0]) + (s & 7)) - FIELD_MARGIN,
                          (int)(8 * (brick / across[0] % across[1]) + (s >> 3 & 7)) - FIELD_MARGIN,
                          (int)(8 * (brick / (across[0] * across[1])) + (s >> 6)) - FIELD_MARGIN};
        if (v[0] < 0 || v[1] < 0 || v[2] < 0 || v[0] >= p->n[0] || v[1] >= p->n[1] || v[2] >= p->n[2])
            continue;
        out[((size_t)v[2] * (size_t)p->n[1] + (size_t)v[1]) * (size_t)p->n[0] + (size_t)v[0]] = share[i];
    }
    free(list);
    free(share);
    field_destroy(p->gpu, &f);
    particles_destroy(p->gpu, &rock);
    return out;
}

static void heaps_are_shown_as_plain_c_finds(void **state)
{
    struct heap p = beside_a_wall();
    (void)state;
    float *loose = loose_of(&p), *share = share_shown(&p),
          *want = heap_ref_share(loose, p.n, 34, HEAP_SWEEPS);
    double worst = 0, changed = 0;
    size_t n = 0;
    for (size_t v = 0; v < voxels_of(&p); v++)
        if (share[v] >= 0) {
            worst = fmax(worst, fabs((double)share[v] - (double)want[v]));
            n++;
        }
    float *as_they_lie = heap_ref_share(loose, p.n, 34, 0);
    for (size_t v = 0; v < voxels_of(&p); v++)
        changed += fabs((double)want[v] - (double)as_they_lie[v]) > 0.1;
    print_message(
        "# %zu samples; the kernels are within %.1e; what slides changes %g of them by more than 0.1\n", n,
        worst, changed);
    assert_true(n > 10000 && changed > 300);
    assert_true(worst < 1e-6);
    free(loose);
    free(share);
    free(want);
    free(as_they_lie);
    heap_end(&p);
}

/* A heap's surface is the same to the bit while rock weathers around it. */
static void heaps_are_shown_lying_still(void **state)
{
    struct heap p = beside_a_wall();
    (void)state;
    float *loose = loose_of(&p), *before = share_shown(&p);
    for (size_t i = 0; i < p.rock.n; i++)
        p.rock.viability[i] *= p.rock.phase[i] == PHASE_DEPOSIT ? 1 : 0.8f;
    float *after = share_shown(&p);
    size_t of_heaps = 0, stirred = 0, of_rock = 0;
    for (size_t v = 0; v < voxels_of(&p); v++)
        if (loose[v] > 0) {
            of_heaps++;
            stirred += before[v] != after[v];
        } else if (loose[v] < 0) {
            of_rock += before[v] != after[v];
        }
    print_message("# rock weathered: %zu of %zu samples of heaps changed, and %zu of rock\n", stirred,
                  of_heaps, of_rock);
    assert_true(of_heaps > 1000 && of_rock > 1000);
    assert_int_equal(stirred, 0);

    free(loose);
    free(before);
    free(after);
    heap_end(&p);
}

/* A block that crumbles on an inert plain. */
static struct sim crumbling(double viability)
{
    char text[1024];
    snprintf(text, sizeof text,
             "hoodoo: 1\n"
             "name: crumbling\n"
             "frames: 1-100\n"
             "clock: {years_per_frame: 800}\n"
             "domain: {size_m: [40, 40, 20], spacing_m: 0.625}\n"
             "scene:\n"
             "  union:\n"
             "    - box: {min_m: [0, 0, 0], max_m: [40, 40, 2.5], inert: true}\n"
             "    - box: {min_m: [15, 15, 2.5], max_m: [25, 25, 17.5]}\n"
             "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.02, interlock_MPa: 5}]\n"
             "wind: {abrasion: 0}\n"
             "deposition: {viability: %g}\n",
             viability);
    return sim_begin(text);
}

/* Where deposits lie, by id, and how much of their voxels they fill; 0 for all else. */
static float *deposits_by_id(const struct rock *rock, size_t n_ids)
{
    float *at = calloc(4 * n_ids, sizeof *at);
    for (size_t i = 0; i < rock->n; i++)
        if (rock->phase[i] == PHASE_DEPOSIT) {
            memcpy(&at[4 * rock->id[i]], &rock->P[4 * i], 3 * sizeof *at);
            at[4 * rock->id[i] + 3] = rock->viability[i];
        }
    return at;
}

/* The share of a frame's deposits that lie elsewhere than in the frame before, which *before has. */
static double moved(const struct frame *frame, float **before)
{
    const size_t n_ids = (size_t)frame->ledger.start;
    float *now = deposits_by_id(&frame->rock, n_ids);
    double n = 0, there = 0;
    for (size_t id = 0; *before && id < n_ids; id++)
        if ((*before)[4 * id + 3] > 0) {
            there++;
            n += memcmp(&(*before)[4 * id], &now[4 * id], 4 * sizeof *now) != 0;
        }
    free(*before);
    *before = now;
    return there > 0 ? n / there : 0;
}

/* Of the skin of deposits, farther than two voxels from rock and the domain's sides: the shares steeper than an angle, and
 * overhanging. */
static void skin_of(const struct frame *frame, double limit_deg, double *steep, double *overhanging,
                    size_t *n)
{
    const struct grid_lattice *l = &frame->grids.lattice;
    const struct frame_grid *phi = frame_grid_named(&frame->grids, "surface"),
                            *deposit = frame_grid_named(&frame->grids, "deposit");
    *steep = *overhanging = 0;
    *n = 0;
    for (int z = 6; z < l->n[2] - 6; z++)
        for (int y = 6; y < l->n[1] - 6; y++)
            for (int x = 6; x < l->n[0] - 6; x++) {
                double g[3], least = 1;
                if (fabs((double)grid_at(&frame->grids, phi, x, y, z)) >= 0.5 * l->voxel)
                    continue;
                for (int a = 0; a < 3; a++) {
                    const int d[3] = {a == 0, a == 1, a == 2};
                    g[a] = (double)grid_at(&frame->grids, phi, x + d[0], y + d[1], z + d[2]) -
                           (double)grid_at(&frame->grids, phi, x - d[0], y - d[1], z - d[2]);
                }
                for (int c = -2; c <= 2; c++)
                    for (int b = -2; b <= 2; b++)
                        for (int a = -2; a <= 2; a++)
                            if ((double)grid_at(&frame->grids, phi, x + a, y + b, z + c) < 0)
                                least =
                                    fmin(least, (double)grid_at(&frame->grids, deposit, x + a, y + b, z + c));
                if (least < 0.99)
                    continue;
                double slope = acos(g[2] / sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2])) * 180 / pi;
                *steep += slope > limit_deg;
                *overhanging += slope > 90;
                ++*n;
            }
    *steep /= (double)*n;
    *overhanging /= (double)*n;
}

/* Deposits have settled: few move in a frame, and none changes where it lies. They are shown at their angle, whatever
 * the voxels of their particles, and with the volume that these have. */
static void what_has_settled_stays(void **state)
{
    enum { FRAMES = 24 };
    struct sim s = crumbling(0.15);
    float *before = NULL;
    double most = 0, steep, overhanging;
    size_t n;
    (void)state;
    for (int f = 0; f < FRAMES; f++) {
        assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        const struct ledger *l = &frame.ledger;
        assert_int_equal(l->start, l->rock + l->deposit + l->fallen + l->left);
        assert_int_equal(frame.rock.n, l->rock + l->deposit);
        double share = moved(&frame, &before);
        if (f >= 8)
            most = fmax(most, share);
        if (f + 1 == FRAMES) {
            const struct surface shown = surface_of(&frame);
            skin_of(&frame, 34 + 5, &steep, &overhanging, &n);
            print_message("# %llu deposits; at most %.1f %% of them move in a frame. Of %zu samples of their "
                          "skin %.1f %% are steeper "
                          "than 39 degrees, %.2f %% overhang; %.1f m3 are shown of %.1f\n",
                          (unsigned long long)l->deposit, 100 * most, n, 100 * steep, 100 * overhanging,
                          shown.volume, frame.volume_m3);
            assert_true(l->deposit > 2000 && n > 300);
            assert_true(most < 0.03);
            assert_true(steep < 0.03 && overhanging == 0);
            assert_true(fabs(shown.volume - frame.volume_m3) < 0.01 * frame.volume_m3);
        }
        frame_free(&frame);
    }
    free(before);
    sim_end(&s);
}

static void a_resumed_run_has_the_same_deposits(void **state)
{
    struct sim s = crumbling(0.4);
    struct checkpoint half, whole, again;
    struct model *resumed;
    (void)state;
    for (int f = 0; f < 5; f++)
        assert_ok(model_step(s.model));
    assert_ok(model_save(s.model, &half));
    for (int f = 0; f < 4; f++)
        assert_ok(model_step(s.model));
    assert_ok(model_save(s.model, &whole));
    assert_ok(model_create(s.gpu, s.job, &half, &resumed));
    for (int f = 0; f < 4; f++)
        assert_ok(model_step(resumed));
    assert_ok(model_save(resumed, &again));
    assert_same_state(&whole, &again);
    model_destroy(&resumed);
    checkpoint_free(&half);
    checkpoint_free(&whole);
    checkpoint_free(&again);
    sim_end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(room_is_what_plain_c_finds),
        cmocka_unit_test(cones_have_the_angle_of_repose_all_round),
        cmocka_unit_test(a_slope_below_a_cliff_has_it_too),
        cmocka_unit_test(cells_leave_no_steps),
        cmocka_unit_test(crumbs_fall_over_an_edge_and_lie_on_what_is_below),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(the_wind_takes_the_fines),
        cmocka_unit_test(heaps_are_shown_as_plain_c_finds),
        cmocka_unit_test(heaps_are_shown_lying_still),
        cmocka_unit_test(what_has_settled_stays),
        cmocka_unit_test(a_resumed_run_has_the_same_deposits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
