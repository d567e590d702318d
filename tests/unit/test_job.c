/* Jobs that are right: values, defaults, curves, --set, the resolved file, the hash, input files, the
 * reference page. */
#include <math.h>
#include <unistd.h>

#include "job_files.h"
#include "system/atomic_file.h"

static void a_job_holds_what_its_file_says(void **state)
{
    (void)state;
    struct job *job = load_good(good_job);
    assert_string_equal(job->name, "arch");
    assert_int_equal(job->frames.first, 1001);
    assert_int_equal(job->frames.last, 1109); /* 1110 is not one of every second frame */
    assert_int_equal(job->frames.step, 2);
    assert_int_equal(job->seed, 7);
    assert_true(job->rock.density_kg_m3 == 2300);
    assert_true(job->domain.size_m[2] == 48);
    assert_int_equal(job->n_strata, 2);
    assert_true(job->strata[0].weak_m_per_kyr.value[0] == 0.2);
    assert_int_equal(job->n_paint, 1);
    assert_true(job->paint[0].erodibility == 2);
    assert_int_equal(job->paint[0].shape->shape, SHAPE_SPHERE);
    assert_int_equal(job->n_cameras, 2);
    assert_string_equal(job->cameras[1].name, "top-2");
    assert_true(job->cameras[0].resolution[1] == 540);
    assert_int_equal(job->output.up, OUTPUT_UP_Z);
    assert_int_equal(job->output.vdb.codec, VDB_CODEC_ZIP);
    assert_int_equal(job->output.aov.n_cameras, 2);
    assert_string_equal(job->output.owner, "Zo\xc3\xab");
    job_destroy(&job);
    assert_null(job);
}

static void absent_keys_have_the_defaults_of_the_table(void **state)
{
    (void)state;
    struct job *job = load_good("{name: a, frames: 5, domain: {size_m: [1, 2, 3], spacing_m: 1},"
                                " scene: {plane: {point_m: [0, 0, 1], normal: [0, 0, 1]}}, strata: [{}],"
                                " cameras: {c: {}}}");
    assert_int_equal(job->hoodoo, 1);
    assert_int_equal(job->frames.first, 5);
    assert_int_equal(job->frames.last, 5);
    assert_true(job->rock.shear_GPa == 15);
    assert_true(job->wind.direction[0] == 1 && job->wind.direction[1] == 0);
    assert_true(job->wind.deflation.friction == 0.75);
    assert_int_equal(job->wind.speed_m_s.n, 1);
    assert_true(curve_at(&job->wind.speed_m_s, 1001) == 10);
    assert_true(job->strata[0].to_m == 1e6);
    assert_true(job->scene->u.plane.scale[2] == 1);
    assert_false(job->scene->u.plane.inert);
    assert_true(job->cameras[0].position_m.value[1] == -100);
    assert_true(job->cameras[0].resolution[0] == 960);
    assert_int_equal(job->output.up, OUTPUT_UP_Y);
    assert_int_equal(job->output.aov.n_cameras, 0);
    assert_string_equal(job->output.comments, "");
    assert_int_equal(job->checkpoint.keep, 2);
    job_destroy(&job);
}

static void shapes_nest_and_keep_their_place(void **state)
{
    (void)state;
    struct job *job = load_good(good_job);
    const struct job_node *scene = job->scene;
    assert_int_equal(scene->kind, NODE_UNION);
    assert_int_equal(scene->n_child, 3);
    assert_int_equal(scene->child[0]->kind, NODE_SHAPE);
    assert_int_equal(scene->child[0]->shape, SHAPE_BOX);
    assert_true(scene->child[0]->u.box.max_m[0] == 56);
    assert_int_equal(scene->child[1]->kind, NODE_DIFFERENCE);
    assert_true(scene->child[1]->u.group.rotate_deg[2] == 30);
    assert_true(scene->child[1]->u.group.scale[0] == 1);
    assert_int_equal(scene->child[1]->child[1]->shape, SHAPE_CYLINDER);
    assert_true(scene->child[1]->child[1]->u.cylinder.top_radius_m == -1);
    assert_true(scene->child[2]->child[1]->u.box.inert);
    job_destroy(&job);
}

static void json_is_a_job_too(void **state)
{
    (void)state;
    struct job *job = load_good("{\"name\": \"a\", \"frames\": \"1001-1002\", \"domain\": {\"size_m\": [1, "
                                "2, 3], \"spacing_m\": 1},\n"
                                "\t\"scene\": {\"sphere\": {\"center_m\": [0, 0, 0], \"radius_m\": 1E0}},\n"
                                "\t\"wind\": {\"speed_m_s\": {\"1001\": 3, \"1002\": 5}}}\n");
    assert_true(curve_at(&job->wind.speed_m_s, 1001.5) == 4);
    job_destroy(&job);
}

/* A camera that moves: points keyed by frame, and an orbit whose azimuth is. */
static void tracks_are_curves_of_points(void **state)
{
    (void)state;
    char *text =
        swapped(good_job, "top-2: {position_m: [0, 0, 99]}",
                "top-2: {position_m: {1020: [10, 0, 99], 1010: [0, -4, 99]}, focal_mm: {1001: 35, 1010: 50},"
                " overscan: 0.1}");
    struct job *job = load_good(text), *again = NULL;
    struct text resolved = {0};
    double x[3];
    track_at(&job->cameras[1].position_m, 1015, x);
    assert_true(x[0] == 5 && x[1] == -2 && x[2] == 99);
    track_at(&job->cameras[1].position_m, 1001, x);
    assert_true(x[0] == 0 && x[1] == -4 && x[2] == 99);
    assert_int_equal(job_resolved(job, &resolved), OK);
    assert_non_null(
        strstr(resolved.data, "position_m: {1010: [0, -4, 99], 1020: [10, 0, 99], ease: linear}"));
    assert_int_equal(load_text(resolved.data, &again), OK);
    track_at(&again->cameras[1].position_m, 1018, x);
    assert_true(x[0] == 8);
    assert_true(hash_of(job) == hash_of(again));
    job_destroy(&job);
    job_destroy(&again);
    text_free(&resolved);
    free(text);
}

static void curves_ease_as_they_say(void **state)
{
    (void)state;
    double frame[] = {0, 10, 20}, value[] = {1, 3, 2};
    struct curve c = {3, frame, value, EASE_LINEAR};
    assert_true(curve_at(&c, -5) == 1 && curve_at(&c, 0) == 1 && curve_at(&c, 20) == 2 &&
                curve_at(&c, 99) == 2);
    assert_true(curve_at(&c, 10) == 3);
    assert_true(curve_at(&c, 5) == 2);
    assert_true(curve_at(&c, 15) == 2.5);
    c.ease = EASE_STEP;
    assert_true(curve_at(&c, 9.99) == 1 && curve_at(&c, 10) == 3 && curve_at(&c, 19) == 3 &&
                curve_at(&c, 20) == 2);
    c.ease = EASE_SMOOTH;
    assert_true(fabs(curve_at(&c, 2.5) - (1 + 2 * 0.15625)) < 1e-15);
    assert_true(curve_at(&c, 5) == 2);
    assert_true(curve_max(&c) == 3);
}

static void curve_keys_are_sorted_by_frame(void **state)
{
    (void)state;
    struct job *job = load_good(good_job);
    const struct curve *c = &job->strata[1].interlock_MPa;
    assert_int_equal(c->n, 2);
    assert_int_equal(c->ease, EASE_STEP);
    assert_true(c->frame[0] == 1001 && c->value[0] == 0.9 && c->frame[1] == 1050 && c->value[1] == 0.5);
    assert_int_equal(job->wind.speed_m_s.ease, EASE_SMOOTH);
    job_destroy(&job);
}

static void set_replaces_and_adds(void **state)
{
    (void)state;
    const char *const sets[] = {
        "wind.speed_m_s=12",
        "strata.0.interlock_MPa={1001: 1, 1050: 2}",
        "strata[1].to_m=50",
        "strata.2={to_m: 90}",
        "cameras.main.resolution=[480,270]",
        "cameras.new.orbit.distance_m=5",
        "output.aov.cameras=[]",
        "output.comments=\"a = b\"",
        "output.owner=",
        "output.owner=lab",
        "stress.tolerance=0.25",
        "scene.union.0.box.inert=true",
        "scene.union[1].difference[0].sphere.radius_m=5",
        "wind.abrasion.1001=0.25",
        "frames=7",
    };
    write_bytes("job.yaml", good_job, strlen(good_job));
    struct job *job = NULL;
    status st = job_load("job.yaml", sets, sizeof sets / sizeof *sets, &job);
    assert_string_equal(st == OK ? "" : status_message(), "");
    assert_true(job->wind.speed_m_s.n == 1 && job->wind.speed_m_s.value[0] == 12);
    assert_int_equal(job->strata[0].interlock_MPa.n, 2);
    assert_int_equal(job->n_strata, 3);
    assert_true(job->strata[1].to_m == 50 && job->strata[2].to_m == 90);
    assert_true(job->cameras[0].resolution[0] == 480);
    assert_int_equal(job->n_cameras, 3);
    assert_string_equal(job->cameras[2].name, "new");
    assert_true(job->cameras[2].orbit.distance_m.value[0] == 5);
    assert_int_equal(job->output.aov.n_cameras, 0);
    assert_string_equal(job->output.comments, "a = b");
    assert_string_equal(job->output.owner, "lab");
    assert_true(job->stress.tolerance == 0.25);
    assert_true(job->scene->child[0]->u.box.inert);
    assert_true(job->scene->child[1]->child[0]->u.sphere.radius_m == 5);
    assert_true(job->wind.abrasion.value[0] == 0.25);
    assert_int_equal(job->frames.last, 7);
    job_destroy(&job);
}

static void set_can_begin_a_list(void **state)
{
    (void)state;
    const char *const sets[] = {"strata.0.to_m=3", "strata.1.to_m=4"};
    static const char text[] = "{name: a, frames: 1, domain: {size_m: [1, 1, 1], spacing_m: 1},"
                               " scene: {sphere: {center_m: [0, 0, 0], radius_m: 1}}}";
    write_bytes("job.yaml", text, strlen(text));
    struct job *job = NULL;
    assert_int_equal(job_load("job.yaml", sets, 2, &job), OK);
    assert_int_equal(job->n_strata, 2);
    assert_true(job->strata[1].to_m == 4);
    job_destroy(&job);
}

static void the_resolved_job_loads_as_an_equal_job(void **state)
{
    (void)state;
    struct job *job = load_good(good_job), *again = NULL;
    struct text first = {0}, second = {0};
    assert_int_equal(job_resolved(job, &first), OK);
    assert_non_null(strstr(first.data, "  density_kg_m3: 2300  # kg/m3; bulk density\n"));
    assert_non_null(strstr(first.data, "interlock_MPa: {1001: 0.9, 1050: 0.5, ease: step}"));
    assert_non_null(strstr(first.data, "keep: 2"));
    again = load_good(first.data);
    assert_int_equal(job_resolved(again, &second), OK);
    assert_string_equal(first.data, second.data);
    assert_true(hash_of(job) == hash_of(again));
    text_free(&first);
    text_free(&second);
    job_destroy(&job);
    job_destroy(&again);
}

/* Numbers that shorter decimals would change, and texts that need care. */
static void resolved_values_are_exact(void **state)
{
    (void)state;
    const char *const sets[] = {"noise.amplitude=0.1000000000000000055511151231257827",
                                "noise.scale_m=333333.33333333331",
                                "rock.density_kg_m3=1234.5678901234567",
                                "wind.speed_m_s={-3: 1e-300, 4: 0.30000000000000004}",
                                "cameras.-x={}",
                                "cameras.null={}",
                                "output.owner=\"a: b # c \\\"d\\\" \\\\ 'e' \\t {}\"",
                                "output.comments=\"two\\nlines, \\u00e9, \\U0001F5FF\""};
    write_bytes("job.yaml", good_job, strlen(good_job));
    struct job *job = NULL;
    status st = job_load("job.yaml", sets, sizeof sets / sizeof *sets, &job);
    assert_string_equal(st == OK ? "" : status_message(), "");
    struct text t = {0};
    assert_int_equal(job_resolved(job, &t), OK);
    struct job *again = load_good(t.data);
    assert_true(again->noise.scale_m == job->noise.scale_m);
    assert_true(again->rock.density_kg_m3 == 1234.5678901234567);
    assert_true(again->wind.speed_m_s.frame[0] == -3 && again->wind.speed_m_s.value[0] == 1e-300);
    assert_true(again->wind.speed_m_s.value[1] == 0.1 + 0.2);
    assert_string_equal(again->cameras[2].name, "-x");
    assert_string_equal(again->cameras[3].name, "null");
    assert_string_equal(again->output.owner, "a: b # c \"d\" \\ 'e' \t {}");
    assert_string_equal(again->output.comments, "two\nlines, \xc3\xa9, \xf0\x9f\x97\xbf");
    text_free(&t);
    job_destroy(&job);
    job_destroy(&again);
}

static void the_hash_ignores_how_a_job_is_written(void **state)
{
    (void)state;
    static const char one[] = "name: a\nframes: 1-2\ndomain: {size_m: [1, 2, 3], spacing_m: 0.5}\n"
                              "scene: {sphere: {center_m: [0, 0, 0], radius_m: 1}}\nwind: {speed_m_s: 10}\n";
    static const char other[] =
        "# another name, other frames but for the first, order, spelling; defaults written out; cameras\n"
        "wind:\n    speed_m_s: {1500: 1.0e+1, ease: step}\n    direction: [1.0, -0.0, 0]\n"
        "scene:\n  sphere:\n    radius_m: +1.00\n    inert: false\n    center_m:\n    - -0\n    - 0\n    - "
        "0\n"
        "domain: {spacing_m: 5e-1, size_m: [1, 2.0, 3]}\n"
        "frames: 1-1100x3\nname: b\nfps: 30\ncameras: {c: {}}\noutput: {aov: {cameras: [c]}, up: z}\n"
        "checkpoint: {every: 3}\nstrata: []\nseed: 1\n";
    assert_true(hash_of_text(one) == hash_of_text(other));
}

static void the_hash_sees_what_is_simulated(void **state)
{
    (void)state;
    static const char *const changes[][2] = {
        {"seed: 7", "seed: 8"},
        {"years_per_frame: 1000", "years_per_frame: 1001"},
        {"spacing_m: 0.5", "spacing_m: 0.25"},
        {"ease: step", "ease: linear"},
        {"1050: 0.5", "1051: 0.5"},
        {"  union:", "  intersection:"},
        {"inert: true", "inert: false"},
        {"rotate_deg: [0, 0, 30]", "translate_m: [0, 0, 30]"},
        {"max_m: [56, 20, 46]", "max_m: [56, 20, 47]"},
        {"erodibility: 2", "erodibility: 3"},
        {"amplitude: 0.15", "amplitude: 0.16"},
        {"strong_m_per_kyr: 0.002", "strong_m_per_kyr: 0.003"},
        {"[0.8, 0.6, 0]", "[0.6, 0.8, 0]"},
        {"1001-1110x2", "1000-1110x2"}, /* ages count from the first frame */
    };
    static const char *const same[][2] = {
        {"name: arch", "name: other"}, {"1001-1110x2", "1001-1200"},
        {"fps: 25", "fps: 24"},        {"distance_m: 90", "distance_m: 91"},
        {"[main, top-2]", "[main]"},   {"up: z", "up: y"},
        {"codec: zip", "codec: none"}, {"every: 5", "every: 50"},
        {"# sandstone", "# granite"},  {"to_m: 48", "to_m: 48\n    color: [1, 1, 1]"},
        {"2.3e3", "2300.0"},           {"  top-2: {position_m: [0, 0, 99]}\n", "  top-2: {}\n  third: {}\n"},
    };
    const bool in_files[] = {false, false, true, true, true, true, true, false, false, true, false, true};
    uint64_t hash = hash_of_text(good_job), files = files_hash_of_text(good_job);
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        char *text = swapped(good_job, changes[i][0], changes[i][1]);
        if (hash_of_text(text) == hash)
            fail_msg("%s does not change the hash", changes[i][1]);
        free(text);
    }
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        char *text = swapped(good_job, same[i][0], same[i][1]);
        if (hash_of_text(text) != hash)
            fail_msg("%s changes the hash", same[i][1]);
        if ((files_hash_of_text(text) != files) != in_files[i])
            fail_msg("%s %s what files have", same[i][1], in_files[i] ? "does not change" : "changes");
        free(text);
    }
}

static const char file_job[] = "{name: a, frames: 1, domain: {size_m: [1, 2, 3], spacing_m: 1}, scene: "
                               "{union: [{mesh: {file: rock.obj}},"
                               " {heightfield: {file: sub/ground.exr, min_m: [0, 0, 0], max_m: [1, 1, 1]}}]},"
                               " paint: [{shape: {mesh: {file: rock.obj}}}]}";

static void files_are_found_beside_the_job_and_hashed_by_content(void **state)
{
    (void)state;
    char here[4096], path[4200];
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(folder_make("one/sub"), OK);
    assert_int_equal(folder_make("two/sub"), OK);
    write_bytes("one/job.yaml", file_job, strlen(file_job));
    write_bytes("two/job.yaml", file_job, strlen(file_job));
    for (int i = 0; i < 2; i++) {
        write_bytes(i ? "one/rock.obj" : "two/rock.obj", "v 0 0 0\n", 8);
        write_bytes(i ? "one/sub/ground.exr" : "two/sub/ground.exr", "grey", 4);
    }
    struct job *one = NULL, *two = NULL;
    assert_int_equal(job_load("one/job.yaml", NULL, 0, &one), OK);
    snprintf(path, sizeof path, "%s/two/job.yaml", here);
    assert_int_equal(job_load(path, NULL, 0, &two), OK);
    snprintf(path, sizeof path, "%s/one/rock.obj", here);
    assert_string_equal(one->scene->child[0]->u.mesh.file, path);
    uint64_t hash = hash_of(one);
    assert_true(hash == hash_of(two));

    struct job_input *input = NULL;
    size_t n = 0;
    assert_int_equal(job_inputs(one, &input, &n), OK);
    assert_int_equal(n, 2);
    assert_string_equal(input[0].path, path);
    assert_int_equal(input[0].size, 8);
    assert_non_null(strstr(input[1].path, "/one/sub/ground.exr"));
    job_inputs_free(&input, n);

    write_bytes("one/rock.obj", "v 0 0 1\n", 8);
    assert_true(hash_of(one) != hash);
    assert_int_equal(remove("one/rock.obj"), 0);
    assert_int_equal(job_hash(one, &hash), E_INPUT);
    assert_non_null(strstr(status_message(), "scene.union.0.mesh.file: "));
    assert_non_null(strstr(status_message(), "No such file"));
    assert_int_equal(job_inputs(one, &input, &n), E_INPUT);
    assert_null(input);

    free(one->scene->child[0]->u.mesh.file);
    one->scene->child[0]->u.mesh.file = strdup("/dev/zero");
    assert_int_equal(job_inputs(one, &input, &n), E_INPUT);
    assert_non_null(strstr(status_message(), "not a regular file"));
    job_destroy(&one);
    job_destroy(&two);
}

/* Keys of later releases are in the hash only where they say something. */
static void later_keys_leave_the_hash_until_they_are_used(void **state)
{
    (void)state;
    static const char *const more[] = {"", ", nodata: refuse, channel: \"\", scale_m: 0, size_px: [0, 0]",
                                       ", nodata: fill", ", channel: 1", ", scale_m: 2"};
    uint64_t hash[sizeof more / sizeof *more];
    write_bytes("later.exr", "grey", 4);
    for (size_t i = 0; i < sizeof more / sizeof *more; i++) {
        struct job *job = NULL;
        char text[400];
        const int n = snprintf(text, sizeof text,
                               "{name: a, frames: 1, domain: {size_m: [1, 2, 3], spacing_m: 1}, scene: "
                               "{heightfield: {file: later.exr, max_m: [1, 1, 1]%s}}}",
                               more[i]);
        write_bytes("later.yaml", text, (size_t)n);
        assert_int_equal(job_load("later.yaml", NULL, 0, &job), OK);
        hash[i] = hash_of(job);
        if (i == 3)
            assert_string_equal(job->scene->u.heightfield.channel, "1");
        job_destroy(&job);
        for (size_t k = 0; k < i; k++)
            assert_true((hash[i] == hash[k]) == (i == 1));
    }
}

/* The buffers of a glTF file count like the file itself. */
static void files_of_files_are_inputs(void **state)
{
    (void)state;
    static const char gltf[] = "{\"buffers\":[{\"uri\":\"a%20b.bin\"},{\"uri\":\"data:,\"}]}";
    static const char text[] =
        "{name: a, frames: 1, domain: {size_m: [1, 2, 3], spacing_m: 1}, scene: {mesh: {file: "
        "rock.gltf}}}";
    struct job *job = NULL;
    struct job_input *input = NULL;
    size_t n = 0;
    write_bytes("rock.gltf", gltf, sizeof gltf - 1);
    write_bytes("a b.bin", "1234", 4);
    write_bytes("gltf.yaml", text, sizeof text - 1);
    assert_int_equal(job_load("gltf.yaml", NULL, 0, &job), OK);
    const uint64_t hash = hash_of(job);
    assert_int_equal(job_inputs(job, &input, &n), OK);
    assert_int_equal(n, 2);
    assert_non_null(strstr(input[1].path, "/a b.bin"));
    job_inputs_free(&input, n);
    write_bytes("a b.bin", "1235", 4);
    assert_true(hash_of(job) != hash);
    assert_int_equal(remove("a b.bin"), 0);
    assert_int_equal(job_inputs(job, &input, &n), E_INPUT);
    assert_non_null(strstr(status_message(), "a b.bin"));
    job_destroy(&job);
}

static void a_job_without_files_has_no_inputs(void **state)
{
    (void)state;
    struct job *job = load_good(good_job);
    struct job_input *input = NULL;
    size_t n = 9;
    assert_int_equal(job_inputs(job, &input, &n), OK);
    assert_int_equal(n, 0);
    job_inputs_free(&input, n);
    job_destroy(&job);
}

/* HOODOO_UPDATE=1 build/tests/unit/test_job writes the files anew. */
static void up_to_date(const char *file, status (*make)(struct text *out))
{
    const char *top = getenv("HOODOO_TOP");
    char path[4096], *page = NULL;
    size_t n = 0;
    struct text t = {0};
    snprintf(path, sizeof path, "%s/jobs/%s", top ? top : ".", file);
    assert_int_equal(make(&t), OK);
    if (getenv("HOODOO_UPDATE"))
        assert_int_equal(atomic_file_write(path, t.data, t.size), OK);
    assert_int_equal(file_read(path, 1 << 20, &page, &n), OK);
    if (n != t.size || memcmp(page, t.data, n) != 0)
        fail_msg("%s is not what the key table says; run test_job with HOODOO_UPDATE=1", path);
    free(page);
    text_free(&t);
}

static void reference_page_and_schema_are_up_to_date(void **state)
{
    (void)state;
    up_to_date("README.md", job_reference);
    up_to_date("schema.json", job_schema);
}

static void the_example_of_the_reference_page_loads(void **state)
{
    (void)state;
    struct text t = {0};
    assert_int_equal(job_reference(&t), OK);
    char *begin = strstr(t.data, "```yaml\n"), *end = begin ? strstr(begin + 8, "```") : NULL;
    assert_non_null(end);
    *end = '\0';
    struct job *job = load_good(begin + 8);
    assert_string_equal(job->name, "block");
    job_destroy(&job);
    text_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_job_holds_what_its_file_says),
        cmocka_unit_test(absent_keys_have_the_defaults_of_the_table),
        cmocka_unit_test(shapes_nest_and_keep_their_place),
        cmocka_unit_test(json_is_a_job_too),
        cmocka_unit_test(tracks_are_curves_of_points),
        cmocka_unit_test(curves_ease_as_they_say),
        cmocka_unit_test(curve_keys_are_sorted_by_frame),
        cmocka_unit_test(set_replaces_and_adds),
        cmocka_unit_test(set_can_begin_a_list),
        cmocka_unit_test(the_resolved_job_loads_as_an_equal_job),
        cmocka_unit_test(resolved_values_are_exact),
        cmocka_unit_test(the_hash_ignores_how_a_job_is_written),
        cmocka_unit_test(the_hash_sees_what_is_simulated),
        cmocka_unit_test(files_are_found_beside_the_job_and_hashed_by_content),
        cmocka_unit_test(later_keys_leave_the_hash_until_they_are_used),
        cmocka_unit_test(files_of_files_are_inputs),
        cmocka_unit_test(a_job_without_files_has_no_inputs),
        cmocka_unit_test(reference_page_and_schema_are_up_to_date),
        cmocka_unit_test(the_example_of_the_reference_page_loads),
    };
    return cmocka_run_group_tests_name("job", tests, NULL, NULL);
}
