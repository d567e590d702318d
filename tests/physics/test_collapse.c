/* Falling rock as jobs have it: shots in real time, blocks that erosion cuts off, what they leave behind, and the
 * same bits whatever happens in between. */
#include "model_help.h"

#include <math.h>
#include <string.h>

static const char SHOT[] =
    "hoodoo: 1\nname: shot\nframes: 1001-1100\nclock: {seconds_per_frame: 0.0416667}\n"
    "domain: {size_m: [20, 10, 14], spacing_m: 0.5}\n"
    "scene:\n"
    "  union:\n"
    "    - box: {min_m: [3, 3, 0], max_m: [6, 7, 7]}\n"
    "    - box: {min_m: [3, 3, 9.5], max_m: [14, 7, 12]}\n"
    "    - box: {min_m: [18, 4, 6], max_m: [19.9, 6, 8]}\n"
    "collapse: {strength_MPa: 2, joints_m: 2}\n"
    "cameras: {main: {orbit: {target_m: [10, 5, 6], distance_m: 40, azimuth_deg: -90, elevation_deg: 0}, "
    "resolution: [160, 90]}}\n"
    "output: {aov: {cameras: [main]}}\n";

static void adds_up(const struct frame *f)
{
    const struct ledger *l = &f->ledger;
    assert_int_equal(l->start, l->rock + l->deposit + l->fallen + l->left);
    assert_int_equal(f->rock.n, l->rock + l->deposit + l->fallen);
}

static void same_rock(const struct frame *a, const struct frame *b)
{
    assert_int_equal(a->rock.n, b->rock.n);
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (a->rock.field[f] || b->rock.field[f]) /* some are in some jobs alone */
            assert_memory_equal(a->rock.field[f], b->rock.field[f],
                                a->rock.n * rock_field_size((enum rock_field)f));
    assert_memory_equal(&a->ledger, &b->ledger, sizeof a->ledger);
}

static const struct aov_channel *channel_named(const struct frame *f, const char *name)
{
    for (size_t c = 0; c < f->image[0].n_channels; c++)
        if (strcmp(f->image[0].channel[c].name, name) == 0)
            return &f->image[0].channel[c];
    return NULL;
}

static void shot_falls(void **state)
{
    struct sim s = sim_begin(SHOT);
    struct frame frame;
    size_t moving = 0;
    double lowest = 1e30, down = 0, px = 0, most = 0;
    (void)state;
    for (int f = 0; f < 12; f++) {
        assert_ok(model_step(s.model));
        frame = sim_output(&s);
        adds_up(&frame);
        assert_true(frame.years == 0);
        for (size_t i = 0; i < frame.rock.n; i++)
            lowest = fmin(lowest, (double)frame.rock.P[4 * i + 2]);
        if (f < 11)
            frame_free(&frame);
    }
    for (size_t i = 0; i < frame.rock.n; i++) {
        moving += frame.rock.phase[i] == 2;
        most = fmax(most, (double)-frame.rock.v[4 * i + 2]);
    }
    const struct aov_channel *x = channel_named(&frame, "motion.X"), *y = channel_named(&frame, "motion.Y"),
                             *depth = channel_named(&frame, "Z");
    assert_non_null(x);
    assert_non_null(y);
    for (int i = 0; i < 160 * 90; i++)
        if ((double)y->value[i] < down) {
            down = (double)y->value[i];
            /* v dt, on a film of 36 mm behind 35 mm. */
            px = most / 24 * 35 / 36 * 160 / (double)depth->value[i];
        }
    print_message(
        "# after half a second %zu of %zu particles fall, at up to %.2f m/s; pictures move by up to %.3f "
        "px a frame (%.3f expected)\n",
        moving, frame.rock.n, most, -down, px);
    assert_true(lowest >= 0);
    /* The beam and the small block; the pillar stands. */
    assert_true(moving > 900 && moving < 1000);
    assert_true(most > 4 && most < 5.5);
    assert_true(fabs(-down / px - 1) < 0.03);
    frame_free(&frame);
    sim_end(&s);

    /* Years have no motion. */
    s = sim_begin("hoodoo: 1\nname: still\nframes: 1001-1002\ndomain: {size_m: [8, 8, 8], spacing_m: 1}\n"
                  "scene: {box: {min_m: [2, 2, 0], max_m: [6, 6, 6]}}\n"
                  "cameras: {main: {resolution: [16, 16]}}\noutput: {aov: {cameras: [main]}}\n");
    frame = sim_output(&s);
    assert_null(channel_named(&frame, "motion.X"));
    frame_free(&frame);
    sim_end(&s);
}

static void resumes_in_the_fall(void **state)
{
    struct sim a = sim_begin(SHOT), b = sim_begin(SHOT);
    struct checkpoint saved = {0}, again = {0};
    (void)state;
    for (int f = 0; f < 14; f++) {
        assert_ok(model_step(a.model));
        if (f != 8)
            continue;
        assert_ok(model_save(a.model, &saved));
        model_destroy(&b.model);
        assert_ok(model_create(b.gpu, b.job, &saved, &b.model));
        struct frame was = sim_output(&a), is = sim_output(&b);
        same_rock(&was, &is);
        frame_free(&was);
        frame_free(&is);
        assert_ok(model_save(b.model, &again));
        assert_same_state(&saved, &again);
    }
    for (int f = 9; f < 14; f++)
        assert_ok(model_step(b.model));
    struct frame was = sim_output(&a), is = sim_output(&b);
    same_rock(&was, &is);
    print_message(
        "# saved in the 9th frame of a fall, resumed, and the same bits in the 14th: %zu particles\n",
        is.rock.n);
    frame_free(&was);
    frame_free(&is);
    checkpoint_free(&saved);
    checkpoint_free(&again);
    sim_end(&a);
    sim_end(&b);
}

static void threads_do_not_matter(void **state)
{
    static const char *const threads[] = {"0", "1", "2"};
    struct frame first = {0};
    (void)state;
    for (int t = 0; t < 3; t++) {
        setenv("LP_NUM_THREADS", threads[t], 1);
        struct sim s = sim_begin(SHOT);
        for (int f = 0; f < 6; f++)
            assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        if (t == 0) {
            first = frame;
        } else {
            same_rock(&first, &frame);
            frame_free(&frame);
        }
        sim_end(&s);
    }
    unsetenv("LP_NUM_THREADS");
    frame_free(&first);
}

/* ---- blocks between frames */

static const char BLOCKS[] = "hoodoo: 1\nname: blocks\nframes: 1001-1100\nclock: {years_per_frame: 500}\n"
                             "domain: {size_m: [24, 12, 14], spacing_m: 0.5}\n"
                             "scene:\n"
                             "  union:\n"
                             "    - box: {min_m: [2, 2, 0], max_m: [8, 10, 4]}\n"
                             "    - box: {min_m: [3.5, 4, 7], max_m: [6.5, 8, 9]}\n"
                             "collapse: {blocks: fall, strength_MPa: 2, joints_m: 2}\n"
                             "wind: {abrasion: 0}\noutput: {aov: {samples: 1}}\n";

/* Whether two particles are in one voxel, or in two that share a face, an edge or a corner. */
static bool touch(const struct frame *f, double h, size_t i, size_t j)
{
    bool near = true;
    for (size_t a = 0; a < 3 && near; a++)
        near = fabs(floor((double)f->rock.P[4 * i + a] / h) - floor((double)f->rock.P[4 * j + a] / h)) <= 1;
    return near;
}

/* Particles in the smallest heap of rubble that touches nowhere else. */
static size_t smallest_fragment(const struct frame *f, double h)
{
    size_t n = 0, least = f->rock.n;
    size_t *rubble = calloc(f->rock.n, sizeof *rubble), *heap = calloc(f->rock.n, sizeof *heap);
    for (size_t i = 0; i < f->rock.n; i++)
        if (f->rock.phase[i] == 2)
            rubble[n++] = i;
    while (n > 0) { /* a heap grows from the last that is left, until none that is left touches it */
        size_t size = 0;
        heap[size++] = rubble[--n];
        for (size_t k = 0; k < size; k++)
            for (size_t j = 0; j < n;)
                if (touch(f, h, heap[k], rubble[j])) {
                    heap[size++] = rubble[j];
                    rubble[j] = rubble[--n];
                } else
                    j++;
        least = size < least ? size : least;
    }
    free(rubble);
    free(heap);
    return least;
}

static void blocks_become_rubble(void **state)
{
    struct sim s = sim_begin(BLOCKS);
    struct frame frame = sim_output(&s);
    size_t hanging = 0, inside = 0, block = 3 * 4 * 2 * 8, on_top = 0, n_rubble = 0, rubble_before;
    (void)state;
    adds_up(&frame);
    for (size_t i = 0; i < frame.rock.n; i++) {
        const float *x = frame.rock.P + 4 * i;
        bool fell = frame.rock.id[i] >= frame.ledger.start - block;
        hanging += fell && (double)x[2] > 8.5;
        on_top += fell && (double)x[2] > 4;
        /* The resting block's own voxels are full. */
        inside += fell && (double)x[0] < 7.9 && (double)x[0] > 2 && (double)x[2] < 3.9;
        n_rubble += frame.rock.phase[i] == 2;
        assert_true(fell || frame.rock.phase[i] == 0);
        assert_true(!fell || frame.rock.phase[i] != 0);
        assert_true((double)x[2] >= 0);
    }
    print_message(
        "# a block of %zu particles dropped on another: %llu rock, %llu deposit, %llu left; %zu particles "
        "inside the other block, %zu on it, %zu still hang\n",
        block, (unsigned long long)frame.ledger.rock, (unsigned long long)frame.ledger.deposit,
        (unsigned long long)frame.ledger.left, inside, on_top, hanging);
    assert_int_equal(frame.ledger.fallen, n_rubble);
    assert_true(n_rubble > block / 8);
    assert_true(smallest_fragment(&frame, 0.5) >= 8);
    assert_int_equal(inside, 0);
    assert_int_equal(hanging, 0);
    assert_true(on_top > block / 2);
    assert_true(frame.ledger.left < block / 4);
    assert_true(frame.ledger.deposit > 0);
    rubble_before = n_rubble;
    float *was = calloc(3 * frame.ledger.start, sizeof *was),
          *left = calloc(frame.ledger.start, sizeof *left);
    for (size_t i = 0; i < frame.rock.n; i++) {
        memcpy(was + 3 * frame.rock.id[i], frame.rock.P + 4 * i, 12);
        left[frame.rock.id[i]] = frame.rock.viability[i];
    }
    frame_free(&frame);
    /* It lies, and weathers as rock does. */
    for (int f = 0; f < 2; f++) {
        size_t moved = 0, weathered = 0;
        assert_ok(model_step(s.model));
        frame = sim_output(&s);
        adds_up(&frame);
        n_rubble = 0;
        for (size_t i = 0; i < frame.rock.n; i++) {
            if (frame.rock.phase[i] != 2)
                continue;
            uint32_t id = frame.rock.id[i];
            n_rubble++;
            moved += memcmp(was + 3 * id, frame.rock.P + 4 * i, 12) != 0;
            weathered += frame.rock.viability[i] < left[id];
            assert_true(frame.rock.viability[i] <= left[id]);
        }
        print_message(
            "# a frame later: %zu of %zu particles of rubble are left, %zu have moved, %zu have weathered\n",
            n_rubble, rubble_before, moved, weathered);
        assert_int_equal(frame.ledger.fallen, n_rubble);
        /* What weathering cuts off falls again. */
        assert_true(f > 0 ? moved <= rubble_before / 10 : moved == 0);
        assert_true(weathered > 0);
        assert_true(n_rubble > rubble_before / 2);
        frame_free(&frame);
    }
    free(was);
    free(left);
    sim_end(&s);
}

/* What breaks off and is smaller than rubble is, or than material points can show, is laid down with what eroded. */
static const char CRUMB[] = "hoodoo: 1\nname: crumb\nframes: 1001-1100\nclock: {years_per_frame: 500}\n"
                            "domain: {size_m: [16, 16, 12], spacing_m: 1}\n"
                            "scene:\n"
                            "  union:\n"
                            "    - box: {min_m: [2, 2, 0], max_m: [14, 14, 3]}\n"
                            "    - box: {min_m: [7, 7, 3], max_m: [9, 9, 6]}\n"
                            "strata:\n"
                            "  - {to_m: 3, weak_m_per_kyr: 0, strong_m_per_kyr: 0}\n"
                            "  - {to_m: 4, weak_m_per_kyr: 5, strong_m_per_kyr: 5}\n"
                            "  - {weak_m_per_kyr: 0, strong_m_per_kyr: 0}\n"
                            "collapse: {blocks: fall}\nwind: {abrasion: 0}\n";

static void small_blocks_crumble(void **state)
{
    static const char *const deposition[] = {"deposition: {viability: 1, fines: 0, bulking: 1}\n",
                                             "deposition: {viability: 0}\n"};
    (void)state;
    for (int laid = 1; laid >= 0; laid--) {
        char text[1024];
        snprintf(text, sizeof text, "%s%s", CRUMB, deposition[!laid]);
        struct sim s = sim_begin(text);
        const uint64_t base = 12 * 12 * 3, neck = 4, block = 8;
        assert_ok(model_step(s.model));
        struct frame frame = sim_output(&s);
        print_message(
            "# a block of 8 particles breaks off, %s: %llu rock, %llu deposit, %llu fallen, %llu left\n",
            deposition[!laid], (unsigned long long)frame.ledger.rock,
            (unsigned long long)frame.ledger.deposit, (unsigned long long)frame.ledger.fallen,
            (unsigned long long)frame.ledger.left);
        adds_up(&frame);
        assert_int_equal(frame.ledger.start, base + neck + block);
        assert_int_equal(frame.ledger.rock, base);
        assert_int_equal(frame.ledger.deposit, laid ? neck + block : 0);
        assert_int_equal(frame.ledger.left, laid ? 0 : neck + block);
        for (size_t i = 0; i < frame.rock.n; i++)
            assert_true((double)frame.rock.P[4 * i + 2] < 5);
        frame_free(&frame);
        sim_end(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shot_falls),
        cmocka_unit_test(resumes_in_the_fall),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(blocks_become_rubble),
        cmocka_unit_test(small_blocks_crumble),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
