/* Deposits: round cones at the angle of repose, without steps of the grid; over edges; the same bits. Every
 * crumb is accounted for in every frame (heap_step). */
#include "heap.h"
#include "model_help.h"

#include "../ref/slope_ref.h"

static const double pi = 3.14159265358979323846;

static int odd_ones(int n, int k)
{
    return n & (1 << k) ? 1 : 0;
}

/* n crumbs fall somewhere into the box. */
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

/* Crumbs from one place onto a plain. */
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
            "# repose %g: %.1f along the axes, %.1f along the diagonals (%d frames of %d crumbs; %u "
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
    print_message("# %d crumbs lie on the shelf, %d below its edge (x = 16), from x = %d on; %llu left\n",
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

/* Mean distance of deposits from the block's axis, mean height over the plain, m. */
static void spread_of(const struct frame *frame, double *radius, double *height)
{
    double n = 0;
    *radius = *height = 0;
    for (size_t i = 0; i < frame->rock.n; i++) {
        const float *P = &frame->rock.P[4 * i];
        if (frame->rock.phase[i] != 1)
            continue;
        *radius += hypot((double)P[0] - 20, (double)P[1] - 20);
        *height += (double)P[2] - 2.5;
        n++;
    }
    *radius /= n;
    *height /= n;
}

static void weaker_deposits_spread_wider_and_thinner(void **state)
{
    enum { FRAMES = 24 };
    double radius[2], height[2];
    uint64_t rock[2], left[2];
    (void)state;
    for (int b = 0; b < 2; b++) {
        struct sim s = crumbling(b ? 0.15 : 1);
        uint64_t most = 0;
        for (int f = 0; f < FRAMES; f++) {
            assert_ok(model_step(s.model));
            struct frame frame = sim_output(&s);
            const struct ledger *l = &frame.ledger;
            assert_int_equal(l->start, l->rock + l->deposit + l->fallen + l->left);
            assert_int_equal(frame.rock.n, l->rock + l->deposit);
            most = l->deposit > most ? l->deposit : most;
            if (f + 1 == FRAMES) {
                spread_of(&frame, &radius[b], &height[b]);
                rock[b] = l->rock;
                left[b] = l->left;
                print_message(
                    "# viability %g: of %llu, rock %llu, deposits %llu (%llu at most), fallen %llu, left "
                    "%llu; deposits %.2f m off, %.2f m high\n",
                    b ? 0.15 : 1.0, (unsigned long long)l->start, (unsigned long long)l->rock,
                    (unsigned long long)l->deposit, (unsigned long long)most, (unsigned long long)l->fallen,
                    (unsigned long long)l->left, radius[b], height[b]);
            }
            frame_free(&frame);
        }
        assert_true(most > 2000);
        sim_end(&s);
    }
    assert_true(radius[1] > 1.1 * radius[0] && height[1] < 0.9 * height[0]);
    assert_true(left[1] > left[0] && rock[1] < rock[0]); /* they erode again, and shield less */
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
        cmocka_unit_test(weaker_deposits_spread_wider_and_thinner),
        cmocka_unit_test(a_resumed_run_has_the_same_deposits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
