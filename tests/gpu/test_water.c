/* Water's routing against a flood, Kruskal's tree and a serial sum, on porous rock and on scenes made by hand;
 * what rain and sources amount to. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "physics/water_help.h"
#include "tests/ref/flow_ref.h"

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

static struct routed route(struct bed *bed, const struct water_routing *how, const struct job *job)
{
    struct routed r = {0};
    int shift[3];
    uint32_t random = water_random(how, shift);
    assert_ok(water_create(bed->gpu, job, bed->n, bed->h, &r.water));
    assert_ok(water_route(bed->gpu, bed->work, &r.water, how, &bed->p));
    assert_ok(water_discharge(bed->gpu, bed->work, &r.water, job, 1, &bed->p));
    r.ref = flow_ref_route(&bed->rock, bed->n, bed->h, shift, random, how->leak);
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

/* Every claim of water.h for one scene. */
static void check_routing(struct bed *bed, const struct routed *r, bool leak, struct tally *t)
{
    const struct flow_ref *f = &r->ref;
    uint32_t *level = flow_ref_levels(f, leak);
    uint64_t in = (uint64_t)bed->n[0] * (uint64_t)bed->n[1], out = 0;
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
    for (size_t i = 0; i < r->water.n_nodes; i++) {
        uint32_t c = r->node_cell[i];
        assert_int_equal(r->rain[i], f->rain[c]); /* the serial sum */
        out += r->tag[c] & WATER_OUT ? r->rain[i] : 0;
    }
    assert_int_equal(out, in); /* what falls leaves */
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
        struct scene scene = {.n = {10 + 2 * (int)(s % 13), 8 + 2 * (int)(s % 17), 4 + 2 * (int)(s % 11)},
                              .seed = 1000 + s};
        if (s % 55 == 54)
            scene.n[2] = 140; /* columns of three words */
        struct bed bed = bed_of(gpu, &scene, 0.5, porous);
        for (int leak = 0; leak < 2; leak++) {
            struct water_routing how = {
                .seed = s, .frame = 1, .leak = leak, .unshifted = s % 5 == 0, .cells = true};
            struct routed r = route(&bed, &how, &job);
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
    assert_true(t.scenes >= 400 && t.dead > 100 && t.turned > 1000 && t.longest > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(porous_rock_drains_over_its_lowest_passes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
