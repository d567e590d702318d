/* Water's routing against a flood, Kruskal's tree and a serial sum, on porous rock and on scenes made by hand;
 * what rain and sources amount to. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "effort.h"
#include "gpu/kernel_source.h"
#include "physics/water_help.h"
#include "tests/ref/flow_ref.h"
#include "tests/ref/stream_ref.h"

struct routed {
    struct water water;
    struct flow_ref ref;
    uint32_t *tag, *z, *receiver, *node_cell, *rain;
};

static void routed_free(struct bed *bed, struct routed *r)
{
    water_destroy(bed->gpu, &r->water);
    flow_ref_free(&r->ref);
    free(r->tag);
    free(r->z);
    free(r->receiver);
    free(r->node_cell);
    free(r->rain);
}

static uint32_t *download(struct gpu *gpu, const struct gpu_buffer *b, size_t n)
{
    uint32_t *data = calloc(n + 1, 4);
    assert_non_null(data);
    assert_ok(gpu_download(gpu, b, 0, data, n));
    return data;
}

static struct routed route(struct bed *bed, int size, const struct water_routing *how, const struct job *job)
{
    struct routed r = {0};
    int shift[3];
    uint32_t random = water_random(how, shift);
    if (size == 1)
        memset(shift, 0, sizeof shift);
    assert_ok(water_create(bed->gpu, job, bed->n, bed->h, size, &r.water));
    assert_ok(water_route(bed->gpu, bed->work, &r.water, how, &bed->p));
    if (size == 1)
        assert_ok(water_discharge(bed->gpu, bed->work, &r.water, job, 1, &bed->p));
    r.ref = flow_ref_route(&bed->rock, bed->n, bed->h, size, shift, random, how->leak, job_walls(job));
    r.tag = download(bed->gpu, r.water.tag, r.ref.n);
    r.z = download(bed->gpu, r.water.z, r.ref.n);
    r.receiver = download(bed->gpu, r.water.receiver, r.ref.n);
    r.node_cell = download(bed->gpu, r.water.node[WATER_CELL], r.water.n_nodes);
    r.rain = download(bed->gpu, r.water.node[WATER_RAIN], r.water.n_nodes);
    return r;
}

struct tally {
    size_t scenes, cells, surfaces, dead, turned, longest;
};

/* Rain is split as the serial sum has it, over levels that a flood finds; and what falls leaves, or stays in a pit between
 * walls. */
static void check_rain(const struct bed *bed, const struct routed *r, bool leak, const uint32_t *level)
{
    const uint32_t whole = r->water.rain_units;
    uint64_t in = (uint64_t)bed->n[0] * (uint64_t)bed->n[1] * whole, out = 0;
    uint32_t *rain = flow_ref_split(&r->ref, level, bed->n, leak, whole);
    uint32_t *levels = download(bed->gpu, r->water.node[WATER_LEVEL], r->water.n_nodes);
    for (size_t i = 0; i < r->water.n_nodes; i++) {
        uint32_t c = r->node_cell[i];
        assert_int_equal(r->rain[i], rain[c]);
        assert_int_equal(levels[i], level[c] == UINT32_MAX ? r->ref.altitude[c] : level[c]);
        out += r->tag[c] & WATER_OUT || (r->tag[c] & WATER_DEAD && r->receiver[c] == c) ? r->rain[i] : 0;
    }
    assert_int_equal(out, in);
    free(rain);
    free(levels);
}

/* Every claim of water.h for one scene. */
static void check_routing(struct bed *bed, const struct routed *r, bool leak, struct tally *t)
{
    const struct flow_ref *f = &r->ref;
    uint32_t *level = flow_ref_levels(f, leak);
    for (int a = 0; a < 3; a++)
        assert_int_equal(r->water.cells[a], f->cells[a]);
    for (size_t c = 0; c < f->n; c++) {
        uint32_t kind = r->tag[c] & WATER_KIND;
        bool open = kind == WATER_EMPTY || kind == WATER_SURF, dead = (r->tag[c] & WATER_DEAD) != 0;
        assert_int_equal(r->tag[c], f->tag[c]);
        assert_int_equal(r->z[c], f->z[c]);
        assert_int_equal(r->receiver[c], f->receiver[c]); /* Kruskal's forest, to the bit */
        t->turned += r->receiver[c] != f->initial[c];
        t->surfaces += kind == WATER_SURF;
        t->dead += dead && open;
        if (open)
            assert_int_equal(level[c] == UINT32_MAX, dead);
        if (dead || kind == WATER_SOLID)
            continue;
        /* It gets out, over the lowest passes there are. */
        uint32_t highest = f->altitude[c];
        size_t at = c, hops = 0;
        for (; !(r->tag[at] & WATER_OUT); at = r->receiver[at]) {
            highest = f->altitude[at] > highest ? f->altitude[at] : highest;
            assert_true(++hops <= f->n);
        }
        highest = f->altitude[at] > highest ? f->altitude[at] : highest;
        t->longest = hops > t->longest ? hops : t->longest;
        if (open)
            assert_int_equal(highest, level[c]);
    }
    if (f->size == 1)
        check_rain(bed, r, leak, level);
    t->scenes++;
    t->cells += f->n;
    free(level);
}

/* Holes of a few voxels, more or fewer, below a rough surface. */
static float porous(const struct scene *s, int i, int j, int k)
{
    double share = 0.15 + 0.7 * unit(s->seed, 1), top = s->n[2] * (0.3 + 0.8 * unit(s->seed, 2));
    int size = 1 + (int)(s->seed % 4);
    uint32_t at = random_hash((uint32_t)(i / size), (uint32_t)(j / size), (uint32_t)(k / size), s->seed);
    double rough = 3 * unit(random_hash((uint32_t)(i / 3), (uint32_t)(j / 3), 7, s->seed), 3);
    if (random_float(at) > share || k > top + rough)
        return 0;
    return 0.05f + 0.95f * random_float(random_hash(at, (uint32_t)i, (uint32_t)j, (uint32_t)k));
}

static void porous_rock_drains_over_its_lowest_passes(void **state)
{
    struct gpu *gpu = open_gpu();
    struct job job;
    struct tally t = {0};
    double year = 0.5;
    (void)state;
    job_of_rain(&job, &year);
    for (uint32_t s = 0; s < 220; s++) {
        if (!effort_takes(s))
            continue;
        struct scene scene = {.n = {10 + 2 * (int)(s % 13), 8 + 2 * (int)(s % 17), 4 + 2 * (int)(s % 11)},
                              .seed = 1000 + s};
        if (s % 55 == 54)
            scene.n[2] = 140; /* columns of three words */
        /* Open sides; one wall; all but one; all. */
        job.domain.sides = (struct job_sides){.x_min = s % 4 > 0 ? SIDE_X_MIN_WALL : SIDE_X_MIN_OPEN,
                                              .x_max = s % 4 > 2 ? SIDE_X_MAX_WALL : SIDE_X_MAX_OPEN,
                                              .y_min = s % 4 > 1 ? SIDE_Y_MIN_WALL : SIDE_Y_MIN_OPEN,
                                              .y_max = s % 4 > 1 ? SIDE_Y_MAX_WALL : SIDE_Y_MAX_OPEN};
        struct bed bed = bed_of(gpu, &scene, 0.5, porous);
        for (int leak = 0; leak < 2; leak++) {
            struct water_routing how = {
                .seed = s, .frame = 1, .leak = leak, .unshifted = s % 5 == 0, .cells = true};
            struct routed r = route(&bed, 1 + (int)(s % 2), &how, &job);
            check_routing(&bed, &r, leak, &t);
            routed_free(&bed, &r);
        }
        bed_free(&bed);
    }
    gpu_destroy(&gpu);
    print_message(
        "# %zu scenes, %zu cells, %zu SURF, %zu in cavities, %zu receivers turned round, longest way "
        "out %zu: levels, receivers and sums as the oracle's\n",
        t.scenes, t.cells, t.surfaces, t.dead, t.turned, t.longest);
    assert_true((double)t.scenes >= 400 * fmin(effort(), 1) && t.dead > 100 && t.turned > 1000 &&
                t.longest > 20);
}

/* ---- by hand */

static uint32_t cell_at(const struct routed *r, int x, int y, int z)
{
    return (uint32_t)((z * r->ref.cells[1] + y) * r->ref.cells[0] + x);
}

static struct routed by_hand(struct bed *bed, struct gpu *gpu, scene_fill *fill, bool leak,
                             const struct job *job)
{
    struct scene scene = {.n = {24, 16, 24}};
    struct water_routing how = {.seed = 5, .frame = 1, .leak = leak, .unshifted = true, .cells = true};
    struct tally t = {0};
    *bed = bed_of(gpu, &scene, 0.5, fill);
    struct routed r = route(bed, 2, &how, job);
    check_routing(bed, &r, leak, &t);
    return r;
}

/* A table on one leg. */
static float overhang(const struct scene *s, int i, int j, int k)
{
    (void)s;
    return k < 4 || (i >= 8 && i < 10 && j >= 6 && j < 10 && k < 14) ||
           (i >= 6 && i < 18 && j >= 4 && j < 12 && k >= 12 && k < 16);
}

static void water_falls_off_an_overhang(void **state)
{
    struct gpu *gpu = open_gpu();
    struct job job;
    struct bed bed;
    double year = 1;
    uint64_t roof = 0, falls = 0;
    (void)state;
    job_of_rain(&job, &year);
    struct routed r = by_hand(&bed, gpu, overhang, false, &job);
    for (int y = 2; y < 6; y++)
        for (int x = 3; x < 9; x++) {
            uint32_t c = cell_at(&r, x, y, 7), to = r.receiver[c], beneath = cell_at(&r, x, y, 6);
            int tx = (int)to % 12, ty = (int)to / 12 % 8, tz = (int)to / 96;
            bool off = tx < 3 || tx > 8 || ty < 2 || ty > 5;
            assert_int_equal(r.tag[c], WATER_SURF);
            assert_int_equal(off, tz == 1); /* over the edge, and down to the ground's rock */
            assert_true(off || tz == 7);
            falls += off ? r.ref.rain[c] : 0;
            roof += 4;
            if (x == 4 && y > 2 && y < 5)
                assert_int_equal(r.tag[beneath], WATER_SOLID); /* the leg's top is inside the table */
            else
                assert_int_equal(r.tag[beneath] & WATER_KIND, WATER_WALL); /* its underside drains grains */
        }
    print_message("# rain on the table %llu, falling off its edge %llu\n", (unsigned long long)roof,
                  (unsigned long long)falls);
    assert_int_equal(falls, roof);
    routed_free(&bed, &r);
    bed_free(&bed);
    gpu_destroy(&gpu);
}

/* A tunnel along x whose floor falls by a voxel every four, through a block; its lower mouth at high x. */
static float tunnel(const struct scene *s, int i, int j, int k)
{
    int bottom = 12 - i / 4;
    (void)s;
    return i >= 2 && i < 22 && k < 20 && !(j >= 6 && j < 10 && k >= bottom && k < bottom + 6);
}

static void a_tunnel_drains_through_its_lower_mouth(void **state)
{
    double frame = 1, year = 0, amount[2] = {3, 1e-8}, points[2][1][3] = {{{6, 4, 6.5}}, {{5, 1.2, 4}}};
    struct job_source source[2] = {{0}};
    struct gpu *gpu = open_gpu();
    struct job job;
    struct bed bed;
    (void)state;
    job_of_rain(&job, &year);
    for (int i = 0; i < 2; i++) {
        source[i].path_m = points[i];
        source[i].n_path_m = 1;
        source[i].m3_per_yr = (struct curve){.n = 1, .frame = &frame, .value = &amount[i]};
    }
    job.sources = source;
    job.n_sources = 2; /* the second begins in rock */
    struct routed r = {0};
    struct water_routing how = {.seed = 5, .frame = 1, .unshifted = true, .cells = true};
    struct scene scene = {.n = {24, 16, 24}};
    bed = bed_of(gpu, &scene, 0.5, tunnel);
    r = route(&bed, 1, &how, &job);
    uint32_t *spring = download(gpu, r.water.node[WATER_SPRING], r.water.n_nodes), *entry;
    double out = 0, lower = 0;
    for (size_t i = 0; i < r.water.n_nodes; i++) {
        uint32_t c = r.node_cell[i];
        if (!(r.tag[c] & WATER_OUT))
            continue;
        out += spring[i] * r.water.spring_unit;
        if (c % 24 >= 22)
            lower += spring[i] * r.water.spring_unit;
    }
    entry = download(gpu, r.water.entry, 4);
    print_message(
        "# 3 m3/yr in, %.10g out, of which %.10g through the lower mouth; a source in rock enters %.3g "
        "cells away\n",
        out, lower, sqrt(entry[3]));
    assert_true(fabs(out - 3) < 1e-8 && fabs(lower - 3) < 1e-8);
    assert_int_equal(entry[1], 0);
    assert_true(spring[entry[2]] >= 1); /* nothing rounds to nothing */
    /* Nearest of all open cells that are not at a side, by looking at each. */
    uint32_t nearest = UINT32_MAX;
    for (int z = 0; z < 24; z++)
        for (int y = 1; y < 15; y++)
            for (int x = 1; x < 23; x++) {
                uint32_t kind = r.tag[cell_at(&r, x, y, z)];
                uint32_t d = (uint32_t)((x - 10) * (x - 10) + (y - 2) * (y - 2) + (z - 8) * (z - 8));
                if ((kind & WATER_KIND) <= WATER_SURF && !(kind & WATER_DEAD) && d < nearest)
                    nearest = d;
            }
    assert_int_equal(entry[3], nearest);
    free(spring);
    free(entry);
    routed_free(&bed, &r);
    bed_free(&bed);
    gpu_destroy(&gpu);
}

/* A block with a hollow of 4 x 2 x 3 cells below a roof one cell thick. */
static float hollow(const struct scene *s, int i, int j, int k)
{
    (void)s;
    return k < 16 && !(i >= 8 && i < 16 && j >= 6 && j < 10 && k >= 8 && k < 14);
}

static void a_closed_cavity_is_dead_unless_its_roof_leaks(void **state)
{
    struct gpu *gpu = open_gpu();
    struct job job;
    double year = 1;
    (void)state;
    job_of_rain(&job, &year);
    for (int leak = 0; leak < 2; leak++) {
        struct bed bed;
        struct routed r = by_hand(&bed, gpu, hollow, leak, &job);
        size_t dead = 0, dry = 0;
        for (int z = 0; z < 12; z++)
            for (int y = 0; y < 8; y++)
                for (int x = 0; x < 12; x++) {
                    uint32_t tag = r.tag[cell_at(&r, x, y, z)];
                    bool inside = x >= 4 && x < 8 && y >= 3 && y < 5 && z >= 3 && z < 7;
                    bool air = (tag & WATER_KIND) <= WATER_SURF;
                    if (inside && air)
                        dead += (tag & WATER_DEAD) != 0;
                    else if (air)
                        assert_false(tag & WATER_DEAD);
                }
        for (int x = 4; x < 8; x++)
            for (int y = 3; y < 5; y++)
                dry += r.ref.rain[cell_at(&r, x, y, 3)] == 0;
        print_message("# leak %d: %zu dead cells in the hollow, %zu of 8 floors dry\n", leak, dead, dry);
        assert_int_equal(dead, leak ? 0 : 32); /* 24 of air, 8 of floor */
        assert_int_equal(dry, leak ? 0 : 8);
        routed_free(&bed, &r);
        bed_free(&bed);
    }
    gpu_destroy(&gpu);
}

/* ---- a plain heightfield */

static float hill(const struct scene *s, int i, int j, int k)
{
    double x = (i + 0.5) / s->n[0], y = (j + 0.5) / s->n[1];
    double height = s->n[2] * (0.3 + 0.45 * x + 0.15 * fabs(y - 0.4) - 0.1 * x * y);
    return (float)fmin(1, fmax(0, height - k));
}

struct spot {
    uint32_t z, c;
};

static int higher(const void *a, const void *b)
{
    const struct spot *p = a, *q = b;
    return p->z < q->z ? 1 : p->z > q->z ? -1 : 0;
}

static void a_heightfield_drains_as_in_two_dimensions(void **state)
{
    struct gpu *gpu = open_gpu();
    struct job job;
    struct scene scene = {.n = {64, 48, 40}};
    struct water_routing how = {.seed = 9, .frame = 3, .unshifted = true, .cells = true};
    double year = 1;
    size_t n = 0, nx = 32, ny = 24, lowered = 0;
    (void)state;
    job_of_rain(&job, &year);
    struct bed bed = bed_of(gpu, &scene, 0.5, hill);
    struct routed r = route(&bed, 2, &how, &job);
    struct spot *spot = calloc(nx * ny, sizeof *spot);
    uint64_t *area = calloc(nx * ny, sizeof *area);
    uint32_t *cell_of = calloc(nx * ny, sizeof *cell_of);
    assert_non_null(spot);
    assert_non_null(area);
    assert_non_null(cell_of);
    assert_int_equal(r.water.n_nodes, nx * ny); /* one floor a column */
    for (size_t i = 0; i < nx * ny; i++) {
        uint32_t c = r.node_cell[i];
        spot[n++] = (struct spot){r.z[c], c};
        area[c % (nx * ny)] = 4;
        cell_of[c % (nx * ny)] = c;
    }
    qsort(spot, n, sizeof *spot, higher);
    for (size_t i = 0; i < n; i++) {
        uint32_t c = spot[i].c, to = r.receiver[c], a = c % (uint32_t)(nx * ny), b = to % (uint32_t)(nx * ny);
        uint32_t apart = a > b ? a - b : b - a;
        if (r.tag[c] & WATER_OUT)
            continue;
        assert_true(apart == 1 || apart == nx);
        lowered += r.z[to] < r.z[c];
        area[b] += area[a]; /* from the highest down: done before b gives its own */
    }
    for (size_t a = 0; a < nx * ny; a++)
        if (lowered == n - 2 * nx - 2 * (ny - 2))
            assert_int_equal(area[a], r.ref.rain[cell_of[a]]);
    print_message("# %zu of %zu receivers are lower neighbours; drainage areas as in two dimensions\n",
                  lowered, n - 2 * nx - 2 * (ny - 2));
    assert_int_equal(lowered, n - 2 * nx - 2 * (ny - 2)); /* the hill has no pits */
    free(spot);
    free(area);
    free(cell_of);
    routed_free(&bed, &r);
    bed_free(&bed);
    gpu_destroy(&gpu);
}

/* ---- threads and kernel variants */

struct setting {
    const char *threads;
    struct gpu_options options;
};

static void threads_and_variants_do_not_show(void **state)
{
    static const struct setting setting[] = {{"2", {.device = "auto"}},
                                             {"0", {.device = "auto"}},
                                             {"1", {.device = "auto"}},
                                             {"2", {.device = "auto", .variant = VARIANT_STORAGE + 1}},
                                             {"2", {.device = "auto", .variant = VARIANT_WIDE + 1}}};
    const char *was = getenv("LP_NUM_THREADS");
    char *kept = was ? strdup(was) : NULL;
    struct scene scene = {.n = {60, 52, 48}, .seed = 1001};
    struct water_routing how = {.seed = 2, .frame = 7, .step = 1, .cells = true};
    struct routed first = {0};
    struct bed first_bed = {0};
    struct job job;
    double year = 1;
    (void)state;
    job_of_rain(&job, &year);
    for (size_t t = 0; t < sizeof setting / sizeof *setting; t++) {
        struct gpu *gpu = NULL;
        setenv("LP_NUM_THREADS", setting[t].threads, 1);
        assert_ok(gpu_create(&setting[t].options, &gpu));
        struct bed bed = bed_of(gpu, &scene, 0.25, porous);
        struct routed r = route(&bed, 1, &how, &job);
        if (t == 0) {
            print_message("# %zu cells, %zu spans, %zu basins; LP_NUM_THREADS 0, 1, 2, and other variants\n",
                          r.ref.n, r.water.n_nodes, r.water.n_basins);
            first = r;
            first_bed = bed;
            continue;
        }
        assert_int_equal(r.water.n_nodes, first.water.n_nodes);
        assert_memory_equal(r.receiver, first.receiver, r.ref.n * 4);
        assert_memory_equal(r.tag, first.tag, r.ref.n * 4);
        assert_memory_equal(r.z, first.z, r.ref.n * 4);
        assert_memory_equal(r.rain, first.rain, r.water.n_nodes * 4);
        routed_free(&bed, &r);
        bed_free(&bed);
        gpu_destroy(&gpu);
    }
    struct gpu *gpu = first_bed.gpu;
    routed_free(&first_bed, &first);
    bed_free(&first_bed);
    gpu_destroy(&gpu);
    kept ? setenv("LP_NUM_THREADS", kept, 1) : unsetenv("LP_NUM_THREADS");
    free(kept);
}

/* ---- the surface */

/* A valley that bends, with a hollow in it; its upper end falls to bare ground. */
static float valley(const struct scene *s, int i, int j, int k)
{
    double x = i + 0.5, y = j + 0.5, hollow = 4 * exp(-(pow(x - 20, 2) + pow(y - 17, 2)) / 20);
    double height = 6 + 0.2 * x + 0.5 * fabs(y - 20 - 4 * sin(x / 9)) - hollow;
    return x < 45 ? (float)fmin(1, fmax(0, fmin(height, s->n[2] - 2) - k)) : 0;
}

/* m3/yr through every cell. */
static double *through(const struct routed *r, const uint32_t *units, double unit_m3)
{
    double *q = calloc(r->ref.n, sizeof *q);
    assert_non_null(q);
    for (size_t i = 0; i < r->water.n_nodes; i++)
        q[r->node_cell[i]] = units[i] * unit_m3;
    return q;
}

static double off(double a, double b)
{
    return fabs(a - b) / fmax(1e-3, fabs(b));
}

/* The streams of a bed, which must be as in plain C. */
static struct stream_ref *check_streams(struct bed *bed, const struct job *job, struct routed *r)
{
    struct water_routing how = {.seed = 4, .frame = 2, .cells = true};
    double worst = 0, most = 0;
    size_t narrow = 0, wet = 0;
    *r = route(bed, 1, &how, job);
    uint32_t *level = flow_ref_levels(&r->ref, false);
    uint32_t *springs = download(bed->gpu, r->water.node[WATER_SPRING], r->water.n_nodes);
    double *rain = through(r, r->rain, r->water.rain_unit),
           *spring = through(r, springs, r->water.spring_unit);
    float(*pull)[4] = calloc(r->water.n_nodes, sizeof *pull);
    assert_non_null(pull);
    assert_ok(gpu_download(bed->gpu, r->water.pull, 0, pull, r->water.n_nodes));
    struct stream_ref *ref = stream_ref_pull(&r->ref, &job->rain, bed->h, level, rain, spring);
    for (size_t i = 0; i < r->water.n_nodes; i++) {
        const struct stream_ref *p = &ref[r->node_cell[i]];
        worst = fmax(worst, fmax(off((double)pull[i][0], p->stream), off((double)pull[i][1], p->beside)));
        worst = fmax(worst, fmax(off((double)pull[i][2], p->share), off((double)pull[i][3], p->shown)));
        most = fmax(most, p->shown);
        narrow += p->share < 0.99;
        wet += p->stream > 0;
    }
    print_message("# %zu floors in water, %zu of them with a stream narrower than they are; to %.1f m3/yr; "
                  "differs by %.1g\n",
                  wet, narrow, most, worst);
    assert_true(worst < 2e-3 && wet > r->water.n_nodes / 2 && narrow > 20);
    free(level);
    free(springs);
    free(rain);
    free(spring);
    free(pull);
    return ref;
}

/* The area of a voxel's bare faces, as shaders/erosion/bare has it. */
static double bare_area(const struct bed *bed, const struct routed *r, const int v[3], const float N[3])
{
    double area = 0;
    for (int a = 0; a < 3; a++)
        for (int side = -1; side <= 1; side += 2) {
            int to[3] = {v[0], v[1], v[2]};
            to[a] += side;
            if ((to[0] >= bed->n[0] && r->ref.walls & WALL_X_MAX) || (to[1] < 0 && r->ref.walls & WALL_Y_MIN))
                continue; /* its own image */
            if (to[2] >= 0 && (to[a] < 0 || to[a] >= bed->n[a] ||
                               (r->tag[cell_at(r, to[0], to[1], to[2])] & WATER_KIND) == WATER_EMPTY))
                area += fabs((double)N[a]);
        }
    return area;
}

static void streams_pull_as_the_equations_say(void **state)
{
    double frame = 1, year = 0.7, rate = 0.4, threshold = 0.9, amount = 900, worst = 0, worst_slopes = 0,
           worst_shown = 0;
    double point[1][3] = {{20, 10.5, 9}};
    size_t cut = 0, shown = 0;
    struct job_source source = {
        .path_m = point, .n_path_m = 1, .m3_per_yr = {.n = 1, .frame = &frame, .value = &amount}};
    struct gpu *gpu = open_gpu();
    struct job job;
    struct scene scene = {.n = {48, 40, 32}};
    (void)state;
    job_of_rain(&job, &year);
    job.sources = &source;
    job.n_sources = 1;
    job.rain.erosion = (struct curve){.n = 1, .frame = &frame, .value = &rate};
    job.rain.threshold_Pa = (struct curve){.n = 1, .frame = &frame, .value = &threshold};
    job.rain.pull_Pa = 0.5;
    job.rain.width_m = 0.02;
    job.rain.width_power = 0.5;
    job.rain.least_width_m = 0.6;
    job.rain.slope_m = 3;
    job.rain.steepest = 3;
    struct bed bed = bed_of(gpu, &scene, 0.5, valley);
    struct routed r;
    free(check_streams(&bed, &job, &r));
    routed_free(&bed, &r);
    job.domain.sides = (struct job_sides){.x_max = SIDE_X_MAX_WALL, .y_min = SIDE_Y_MIN_WALL};
    struct stream_ref *ref = check_streams(&bed, &job, &r);

    size_t n = bed.p.n_surface;
    float *erodibility = calloc(bed.p.n, 4), *before = calloc(n, 4), *after = calloc(n, 4),
          *slopes = calloc(n, 4);
    struct gpu_buffer *intensity = NULL, *parts = NULL, *layers = NULL;
    assert_non_null(erodibility);
    assert_non_null(before);
    assert_non_null(after);
    assert_non_null(slopes);
    for (size_t i = 0; i < bed.p.n; i++)
        erodibility[i] = i % 7 == 0 ? 0 : i % 5 == 0 ? 40 : 0.2f;
    for (size_t i = 0; i < n; i++)
        before[i] = (float)unit((uint32_t)i, 5);
    const float layer[16] = {0, 0, 0, 0, -1, -1, -1,   -1,
                             0, 0, 0, 0, -1, -1, 0.3F, 1.4F}; /* the second has its own */
    uint32_t *of = calloc(bed.p.n, 4);
    assert_non_null(of);
    for (size_t i = 0; i < bed.p.n; i++)
        of[i] = i % 3 == 0;
    assert_ok(gpu_buffer_create(gpu, "test", 4, 16, &layers));
    assert_ok(gpu_upload(gpu, layers, 0, layer, 4));
    assert_ok(gpu_upload(gpu, bed.p.field[ROCK_layer], 0, of, bed.p.n));
    assert_ok(gpu_buffer_create(gpu, "test", n, 4, &intensity));
    assert_ok(gpu_upload(gpu, intensity, 0, before, n));
    assert_ok(gpu_upload(gpu, bed.p.field[ROCK_erodibility], 0, erodibility, bed.p.n));
    water_show(gpu, &r.water, &bed.p);
    assert_ok(gpu_buffer_create(gpu, "test", n, 4, &parts));
    gpu_fill(gpu, parts, 0);
    gpu_fill(gpu, bed.p.taken, 0);
    water_erode(gpu, &r.water, &job, 1, &bed.p, layers, intensity, parts, bed.p.taken);
    struct rock rock;
    uint32_t *surface = download(gpu, bed.p.surface, n);
    assert_ok(gpu_download(gpu, intensity, 0, after, n));
    assert_ok(gpu_download(gpu, bed.p.taken, 0, slopes, n));
    assert_ok(particles_download(gpu, &bed.p, DERIVED, &rock));
    for (size_t s = 0; s < n; s++) {
        const size_t i = surface[s];
        int v[3];
        for (size_t a = 0; a < 3; a++)
            v[a] = (int)((double)rock.P[4 * i + a] / bed.h);
        const uint32_t c = cell_at(&r, v[0], v[1], v[2]);
        const bool floor = (r.tag[c] & WATER_KIND) == WATER_SURF;
        const struct stream_ref *p = &ref[c];
        const double k_t = of[i] ? 0.3 : rate, tau_c = of[i] ? 1.4 : threshold;
        double F =
            k_t * (p->share * fmax(0, p->stream - tau_c) + (1 - p->share) * fmax(0, p->beside - tau_c));
        F = floor && erodibility[i] > 0 ? F : 0;
        /* by a thousandth of the drop */
        const double up = pow(1.001, 0.7);
        double steeper = k_t * (p->share * fmax(0, up * p->stream - tau_c) +
                                (1 - p->share) * fmax(0, up * p->beside - tau_c));
        steeper = F > 0 ? (steeper - F) / (0.001 * fmax(p->drop, bed.h / 64)) * (double)erodibility[i] : 0;
        worst_slopes = fmax(worst_slopes, fabs((double)slopes[s] - steeper) / fmax(1, steeper));
        cut += F > 0;
        F /= fmax(bare_area(&bed, &r, v, &rock.N[4 * i]), 0.1);
        worst = fmax(worst, fabs((double)(after[s] - before[s]) - F) / fmax(1, F));
        if (floor)
            worst_shown = fmax(worst_shown, off((double)rock.discharge[i], p->shown));
        shown += rock.discharge[i] > 0;
    }
    print_message("# F > 0 on %zu particles, differs by %.1g, its change with the slope by %.1g; discharge "
                  "on %zu, by %.1g\n",
                  cut, worst, worst_slopes, shown, worst_shown);
    assert_true(worst < 2e-3 && worst_slopes < 5e-3 && worst_shown < 2e-3 && shown > 1000 && cut > 100);
    rock_free(&rock);
    gpu_buffer_destroy(gpu, &intensity);
    gpu_buffer_destroy(gpu, &parts);
    gpu_buffer_destroy(gpu, &layers);
    free(of);
    free(surface);
    free(erodibility);
    free(before);
    free(after);
    free(slopes);
    free(ref);
    routed_free(&bed, &r);
    bed_free(&bed);
    gpu_destroy(&gpu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(porous_rock_drains_over_its_lowest_passes),
        cmocka_unit_test(water_falls_off_an_overhang),
        cmocka_unit_test(a_tunnel_drains_through_its_lower_mouth),
        cmocka_unit_test(a_closed_cavity_is_dead_unless_its_roof_leaks),
        cmocka_unit_test(a_heightfield_drains_as_in_two_dimensions),
        cmocka_unit_test(threads_and_variants_do_not_show),
        cmocka_unit_test(streams_pull_as_the_equations_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
