/* The wind as a fluid: even where nothing stands in it, stopped, split and sheltered by rock as fluids are,
 * incompressible, and the same after a restart. Lengths in the pictures are spacings of the air. */
#include "wind_help.h"

#include "tests/ref/wind_ref.h"

enum { BOX = 20, HIGH = 16 };            /* spacings */
static const int size[3] = {24, 24, 24}; /* m: 12 spacings of 2 m, and 4 more around */
static const double middle = 10;         /* of the box */
#define AIR "{abrasion: 0.5, deflation: {intensity: 0}, flow: {solver: sph, spacing_m: 2, domain: 1.2}"

static int nothing(const double x[3])
{
    (void)x;
    return 0;
}

/* 3 spacings in radius, 6 above the ground. */
static int sphere(const double x[3])
{
    double d[3] = {x[0] - 12, x[1] - 12, x[2] - 12};
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < 36;
}

/* 5 spacings long, on the ground. */
static int cube(const double x[3])
{
    return fabs(x[0] - 12) < 5 && fabs(x[1] - 12) < 5 && x[2] < 10;
}

/* The averaged wind at a point, in spacings from the box's corner. */
static void mean_at(const float *mean, const struct flow *f, const double x[3], double v[3])
{
    int c[3];
    double part[3];
    v[0] = v[1] = v[2] = 0;
    for (int a = 0; a < 3; a++) {
        c[a] = (int)floor(x[a] - 0.5);
        part[a] = x[a] - 0.5 - c[a];
    }
    for (int corner = 0; corner < 8; corner++) {
        int at[3];
        double weight = 1;
        for (int a = 0; a < 3; a++) {
            int up = corner >> a & 1;
            at[a] = c[a] + up;
            weight *= up ? part[a] : 1 - part[a];
        }
        const float *m = mean + 4 * (((size_t)at[2] * (size_t)f->box[1] + (size_t)at[1]) * (size_t)f->box[0] +
                                     (size_t)at[0]);
        for (int a = 0; a < 3; a++)
            v[a] += weight * (double)m[a];
    }
}

/* The wind along itself at a point `ahead` and `left` of the box's middle, at a height. */
static double along(const float *mean, const struct flow *f, const double d[2], double ahead, double left,
                    double height)
{
    const double x[3] = {middle + ahead * d[0] - left * d[1], middle + ahead * d[1] + left * d[0], height};
    double v[3];
    mean_at(mean, f, x, v);
    return v[0] * d[0] + v[1] * d[1];
}

static void check_solves(const struct flow *f)
{
    const struct flow_report *r = &f->report;
    print_message(
        "# %d steps, %u of air, %u of rock: compression %.3f %%, |density - 1| %.2f %%, |div v| dt %.3f %%, "
        "fastest %.2f\n",
        r->steps, (unsigned)r->n_air, (unsigned)r->n_rock, 100 * r->compression, 100 * r->error,
        100 * r->divergence, r->fastest);
    assert_true(f->box[0] == BOX && f->box[1] == BOX && f->box[2] == HIGH);
    assert_true(r->compression <= 0.01);
    assert_true(r->divergence <= 0.02);
}

/* ---- flows */

static void run_flushes(struct tunnel *t, struct flow *f, const double d[2], double flushes)
{
    assert_ok(flow_run(t->gpu, f, &t->particles, d, (int)(flushes * flow_flush(f, d)), 0));
}

static void open_flow(struct tunnel *t, struct flow *f, rock_at *rock)
{
    double change;
    *t = tunnel_open(size, 1, AIR "}", rock);
    assert_ok(flow_create(t->gpu, t->job, t->voxels, f));
    assert_ok(flow_change(t->gpu, f, &t->particles, &change));
    assert_true(change == 1);
}

static void close_flow(struct tunnel *t, struct flow *f)
{
    flow_destroy(t->gpu, f);
    tunnel_close(t);
}

static void even_wind_stays_even(void **state)
{
    const double winds[3][2] = {{1, 0}, {-0.70710678118654752, 0.70710678118654752}, {0.28, -0.96}};
    (void)state;
    for (int w = 0; w < 3; w++) {
        struct tunnel t;
        struct flow f;
        double worst = 0;
        open_flow(&t, &f, nothing);
        run_flushes(&t, &f, winds[w], 1);
        float *mean = tunnel_mean(&t, &f);
        for (size_t i = 0; i < (size_t)BOX * BOX * HIGH; i++)
            worst = fmax(
                worst, hypot(hypot((double)mean[4 * i] - winds[w][0], (double)mean[4 * i + 1] - winds[w][1]),
                             (double)mean[4 * i + 2]));
        print_message("# wind %g %g: farthest from even %.4f %%; in %u, out %u\n", winds[w][0], winds[w][1],
                      100 * worst, (unsigned)f.report.n_in, (unsigned)f.report.n_out);
        check_solves(&f);
        assert_true(worst <= 0.02);
        assert_true(f.report.n_in >= BOX * BOX * HIGH);
        assert_true(fabs((double)f.report.n_out / f.report.n_in - 1) <= 0.02);
        free(mean);
        close_flow(&t, &f);
    }
}

static void a_sphere_splits_the_wind(void **state)
{
    struct tunnel t;
    struct flow f;
    const double d[2] = {1, 0}, z = 6;
    (void)state;
    open_flow(&t, &f, sphere);
    run_flushes(&t, &f, d, 1);
    run_flushes(&t, &f, d, 1);
    float *mean = tunnel_mean(&t, &f);
    check_solves(&f);
    /* Potential flow, at a from the middle: 1 - (3 / a)^3 ahead, 1 + (3 / a)^3 / 2 beside. */
    const double out[] = {0.5, 1, 1.5, 2};
    for (int i = 0; i < 4; i++) {
        double measured = along(mean, &f, d, -3 - out[i], 0, z), potential = 1 - pow(3 / (3 + out[i]), 3);
        print_message("# %.1f spacings before the front: %.2f, potential flow %.2f\n", out[i], measured,
                      potential);
        if (out[i] >= 1) /* from where abrasion looks for the wind, on */
            assert_true(fabs(measured - potential) < 0.1);
    }
    double left = along(mean, &f, d, 0, 4.5, z), right = along(mean, &f, d, 0, -4.5, z);
    double lee = along(mean, &f, d, 4, 0, z), wake = along(mean, &f, d, 7, 0, z);
    print_message("# beside %.2f %.2f (1.15), 1 spacing behind %.2f, 4 behind %.2f\n", left, right, lee,
                  wake);
    print_message("# in %u, out %u in a flush\n", (unsigned)f.report.n_in, (unsigned)f.report.n_out);
    assert_true(left > 1.08 && left < 1.3 && fabs(left - right) < 0.06);
    assert_true(lee < 0.6 && lee < wake - 0.15 && wake < 0.95);
    assert_true(fabs((double)f.report.n_out / f.report.n_in - 1) <= 0.02);
    for (int i = 0; i < BOX * BOX; i++) /* no wind through the ground */
        assert_true(fabs((double)mean[4 * i + 2]) < 0.5);
    free(mean);
    close_flow(&t, &f);
}

/* ---- abrasion */

/* Mean intensity of the surface's particles that face along n (cosine over 0.9), well above the ground and
 * below the top. */
static double struck_of(struct tunnel *t, const struct wind *w, int frame, const double n[2], float k_d,
                        float k_a)
{
    const float layer[8] = {0, 0, 0, 0, k_d, k_a, -1, -1};
    size_t n_surface = t->particles.n_surface, count = 0;
    struct gpu_buffer *intensity = NULL, *parts = NULL, *layers = NULL;
    struct rock rock;
    double sum = 0;
    float *value = malloc(4 * n_surface);
    uint32_t *list = malloc(4 * n_surface);
    assert_non_null(value);
    assert_non_null(list);
    assert_ok(gpu_buffer_create(t->gpu, "intensity", n_surface, 4, &intensity));
    assert_ok(gpu_buffer_create(t->gpu, "parts", n_surface, 4, &parts));
    assert_ok(gpu_buffer_create(t->gpu, "layers", 2, 16, &layers));
    assert_ok(gpu_upload(t->gpu, layers, 0, layer, 2));
    wind_erode(t->gpu, w, t->job, frame, &t->particles, layers, intensity, parts);
    assert_ok(gpu_download(t->gpu, intensity, 0, value, n_surface));
    assert_ok(gpu_download(t->gpu, t->particles.surface, 0, list, n_surface));
    assert_ok(particles_download(t->gpu, &t->particles, DERIVED, &rock));
    for (size_t i = 0; i < n_surface; i++) {
        const float *m = rock.N + 4 * (size_t)list[i];
        if ((double)m[0] * n[0] + (double)m[1] * n[1] < 0.9 || rock.P[4 * (size_t)list[i] + 2] > 8)
            continue;
        assert_true(value[i] >= 0 && value[i] < 10);
        sum += (double)value[i];
        count++;
    }
    assert_true(count > 20);
    rock_free(&rock);
    free(value);
    free(list);
    gpu_buffer_destroy(t->gpu, &intensity);
    gpu_buffer_destroy(t->gpu, &parts);
    gpu_buffer_destroy(t->gpu, &layers);
    return sum / (double)count;
}

static double struck(struct tunnel *t, const struct wind *w, int frame, const double n[2])
{
    return struck_of(t, w, frame, n, -1, -1);
}

static void a_cube_is_worn_on_its_windward_side(void **state)
{
    /* Along x; a gust; then diagonal. */
    const double s = 0.70710678118654752, d[2] = {1, 0}, back[2] = {-1, 0}, diagonal[2] = {s, s};
    const double north[2] = {0, 1}, south[2] = {0, -1};
    struct tunnel t = tunnel_open(
        size, 1, AIR ", gusts: [{frames: 2-2, factor: 1.5}], turn_deg: {2: 0, 3: 45, 4: 46, ease: step}}",
        cube);
    struct wind w;
    (void)state;
    assert_ok(wind_create(t.gpu, t.job, t.voxels, &w));
    assert_ok(wind_update(t.gpu, &w, t.job, 1, &t.particles));
    float *mean = tunnel_mean(&t, &w.flow);
    check_solves(&w.flow);
    double front = along(mean, &w.flow, d, -3.5, 0, 2), beside = along(mean, &w.flow, d, 0, 5, 2),
           lee = along(mean, &w.flow, d, 4, 0, 2), windward = struck(&t, &w, 1, back),
           leeward = struck(&t, &w, 1, d);
    print_message(
        "# cube: before its front %.2f, beside %.2f, in the lee %.2f; struck %.4f, in the lee %.5f\n", front,
        beside, lee, windward, leeward);
    assert_true(front < 0.75 && beside > 1.08 && lee < 0.3);
    assert_true(windward > 0.02 && windward < 0.5); /* 0.5: the whole wind across it */
    assert_true(windward > 5 * leeward);
    free(mean);

    uint64_t steps = w.flow.state.steps;
    assert_ok(wind_update(t.gpu, &w, t.job, 2, &t.particles));
    assert_true(w.flow.state.steps == steps); /* a gust is the same flow, faster */
    double gust = struck(&t, &w, 2, back);
    print_message("# gust of 1.5: %.3f times as much (2.25)\n", gust / windward);
    assert_true(fabs(gust / windward - 2.25) < 1e-3);
    const double own = struck_of(&t, &w, 2, back, 0.25F, 1);
    print_message("# of a layer with k_a 1 instead of 0.5, and k_d 0.25: %.4f, of others %.4f\n", own, gust);
    assert_true(fabs(own - 0.25 - 2 * gust) < 1e-3);

    assert_ok(wind_update(t.gpu, &w, t.job, 3, &t.particles));
    print_message("# anew: %d steps, settled to %.3f\n", w.flow.report.steps, w.flow.report.unsettled);
    assert_true(w.flow.state.steps == (uint64_t)w.flow.report.steps && w.flow.report.steps > 32);
    assert_true(w.flow.report.unsettled <= 0.05);
    assert_ok(flow_run(t.gpu, &w.flow, &t.particles, diagonal, 2 * flow_flush(&w.flow, diagonal), 0));
    mean = tunnel_mean(&t, &w.flow);
    check_solves(&w.flow);
    lee = along(mean, &w.flow, diagonal, 5, 0, 2);
    beside = fmin(along(mean, &w.flow, diagonal, 0, 6, 2), along(mean, &w.flow, diagonal, 0, -6, 2));
    double west = struck(&t, &w, 3, back), low = struck(&t, &w, 3, south), east = struck(&t, &w, 3, d),
           up = struck(&t, &w, 3, north);
    print_message(
        "# at 45 degrees: beside %.2f, in the lee %.2f; windward sides %.4f %.4f, leeward %.5f %.5f\n",
        beside, lee, west, low, east, up);
    print_message("# in %u, out %u\n", (unsigned)w.flow.report.n_in, (unsigned)w.flow.report.n_out);
    assert_true(beside > 1.08 && lee < 0.3);
    assert_true(west + low > 5 * (east + up) && fabs(west / low - 1) < 0.25);
    assert_true(fabs((double)w.flow.report.n_out / w.flow.report.n_in - 1) <= 0.02);
    free(mean);

    steps = w.flow.state.steps;
    assert_ok(wind_update(t.gpu, &w, t.job, 4, &t.particles));
    assert_true(w.flow.state.steps == steps); /* one degree more is too little */
    wind_destroy(t.gpu, &w);
    tunnel_close(&t);
}

/* What strikes a cube's windward side, with air of so many m. */
static double struck_with(const char *air)
{
    const double back[2] = {-1, 0}, d[2] = {1, 0};
    struct tunnel t = tunnel_open(size, 1, air, cube);
    struct wind w;
    double change;
    assert_ok(wind_create(t.gpu, t.job, t.voxels, &w));
    assert_ok(flow_change(t.gpu, &w.flow, &t.particles, &change));
    assert_ok(flow_run(t.gpu, &w.flow, &t.particles, d, 256, 0));
    double sum = struck(&t, &w, 1, back);
    wind_destroy(t.gpu, &w);
    tunnel_close(&t);
    return sum;
}

static void abrasion_converges_with_the_airs_spacing(void **state)
{
    (void)state;
#define OF_SPACING(m)                                                                                        \
    "{abrasion: 0.5, deflation: {intensity: 0}, flow: {solver: sph, spacing_m: " m ", domain: 2}}"
    double coarse = struck_with(OF_SPACING("4")), fine = struck_with(OF_SPACING("2"));
    print_message("# struck with air of 4 m: %.4f, of 2 m: %.4f\n", coarse, fine);
    assert_true(fabs(coarse / fine - 1) < 0.1);
}

/* ---- the same bits */

static void *array_copy(struct tunnel *t, const struct flow_array *a)
{
    void *copy = malloc(a->n * gpu_buffer_item(a->buffer) + 1);
    assert_non_null(copy);
    assert_ok(gpu_download(t->gpu, a->buffer, 0, copy, a->n));
    return copy;
}

static void a_restart_changes_no_bits(void **state)
{
    struct tunnel t;
    struct flow whole, again;
    struct flow_array from[FLOW_ARRAYS], to[FLOW_ARRAYS];
    const double d[2] = {0.6, 0.8}, later[2] = {-0.8, 0.6};
    double change;
    (void)state;
    open_flow(&t, &whole, cube);
    assert_ok(flow_run(t.gpu, &whole, &t.particles, d, 31, 0));
    assert_ok(flow_create(t.gpu, t.job, t.voxels, &again));
    again.state = whole.state;
    assert_ok(flow_check(&again));
    flow_arrays(&whole, from);
    flow_arrays(&again, to);
    for (int i = 0; i < FLOW_ARRAYS; i++) {
        void *data = array_copy(&t, &from[i]);
        assert_true(to[i].n == from[i].n && from[i].n > 0);
        assert_ok(gpu_upload(t.gpu, to[i].buffer, 0, data, to[i].n));
        free(data);
    }
    flow_restore(t.gpu, &again);
    float *mean = tunnel_mean(&t, &whole), *mean_again = tunnel_mean(&t, &again);
    assert_memory_equal(mean, mean_again, (size_t)16 * BOX * BOX * HIGH);
    assert_ok(flow_change(t.gpu, &again, &t.particles, &change));
    assert_true(change == 0);
    assert_ok(flow_run(t.gpu, &whole, &t.particles, later, 23, 0));
    assert_ok(flow_run(t.gpu, &again, &t.particles, later, 23, 0));
    assert_memory_equal(&whole.state, &again.state, sizeof whole.state);
    flow_arrays(&whole, from);
    flow_arrays(&again, to);
    for (int i = 0; i < FLOW_ARRAYS; i++) {
        void *a = array_copy(&t, &from[i]), *b = array_copy(&t, &to[i]);
        assert_memory_equal(a, b, from[i].n * gpu_buffer_item(from[i].buffer));
        free(a);
        free(b);
    }
    again.state.n = (uint32_t)again.slots + 1; /* a state that cannot be */
    assert_int_equal(flow_check(&again), E_CHECKPOINT);
    free(mean);
    free(mean_again);
    flow_destroy(t.gpu, &again);
    close_flow(&t, &whole);
}

/* ---- kernels */

static double far(double a, double b, double scale)
{
    return fabs(a - b) / scale;
}

/* After a few steps around a cube: the kernels' sums against sums over every pair. */
static void kernels_agree_with_plain_sums(void **state)
{
    struct tunnel t;
    struct flow f;
    const double d[2] = {0.8, 0.6};
    (void)state;
    open_flow(&t, &f, cube);
    assert_ok(flow_run(t.gpu, &f, &t.particles, d, 10, 0));
    size_t n = f.state.n;
    struct flow_array array[FLOW_ARRAYS];
    flow_arrays(&f, array);
    float *x = array_copy(&t, &array[0]), *v = array_copy(&t, &array[1]),
          *pressure = array_copy(&t, &array[3]);
    struct flow_array more[3] = {
        {.buffer = f.of_step, .n = n}, {.buffer = f.crowd, .n = n}, {.buffer = f.viscous, .n = n}};
    float *of_step = array_copy(&t, &more[0]), *crowd = array_copy(&t, &more[1]),
          *viscous = array_copy(&t, &more[2]);

    /* One push and one relaxation of what stands there. */
    struct flow_params k = {.n = (uint)n, .slots = (uint)f.slots, .dt = 0.2f, .full = 0};
    GPU_RUN(t.gpu, wind_flow_push, n, k, f.of_step, f.list, f.position[0], f.divergence_pressure[0], f.push);
    GPU_RUN(t.gpu, wind_flow_relax, n, k, f.of_step, f.list, f.position[0], f.push, f.divergence_pressure[0]);
    struct flow_array pushed = {.buffer = f.push, .n = n};
    float *push = array_copy(&t, &pushed), *relaxed = array_copy(&t, &array[3]);

    struct wind_ref_particle *p = calloc(n, sizeof *p);
    struct wind_ref_result *out = calloc(n, sizeof *out);
    assert_non_null(p);
    assert_non_null(out);
    for (size_t i = 0; i < n; i++) {
        p[i] = (struct wind_ref_particle){.volume = (double)x[4 * i + 3],
                                          .pressure = (double)pressure[i],
                                          .kind = (enum wind_ref_kind)v[4 * i + 3]};
        for (int a = 0; a < 3; a++) {
            p[i].x[a] = (double)x[4 * i + (size_t)a];
            p[i].v[a] = (double)v[4 * i + (size_t)a];
        }
    }
    wind_ref(p, n, out);
    double worst[7] = {0};
    size_t checked = 0, volumes = 0;
    for (size_t i = 0; i < n; i++) {
        if (p[i].kind >= REF_ROCK) {
            worst[0] = fmax(worst[0], far(p[i].volume, wind_ref_volume(p, n, i), 1));
            volumes++;
        }
        if (p[i].kind != REF_AIR)
            continue;
        checked++;
        worst[1] = fmax(worst[1], far((double)of_step[4 * i], out[i].density, 1));
        worst[2] = fmax(worst[2], far((double)of_step[4 * i + 1], out[i].factor, out[i].factor));
        worst[3] = fmax(worst[3], far((double)of_step[4 * i + 2], out[i].compression, 1));
        assert_int_equal((int)of_step[4 * i + 3], out[i].neighbours);
        for (size_t a = 0; a < 3; a++) {
            worst[4] = fmax(worst[4], far((double)crowd[4 * i + a], out[i].crowd[a], 1));
            worst[5] = fmax(worst[5], far((double)viscous[4 * i + a], 10 * 0.05 * 0.2 * out[i].drag[a], 1));
            worst[6] = fmax(worst[6], far((double)push[4 * i + a], out[i].push[a], 1));
        }
        worst[6] =
            fmax(worst[6], far((double)relaxed[i], p[i].pressure + 0.5 * out[i].factor * out[i].left, 1));
    }
    print_message(
        "# %zu of air, %zu of boundary; farthest: volume %.1e, density %.1e, factor %.1e, compression %.1e, "
        "crowding %.1e, viscosity %.1e, pressure %.1e\n",
        checked, volumes, worst[0], worst[1], worst[2], worst[3], worst[4], worst[5], worst[6]);
    assert_true(checked > 3000 && volumes > 400);
    for (int i = 0; i < 7; i++)
        assert_true(worst[i] < 2e-5);
    void *memory[] = {x, v, pressure, of_step, crowd, viscous, push, relaxed, p, out};
    for (size_t i = 0; i < sizeof memory / sizeof *memory; i++)
        free(memory[i]);
    close_flow(&t, &f);
}

/* The air that a run begins with. */
static void the_wind_begins_as_potential_flow(void **state)
{
    const double d[2] = {0.8, 0.6};
    const int n[3] = {BOX, BOX, HIGH};
    rock_at *rocks[] = {nothing, sphere, cube};
    (void)state;
    for (int r = 0; r < 3; r++) {
        struct tunnel t;
        struct flow f;
        struct flow_array array[FLOW_ARRAYS];
        enum wind_ref_kind cell[BOX * BOX * HIGH];
        double(*v)[3] = calloc(BOX * BOX * HIGH, sizeof *v), worst = 0, fastest = 0;
        assert_non_null(v);
        open_flow(&t, &f, rocks[r]);
        assert_ok(flow_run(t.gpu, &f, &t.particles, d, 0, 0));
        flow_arrays(&f, array);
        float *velocity = array_copy(&t, &array[1]);
        uint32_t *id = array_copy(&t, &array[4]);
        for (int i = 0; i < BOX * BOX * HIGH; i++)
            cell[i] = REF_ROCK;
        for (size_t i = 0; i < f.state.n; i++)
            if (id[i] < BOX * BOX * HIGH)
                cell[id[i]] = (enum wind_ref_kind)velocity[4 * i + 3];
        wind_ref_potential(n, cell, d, v);
        for (size_t i = 0; i < f.state.n; i++)
            if (velocity[4 * i + 3] == FLOW_AIR)
                for (size_t a = 0; a < 3; a++) {
                    worst = fmax(worst, fabs((double)velocity[4 * i + a] - v[id[i]][a]));
                    fastest = fmax(fastest, fabs(v[id[i]][a]));
                }
        print_message("# farthest from the same in plain C: %.1e wind speeds; fastest %.2f\n", worst,
                      fastest);
        assert_true(worst < 1e-3 && (r == 0 || fastest > 1));
        free(v);
        free(velocity);
        free(id);
        close_flow(&t, &f);
    }
}

static void too_much_air_is_refused(void **state)
{
    struct tunnel t = tunnel_open(size, 1, "{flow: {solver: sph, spacing_m: 0.05}}", nothing);
    struct flow f;
    (void)state;
    assert_int_equal(flow_layout(t.job, t.voxels, &f), E_USAGE);
    print_message("# %s\n", status_message());
    assert_non_null(strstr(status_message(), "wind.flow.spacing_m"));
    tunnel_close(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_wind_stays_even),
        cmocka_unit_test(a_sphere_splits_the_wind),
        cmocka_unit_test(a_cube_is_worn_on_its_windward_side),
        cmocka_unit_test(abrasion_converges_with_the_airs_spacing),
        cmocka_unit_test(a_restart_changes_no_bits),
        cmocka_unit_test(kernels_agree_with_plain_sums),
        cmocka_unit_test(the_wind_begins_as_potential_flow),
        cmocka_unit_test(too_much_air_is_refused),
    };
    return cmocka_run_group_tests_name("wind", tests, NULL, NULL);
}
