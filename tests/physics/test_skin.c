/* What becomes of rock where it meets the air: how long it has been bare, by its law, at any spacing and step; on faces that stand,
 * that retreat, that are cut and that are laid down. Crusts that grow by that, and open into holes where hollows are damp. */
#include "effort.h"
#include "physics/tafoni.h"

/* ---- ages */

/* Ground at 8 m that retreats by 0.1 m/kyr, walls all around; `more`: further keys. */
static struct sim ground(double h, double years, int frames, const char *more)
{
    char text[2048];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: ground\nframes: 1-%d\nclock: {years_per_frame: %g}\n"
             "domain: {size_m: [6, 4, 10], spacing_m: %g, sides: {x_min: wall, x_max: wall, y_min: wall, "
             "y_max: wall}}\n"
             "rock: {gravity_m_s2: 0}\nstrata: [{weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.1}]\nwind: "
             "{abrasion: 0}\n"
             "scene: {box: {min_m: [-1, -1, 0], max_m: [9, 9, 8]}}\n%s",
             frames + 1, years, h, more);
    return sim_begin(text);
}

struct ages {
    double mean, least, most; /* kyr: of bare rock in a box */
    size_t n;
};

static struct ages ages_of(const struct frame *f, const double low[3], const double high[3])
{
    struct ages a = {0, HUGE_VAL, 0, 0};
    assert_non_null(f->rock.exposed_kyr);
    for (size_t i = 0; i < f->rock.n; i++) {
        const float *P = &f->rock.P[4 * i], *N = &f->rock.N[4 * i];
        bool in = N[0] != 0 || N[1] != 0 || N[2] != 0;
        for (int k = 0; k < 3; k++)
            in &= (double)P[k] >= low[k] && (double)P[k] < high[k];
        if (!in)
            continue;
        const double age = (double)f->rock.exposed_kyr[i];
        a.mean += age;
        a.least = fmin(a.least, age);
        a.most = fmax(a.most, age);
        a.n++;
    }
    a.mean /= (double)a.n;
    return a;
}

static const double all_low[3] = {-1, -1, -1}, all_high[3] = {99, 99, 99};

/* A' = 1 - R A / d from A = 3 on: to d / R, whatever the spacing and the steps. */
static void faces_that_retreat_keep_what_does_not_wear_off(void **state)
{
    static const double spacing[] = {1, 0.5, 0.5}, years[] = {1000, 1000, 4000};
    (void)state;
    for (size_t r = 0; r < 3; r++) {
        const int frames = (int)(24000 / years[r]);
        struct sim s =
            ground(spacing[r], years[r], frames, "skin: {exposed: true, depth_m: 0.8, before_kyr: 3}\n");
        for (int f = 0; f < frames; f++)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        const struct ages a = ages_of(&frame, all_low, all_high);
        const double expected = 8 - 5 * exp(-3);
        print_message("# %g m, %g years: bare for %.2f kyr, %.2f to %.2f; the law says %.2f\n", spacing[r],
                      years[r], a.mean, a.least, a.most, expected);
        assert_true(fabs(a.mean / expected - 1) < 0.03);
        assert_true(a.most < 1.1 * expected && a.least > 0.9 * expected);
        frame_free(&frame);
        sim_end(&s);
    }
}

/* What never erodes is as old as the film, and 3 kyr more. A shaft cut into it in frame 3 is new, but for the rock just below the old
 * face, which the air has reached through it. Rock inside has no age. */
static void faces_that_are_cut_are_new(void **state)
{
    (void)state;
    struct sim s = ground(0.5, 1000, 6,
                          "skin: {exposed: true, depth_m: 0.5, before_kyr: 3}\n"
                          "paint: [{shape: {box: {min_m: [-1, -1, -1], max_m: [9, 9, 99]}}, inert: true}]\n"
                          "edits: [{frame: 3, carve: {box: {min_m: [2, 1, 4], max_m: [4, 3, 9]}}}]\n");
    for (int f = 0; f < 5; f++)
        assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    const struct ages top = ages_of(&frame, (const double[]){0, 0, 7.5}, (const double[]){1, 4, 9}),
                      below = ages_of(&frame, (const double[]){0, 0, 7}, (const double[]){6, 4, 7.5}),
                      floor = ages_of(&frame, (const double[]){2, 1, 3}, (const double[]){4, 3, 4});
    /* The face is 0.75 m above the middle of the voxels below its own; some are nearer, by their jitter. It was 4 kyr old, then both
     * went on for 4 more years. */
    print_message("# inert: %.3f kyr; below the old face %.3f, at the bottom of the shaft %.6f\n", top.mean,
                  below.mean, floor.mean);
    assert_true(fabs(top.least - 8) < 1e-4 && fabs(top.most - 8) < 1e-4);
    assert_true(fabs(below.mean - 4 - 4 * exp(-0.75 / 0.5)) < 0.25 && floor.n == 16);
    assert_true(fabs(floor.least - 4) < 1e-2 && fabs(floor.most - 4) < 1e-2);
    for (size_t i = 0; i < frame.rock.n; i++)
        if (frame.rock.P[4 * i + 2] < 3)
            assert_true(frame.rock.exposed_kyr[i] == 0);
    frame_free(&frame);
    sim_end(&s);
}

/* A ledge that sheds onto a floor: what comes to rest there begins anew, and what it buries keeps its age. */
static void deposits_are_new_and_keep_what_they_bury(void **state)
{
    (void)state;
    struct sim s = sim_begin(
        "hoodoo: 1\nname: heap\nframes: 1-9\nclock: {years_per_frame: 500}\n"
        "domain: {size_m: [14, 5, 10], spacing_m: 0.5, sides: {x_min: wall, x_max: wall, y_min: wall, "
        "y_max: wall}}\nrock: {gravity_m_s2: 0}\n"
        "strata: [{to_m: 2, weak_m_per_kyr: 0}, {weak_m_per_kyr: 0.5}]\nwind: {abrasion: 0}\n"
        "scene: {union: [{box: {min_m: [-1, -1, 0], max_m: [15, 9, 2]}}, {box: {min_m: [-1, -1, 2], "
        "max_m: [5, 9, 9]}}]}\n"
        "deposition: {viability: 1}\nskin: {exposed: true, before_kyr: 100}\n");
    for (int f = 0; f < 8; f++)
        assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    size_t n = 0, buried = 0;
    double oldest = 0;
    for (size_t i = 0; i < frame.rock.n; i++) {
        const float *P = &frame.rock.P[4 * i], *N = &frame.rock.N[4 * i];
        if (frame.rock.phase[i] == PHASE_DEPOSIT) {
            n++;
            oldest = fmax(oldest, (double)frame.rock.exposed_kyr[i]);
        } else if (P[0] > 5.5f && P[2] > 1.5f && N[2] == 0) {
            buried++;
            assert_true(frame.rock.exposed_kyr[i] >= 100 && frame.rock.exposed_kyr[i] < 104);
        }
    }
    print_message("# %zu deposits are bare for up to %.2f of 4 kyr, on %zu of old rock\n", n, oldest, buried);
    assert_true(n > 100 && buried > 20);
    assert_true(oldest > 0 && oldest <= 4);
    frame_free(&frame);
    sim_end(&s);
}

/* Nothing is kept unless a job asks for it. */
static void no_ages_unless_asked_for(void **state)
{
    (void)state;
    struct sim s = ground(1, 1000, 2, "");
    assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    assert_null(frame.rock.exposed_kyr);
    frame_free(&frame);
    sim_end(&s);
}

/* ---- crusts */

/* Of ground under a crust, by small steps of the laws: dz/dt = R, R = r / (1 + (c - 1) (1 - exp(-A / t))), A' = 1 - R A / d. */
static double worn_by_law(double kyr, double rate, double crust, double crust_kyr, double depth, double age)
{
    const double dt = 1e-3;
    double worn = 0;
    for (double t = 0; t < kyr; t += dt) {
        const double R = rate / (1 + (crust - 1) * (1 - exp(-age / crust_kyr)));
        worn += R * dt;
        age += dt * (1 - R * age / depth);
    }
    return worn;
}

/* At two spacings, finer and coarser than the crust is deep. */
static void ground_wears_down_by_its_crust(void **state)
{
    (void)state;
    for (int r = 0; r < 3; r++) {
        static const double spacing[] = {1, 0.5, 0.5}, depth[] = {0.4, 0.4, 1.2};
        char skin[128];
        snprintf(skin, sizeof skin, "skin: {crust: 8, crust_kyr: 4, depth_m: %g}\n", depth[r]);
        struct sim s = ground(spacing[r], 1000, 40, skin);
        for (int f = 0; f < 40; f++)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        const double worn = 8 - frame.volume_m3 / 24, law = worn_by_law(40, 0.1, 8, 4, depth[r], 0);
        print_message("# %g m, a crust %g m deep: %.3f m of 4 m are worn off, %.3f m by the law\n",
                      spacing[r], depth[r], worn, law);
        assert_true(fabs(worn / law - 1) < 0.03 && law < 3);
        frame_free(&frame);
        sim_end(&s);
    }
}

/* Both at work open the face. Under a crust alone it stays whole for as long, and without either while it loses about as much. Their size:
 * tests/long/test_tafoni. */
static void tafoni_need_crust_and_damp(void **state)
{
    (void)state;
    const struct tafoni on = weather_cliff(0.15, 3.6, 0.45, 1, 30, 0.1, "crust: 20, crust_kyr: 1, damp: 3"),
                        dry = weather_cliff(0.15, 3.6, 0.45, 1, (int)(2 * on.kyr), 0.1, "crust: 20, damp: 1"),
                        bare = weather_cliff(0.15, 3.6, 0.45, 1, 3, 0.1, "exposed: true");
    assert_true(on.share >= 0.1 && on.n >= 4 && on.deepest > 0.6);
    assert_true(dry.n == 0 && bare.n == 0 && bare.lost > 0.9 * on.lost);
}

/* ---- frost and heat */

/* How far the four walls of a block and its top have gone, m, as the block narrows: +x, -x, +y, -y, top. */
static void walls_of(double h, const char *aspect, double gone[5])
{
    enum { SIDE = 12, TALL = 10 };
    char text[1024];
    snprintf(text, sizeof text,
             "hoodoo: 1\nname: block\nframes: 1-11\nclock: {years_per_frame: 1000}\n"
             "domain: {size_m: [%d, %d, %d], spacing_m: %g}\nrock: {gravity_m_s2: 0}\n"
             "strata: [{weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.1}]\nwind: {abrasion: 0}\n"
             "scene: {box: {min_m: [2, 2, 0], max_m: [%d, %d, %d]}}\n%s\n",
             SIDE + 4, SIDE + 4, TALL + 2, h, SIDE + 2, SIDE + 2, TALL, aspect);
    struct sim s = sim_begin(text);
    double left[5] = {0}, middle = SIDE / 2.0 + 2;
    for (int f = 0; f < 10; f++)
        assert_ok(model_step(s.model));
    struct frame frame = sim_output(&s);
    for (size_t i = 0; i < frame.rock.n; i++) {
        const float *P = &frame.rock.P[4 * i];
        const double x = (double)P[0] - middle, y = (double)P[1] - middle, z = (double)P[2];
        const double m = h * h * h * (double)frame.rock.viability[i];
        if (fabs(y) < 2 && z > 3 && z < 5)
            left[x < 0] += m / 8;
        if (fabs(x) < 2 && z > 3 && z < 5)
            left[2 + (y < 0)] += m / 8;
        if (fabs(x) < 2 && fabs(y) < 2)
            left[4] += m / 16;
    }
    for (int w = 0; w < 5; w++)
        gone[w] = (w < 4 ? SIDE / 2.0 : TALL) - left[w];
    print_message("# %g m, {%s}: walls have gone by %.2f %.2f %.2f %.2f m, the top by %.2f m\n", h, aspect,
                  gone[0], gone[1], gone[2], gone[3], gone[4]);
    frame_free(&frame);
    sim_end(&s);
}

/* At two spacings; and all alike where all slopes are. */
static void walls_weather_by_where_they_face(void **state)
{
    (void)state;
    for (int r = 0; r < 2; r++) {
        double gone[5];
        walls_of(r ? 0.5 : 1, "aspect: {azimuth_deg: 90, rate: 4, rate_per_100m: 2}", gone);
        const double lift = pow(2, 0.04);
        assert_true(fabs(gone[2] / (2 * lift) - 1) < 0.06 && fabs(gone[3] / (0.5 * lift) - 1) < 0.06);
        assert_true(fabs(gone[0] / lift - 1) < 0.06 && fabs(gone[1] / lift - 1) < 0.06);
        assert_true(fabs(gone[4] / pow(2, 0.095) - 1) < 0.06);
    }
    double alike[5];
    walls_of(1, "", alike);
    for (int w = 0; w < 5; w++)
        assert_true(fabs(alike[w] - 1) < 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_that_retreat_keep_what_does_not_wear_off),
        cmocka_unit_test(faces_that_are_cut_are_new),
        cmocka_unit_test(deposits_are_new_and_keep_what_they_bury),
        cmocka_unit_test(ground_wears_down_by_its_crust),
        cmocka_unit_test(tafoni_need_crust_and_damp),
        cmocka_unit_test(walls_weather_by_where_they_face),
        cmocka_unit_test(no_ages_unless_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
