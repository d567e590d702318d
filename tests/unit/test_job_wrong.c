/* Jobs that are wrong, by mistake or by malice: each is refused in one sentence that says where, and what is
 * allowed. */
#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "effort.h"
#include "job_files.h"

struct wrong {
    const char *from, *to; /* an edit of the good job */
    const char *says[3];   /* parts of the message */
};

#define SWEEP(more)                                                                                                \
    "fps: 25",                                                                                                     \
        "fps: 25\narches: {operations: [{tool: sweep, frames: 1001, points_m: [[0, 0, 0, 1], [9, 0, 0, 1]], " more \
        "}]}"
#define THREE "[[0, 0], [1, 0], [0, 1]]"

static const struct wrong wrong[] = {
    /* profiles at points */
    {SWEEP("profiles: [{point: 0, profile: " THREE "}]"), {"operations.0.profiles: without profile"}},
    {SWEEP("profile: " THREE ", profiles: [{point: 2, profile: " THREE "}]"),
     {"profiles.0.point: 2 is not one of the 2 points"}},
    {SWEEP("profile: " THREE ", profiles: [{point: 1, profile: [[0, 0], [1, 0], [1, 1], [0, 1]]}]"),
     {"profiles.0.profile: 4 points, but the sweep's profile has 3"}},
    {SWEEP("profile: " THREE ", profiles: [{point: 1, profile: " THREE "}, {point: 1, profile: " THREE "}]"),
     {"profiles.1.point: point 1 has a profile already"}},
    {SWEEP("profile: " THREE ", profiles: [{profile: " THREE "}]"), {"profiles.0.point: missing"}},
    /* keys */
    {"spacing_m: 0.5",
     "spacng_m: 0.5",
     {"job.yaml:8:32: domain.spacng_m: unknown key", "did you mean spacing_m?"}},
    {"fps: 25", "fps: 25\nrain: {shear_Pa: 1}", {"rain.shear_Pa: replaced by pull_Pa"}},
    {"wind: {", "wnd: {", {"job.yaml:27:1: wnd: unknown key", "did you mean wind?"}},
    {"scale_m: 14", "scale: 14", {"noise.scale: unknown key", "did you mean scale_m?"}},
    {"fps: 25", "zzzzzz: 25", {"job.yaml:5:1: zzzzzz: unknown key", "known here: hoodoo, name, model"}},
    {"seed: 7", "seed: 7\nseed: 7", {"job.yaml:7:1: seed: given twice", "line 6"}},
    {"- box: {min_m", "- bx: {min_m", {"job.yaml:12:7: scene.union.0.bx: unknown key", "did you mean box?"}},
    {"name: arch\n", "", {"job.yaml:1:1: name: missing"}},
    {"spacing_m: 0.5", "", {"job.yaml:8:9: domain.spacing_m: missing (m; particle spacing"}},
    {"domain: {size_m: [60, 24, 48], spacing_m: 0.5}", "", {"job.yaml:1:1: domain.size_m: missing"}},
    {", radius_m: 4}", "}", {"job.yaml:14:19: scene.union.1.difference.0.sphere.radius_m: missing"}},
    {"main: {orbit", "main: {name: m, orbit", {"cameras.main.name: already named by its key: main"}},
    /* types */
    {"fps: 25", "fps: fast", {"job.yaml:5:6: fps: 'fast' is not a finite decimal number", "(1..1000 1/s)"}},
    {"fps: 25", "fps: \"25\"", {"fps: text where a number is expected", "leave out the quotes"}},
    {"fps: 25", "fps: [25]", {"fps: a list where a number is expected"}},
    {"fps: 25", "fps:", {"job.yaml:5:1: fps: an empty value where a number is expected"}},
    {"fps: 25", "fps: 0x19", {"fps: '0x19' is not a finite decimal number"}},
    {"fps: 25", "fps: 1_000", {"fps: '1_000' is not"}},
    {"fps: 25", "fps: .inf", {"fps: '.inf' is not a finite"}},
    {"fps: 25", "fps: .nan", {"fps: '.nan' is not a finite"}},
    {"fps: 25", "fps: nan", {"fps: 'nan' is not a finite"}},
    {"fps: 25", "fps: 1e999", {"fps: '1e999' is not a finite"}},
    {"fps: 25", "fps: 1 2", {"fps: '1 2' is not a finite"}},
    {"fps: 25", "fps: true", {"fps: 'true' is not a finite"}},
    {"seed: 7", "seed: 7.5", {"seed: 7.5 is not a whole number (0..4294967295)"}},
    {"name: arch", "name: 12", {"job.yaml:2:7: name: a number where text is expected", "in quotes: \"12\""}},
    {"name: arch", "name: true", {"name: true or false where text is expected"}},
    {"name: arch", "name: null", {"name: an empty value where text is expected"}},
    {"name: arch", "name: [a]", {"name: a list where text is expected"}},
    {"name: arch", "name: ../arch", {"name: '../arch' is not a name (1 to 64 letters"}},
    {"name: arch", "name: \"\"", {"name: '' is not a name"}},
    {"name: arch",
     "name: a23456789012345678901234567890123456789012345678901234567890abcde",
     {"is not a name"}},
    {"inert: true",
     "inert: yes",
     {"job.yaml:19:62: scene.union.2.intersection.1.box.inert: 'yes' is not true or"}},
    {"inert: true", "inert: 1", {"'1' is not true or false"}},
    {"up: z", "up: x", {"output.up: 'x' is not one of y, z"}},
    {"up: z", "up: [z]", {"output.up: a list where a choice is expected (y, z)"}},
    {"[60, 24, 48]",
     "[60, 24]",
     {"domain.size_m: a list of another length where a list of 3 numbers is expected"}},
    {"[60, 24, 48]", "60", {"domain.size_m: a number where a list of 3 numbers is expected"}},
    {"[60, 24, 48]", "[60, x, 48]", {"job.yaml:8:23: domain.size_m.1: 'x' is not"}},
    {"[960, 540]", "[960, 540.5]", {"cameras.main.resolution.1: 540.5 is not a whole number"}},
    {"1001-1110x2", "1110-1001", {"job.yaml:4:9: frames: the frame range '1110-1001' ends before it begins"}},
    {"1001-1110x2", "soon", {"frames: 'soon' is not a frame range"}},
    {"1001-1110x2", "[1001, 1110]", {"frames: a list where a frame range is expected"}},
    {"noise: {amplitude: 0.15, scale_m: 14}", "noise: 3", {"noise: a number where a mapping is expected"}},
    {"noise: {amplitude: 0.15, scale_m: 14}",
     "noise:",
     {"noise: an empty value where a mapping is expected"}},
    {"  - {to_m: 36,", "  - 36\n  - {to_m: 37,", {"strata.0: a number where a mapping is expected"}},
    {"paint:\n  - {shape", "paint:\n    {shape", {"paint: a mapping where a list of mappings is expected"}},
    {"  main: {", "  ma/in: {", {"cameras.ma/in: 'ma/in' is not a name"}},
    {"cameras: [main, top-2]",
     "cameras: main",
     {"output.aov.cameras: text where a list of names is expected"}},
    {"\"Zo\\u00eb\"", "\"a\\x07b\"", {"output.owner: contains a control character"}},
    /* ranges */
    {"fps: 25", "fps: 0", {"job.yaml:5:6: fps: 0 is out of range (1..1000 1/s)"}},
    {"spacing_m: 0.5", "spacing_m: -1", {"domain.spacing_m: -1 is out of range (0.0001..10000 m)"}},
    {"spacing_m: 0.5", "spacing_m: 0", {"domain.spacing_m: 0 is out of range"}},
    {"seed: 7", "seed: -1", {"seed: -1 is out of range (0..4294967295)"}},
    {"hoodoo: 1", "hoodoo: 2", {"job.yaml:1:9: hoodoo: 2 is out of range (1..1)"}},
    {"[960, 540]", "[960, 1e9]", {"cameras.main.resolution.1: 1e9 is out of range (8..16384 px)"}},
    /* curves */
    {"{1001: 10, 1060: 14", "{1001: 10, 1060: 1400", {"wind.speed_m_s.1060: 1400 is out of range"}},
    {"1060: 14", "x: 14", {"wind.speed_m_s.x: not a frame; a curve is a value, or {frame: value"}},
    {"1060: 14", "1060.5: 14", {"wind.speed_m_s.1060.5: not a frame"}},
    {"1060: 14", "+1001: 14", {"wind.speed_m_s.+1001: frame 1001 is given twice"}},
    {"1060: 14", "1001: 14", {"wind.speed_m_s.1001: given twice"}},
    {"ease: smooth", "ease: bouncy", {"wind.speed_m_s.ease: not an ease (linear, smooth, step)"}},
    {"{1001: 10, 1060: 14, ease: smooth}",
     "{ease: smooth}",
     {"wind.speed_m_s: a curve needs at least one frame"}},
    {"{1001: 10, 1060: 14, ease: smooth}", "{}", {"wind.speed_m_s: a curve needs at least one frame"}},
    {"speed_m_s: {1001: 10, 1060: 14, ease: smooth}",
     "shelter_m: {1: 2}",
     {"wind.shelter_m: a mapping where a number"}},
    /* shapes */
    {"      rotate_deg",
     "      inside_out: true\n      rotate_deg",
     {"union.1.inside_out: unknown key; known here: union"}},
    {"      rotate_deg",
     "      union: []\n      rotate_deg",
     {"union.1.union: a second shape or operator beside diff"}},
    {"  union:\n    - box",
     "  union:\n    - scale: [1, 1, 1]\n    - box",
     {"scene.union.0: neither a shape"}},
    {"  union:\n    - box",
     "  union:\n    - 3\n    - box",
     {"scene.union.0: a number where a mapping is expected, with one"}},
    {"  - {shape: {sphere: {center_m: [1, 2, 3], radius_m: 2}}, ",
     "  - {falloff_m: 2, ",
     {"paint.0.falloff_m: applies to a shape, and none is given"}},
    {"{sphere: {center_m: [1, 2, 3], radius_m: 2}}",
     "{union: []}",
     {"paint.0.shape.union: an empty list where a list of"}},
    {"{sphere: {center_m: [1, 2, 3], radius_m: 2}}",
     "{union: {}}",
     {"paint.0.shape.union: a mapping where a list of"}},
    {"radius_m: 2}}", "radius_m: 2}, inert: true}", {"paint.0.shape.inert: belongs inside sphere"}},
    {"radius_m: 2}}", "radius_m: 2, radius: 2}}", {"sphere.radius: unknown key; did you mean radius_m?"}},
    {"{sphere: {center_m: [1, 2, 3], radius_m: 2}}",
     "{mesh: {file: \"\"}}",
     {"mesh.file: a file name is expected"}},
    {"domain: {", "arches: {edges: open}\ndomain: {", {"arches.edges: replaced by domain.sides"}},
    {"domain: {", "domain: {sides: {x_min: periodic}, ", {"domain.sides.x_min: 'periodic'"}},
    {"fps: 25",
     "fps: 25\ndeposition: {fines: 0.1, bulking: 1.5}",
     {"deposition.bulking: 1.5 times the share that fines leave (1 - 0.1)", "at most 1.11111 here"}},
    /* values that must fit each other */
    {"max_m: [56, 20, 46]",
     "max_m: [56, 4, 46]",
     {"scene.union.0.box.max_m: not above min_m on the y axis (4, 4)"}},
    {"normal: [0, 0, 1]", "normal: [0, 0, 0]", {"plane.normal: is zero"}},
    {"direction: [0.8, 0.6, 0]", "direction: [0, -0, 0]", {"wind.direction: is zero"}},
    {"to_m: [0, 0, 9], radius_m", "to_m: [0, 0, 0], radius_m", {"cylinder.to_m: the same point as from_m"}},
    {"radius_m: 1}",
     "radius_m: 1, top_radius_m: -0.5}",
     {"cylinder.top_radius_m: negative (0 or more, or -1"}},
    {"to_m: 48", "to_m: 36", {"strata.1.to_m: 36 m is not above the layer below, which reaches to 36 m"}},
    {"  - to_m: 48",
     "  - weak_m_per_kyr: 1\n  - to_m: 48",
     {"strata.2.to_m: 48 m is not above the layer below"}},
    {"[main, top-2]", "[main, side]", {"output.aov.cameras.1: no camera 'side' in cameras"}},
    {"[main, top-2]", "[main, main]", {"output.aov.cameras.1: camera 'main' is listed twice"}},
    {"position_m: [0, 0, 99]", "position_m: [0, 0, 0]", {"cameras.top-2: the same point as position_m"}},
    {"position_m: [0, 0, 99]",
     "position_m: {1001: [0, 0, 9], 1010: [0, 0, 0]}",
     {"cameras.top-2: the same point as position_m"}},
    {"position_m: [0, 0, 99]",
     "position_m: {1001: [0, 0]}",
     {"cameras.top-2.position_m.1001: a list of another length"}},
    {"position_m: [0, 0, 99]", "position_m: {1001: 4}", {"where a list of 3 numbers is expected"}},
    {"position_m: [0, 0, 99]", "position_m: {x: [0, 0, 9]}", {"not a frame"}},
    {"distance_m: 90", "distance_m: -90", {"cameras.main.orbit.distance_m: -90 is out of range"}},
    /* YAML a job has no use for */
    {"fps: 25", "fps: &f 25", {"job.yaml:5:9: anchors (&) and aliases (*) are not allowed"}},
    {"fps: 25", "fps: *f", {"job.yaml:5:6: anchors (&) and aliases (*) are not allowed"}},
    {"fps: 25", "<<: {fps: 25}", {"job.yaml:5:1: merge keys (<<) are not allowed"}},
    {"fps: 25", "fps: !!int 25", {"tags (!) are not allowed"}},
    {"noise: {", "noise: !lua {", {"tags (!) are not allowed"}},
    {"fps: 25", "? [fps]\n: 25", {"a list or mapping cannot be a key"}},
    {"fps: 25", "---\nfps: 25", {"more than one document"}},
    {"fps: 25", "fps: [25", {"not YAML: "}},
    {"fps: 25", " fps: 25", {"job.yaml:4:9: not YAML: "}},
    {"\"Zo\\u00eb\"", "\"a\\0b\"", {"a NUL character in a text"}},
    {"fps: 25", "fps: 2\xff", {"job.yaml:5:7: not UTF-8 text"}},
    {"fps: 25", "fps: 2\xc0\x80", {"job.yaml:5:7: not UTF-8 text"}},
    {"fps: 25", "fps: 2\xed\xa0\x80", {"not UTF-8 text"}},
};

/* The stderr of fn(), which must stay silent: libraries print where they like. */
static void expect_silence(void (*run)(void))
{
    fflush(stderr);
    int keep = dup(2), log = open("stderr", O_RDWR | O_CREAT | O_TRUNC, 0600);
    assert_true(keep >= 0 && log >= 0);
    assert_int_equal(dup2(log, 2), 2);
    run();
    fflush(stderr);
    assert_int_equal(dup2(keep, 2), 2);
    struct stat info;
    assert_int_equal(fstat(log, &info), 0);
    close(keep);
    close(log);
    assert_int_equal(info.st_size, 0);
}

static int n_failed;

static void check_message(const char *what, status st, status want, const char *const says[3])
{
    if (st != want) {
        print_message("# %s: status %d, not %d (%s)\n", what, (int)st, (int)want,
                      st == OK ? "" : status_message());
        n_failed++;
        return;
    }
    for (int k = 0; k < 3 && says[k]; k++)
        if (!strstr(status_message(), says[k])) {
            print_message("# %s: says '%s', not '%s'\n", what, status_message(), says[k]);
            n_failed++;
        }
}

static void each_wrong(void)
{
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct job *job = NULL;
        char *text = swapped(good_job, wrong[i].from, wrong[i].to);
        status st = load_text(text, &job);
        check_message(wrong[i].to, st, E_USAGE, wrong[i].says);
        assert_null(job);
        free(text);
    }
}

static void mistakes_are_refused_with_place_and_reason(void **state)
{
    (void)state;
    n_failed = 0;
    expect_silence(each_wrong);
    assert_int_equal(n_failed, 0);
}

static const struct {
    const char *set;
    const char *says[3];
} wrong_set[] = {
    {"fps", {"--set fps: write key.path=value"}},
    {"=3", {"--set =3: write key.path=value"}},
    {"", {"write key.path=value"}},
    {"wind..speed_m_s=3", {"--set wind..speed_m_s: not a key path"}},
    {"wind.=3", {"--set wind.: not a key path"}},
    {".wind=3", {"not a key path"}},
    {"strata[0=3", {"not a key path"}},
    {"strata[]=3", {"not a key path"}},
    {"strata[0]to_m=3", {"not a key path"}},
    {"strata]0.to_m=3", {"not a key path"}},
    {"wind.sped_m_s=3", {"--set wind.sped_m_s: unknown key; did you mean speed_m_s?"}},
    {"wnd.speed_m_s=3", {"--set wnd.speed_m_s: wnd: unknown key; did you mean wind?"}},
    {"wind.speed_m_s=2000", {"--set wind.speed_m_s: 2000 is out of range (0..1000 m/s)"}},
    {"wind.speed_m_s={1: 2, 3: 2000}", {"--set wind.speed_m_s: wind.speed_m_s.3: 2000 is out of range"}},
    {"wind.speed_m_s=", {"--set wind.speed_m_s: an empty value where a number"}},
    {"wind.speed_m_s=[", {"--set wind.speed_m_s: column", "not YAML: "}},
    {"wind.speed_m_s=&a 3", {"--set wind.speed_m_s: column 4 of the value: anchors"}},
    {"wind.speed_m_s=1\n---\n2", {"more than one document"}},
    {"wind.speed_m_s=\xff", {"not UTF-8"}},
    {"seed.x=3", {"job.yaml:6:7: seed: --set seed.x reaches into a number; set the whole of it"}},
    {"strata.7.to_m=3", {"--set strata.7.to_m: 7 is not one of the list's 2 items"}},
    {"strata.x.to_m=3", {"--set strata.x.to_m: x is not one of the list's 2 items"}},
    {"strata.-1.to_m=3", {"-1 is not one of the list's 2 items"}},
    {"strata.99999999999999999999.to_m=3", {"is not one of the list's"}},
    {"strata.0.to_m=60", {"strata.1.to_m: 48 m is not above the layer below, which reaches to 60 m"}},
    {"output.aov.cameras=[x]", {"--set output.aov.cameras: output.aov.cameras.0: no camera 'x' in cameras"}},
    {"cameras=[]", {"--set cameras: a list where a mapping {name: {...}, ...} is expected"}},
    {"cameras={}", {"output.aov.cameras.0: no camera 'main': the job has no cameras"}},
    {"domain.spacing_m=1e4", {NULL}},
    {"cameras.new.resolution.0=99",
     {"--set cameras.new.resolution.0: cameras.new.resolution: a mapping where a list"}},
    {"a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a."
     "a.a.a.a.a."
     "a.a.a.a.a.a.a.a.a=1",
     {"more than 64 keys deep"}},
};

static void each_wrong_set(void)
{
    write_bytes("job.yaml", good_job, strlen(good_job));
    for (size_t i = 0; i < sizeof wrong_set / sizeof *wrong_set; i++) {
        struct job *job = NULL;
        const char *const sets[] = {"fps=30", wrong_set[i].set};
        status st = job_load("job.yaml", sets, 2, &job);
        check_message(wrong_set[i].set, st, wrong_set[i].says[0] ? E_USAGE : OK, wrong_set[i].says);
        job_destroy(&job);
    }
}

static void wrong_sets_are_refused(void **state)
{
    (void)state;
    n_failed = 0;
    expect_silence(each_wrong_set);
    assert_int_equal(n_failed, 0);
}

static void missing_files_and_folders_are_input_errors(void **state)
{
    (void)state;
    struct job *job = NULL;
    assert_int_equal(job_load("nowhere/job.yaml", NULL, 0, &job), E_INPUT);
    assert_non_null(strstr(status_message(), "nowhere/job.yaml"));
    assert_int_equal(job_load("/", NULL, 0, &job), E_INPUT);
    assert_int_equal(job_load("/dev/zero", NULL, 0, &job), E_INPUT);
    assert_null(job);
}

static void documents_that_are_no_job(void **state)
{
    (void)state;
    static const char *const texts[] = {"",     "\n", "# nothing\n",       "---\n", "12", "[1, 2]",
                                        "text", "{}", "%YAML 1.2\n---\n{}"};
    struct job *job = NULL;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        assert_int_equal(load_text(texts[i], &job), E_USAGE);
        assert_non_null(strstr(status_message(), "job.yaml:"));
    }
    const char nul[] = "name: a\0b\n";
    write_bytes("job.yaml", nul, sizeof nul - 1);
    assert_int_equal(job_load("job.yaml", NULL, 0, &job), E_USAGE);
    assert_non_null(strstr(status_message(), "job.yaml:1:8: a NUL byte"));
}

/* `unit` repeated up to `size` bytes between head and tail. */
static status load_repeated(const char *head, const char *unit, const char *tail, size_t size,
                            struct job **job)
{
    size_t n = strlen(head), step = strlen(unit), room = size + n + step + strlen(tail) + 1;
    char *text = malloc(room);
    assert_non_null(text);
    memcpy(text, head, n);
    while (n < size) {
        memcpy(text + n, unit, step);
        n += step;
    }
    memcpy(text + n, tail, strlen(tail));
    n += strlen(tail);
    write_bytes("job.yaml", text, n);
    free(text);
    return job_load("job.yaml", NULL, 0, job);
}

static const struct {
    const char *head, *unit, *tail, *says;
} heavy[] = {
    {"a: ", "[", "", "nested too deeply"},
    {"", "{", "", "nested too deeply"},
    {"", "[{a: ", "", "nested too deeply"},
    {"", "- ", "", "nested too deeply"},
    {"", "? ", "", "job.yaml:1:3: a list or mapping cannot be a key"},
    {"", ": ", "", "nested too deeply"},
    {"", "\n", "", "job.yaml:"},
    {"", "# x\n", "", "job.yaml:"},
    {"a: '", "x", "'", "a text of more than 4096 bytes"},
    {"", "x", "", "a text of more than 4096 bytes"},
    {"\"", "\\n", "\"", "a text of more than 4096 bytes"},
    {"a: |\n", "  b\n", "", "a text of more than 4096 bytes"},
    {"a: [", "1,", "1]", "more than 100000 items"},
    {"", "- a\n", "", "more than 100000 items"},
    {"{", "a: 1,", "}", "more than 100000 items"},
    {"[", "[a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a],", "]",
     "more than 1000000 values"},
    {"strata: [", "{},", "{}]", "job.yaml:"},
    {"", "&a ", "", "job.yaml:"},
    {"", "!a ", "", "job.yaml:"},
    {"", "*a ", "", "job.yaml:"},
    {"", "%a\n", "", "job.yaml:"},
    {"", "---\n", "", "job.yaml:"},
    {"", "'", "", "job.yaml:"},
    {"", "\t", "", "job.yaml:"},
    {"", "[a]: b\n", "", "job.yaml:"},
    {"[", "[a,b]: c, ", "]", "job.yaml:"},
    {"a: [", "{b: c, d: [e]}, ", "]", "job.yaml:"},
    {"", "a\r", "", "job.yaml:"},
    {"a: ", "b\n ", "", "job.yaml:"},
};

static void each_heavy(void)
{
    for (size_t i = 0; i < sizeof heavy / sizeof *heavy; i++) {
        if (!effort_takes(i))
            continue;
        struct job *job = NULL;
        clock_t start = clock(); /* of this process alone: others may keep the machine busy */
        status st = load_repeated(heavy[i].head, heavy[i].unit, heavy[i].tail, (4 << 20) - 99, &job);
        const char *const says[3] = {heavy[i].says};
        check_message(heavy[i].unit, st, E_USAGE, says);
        double took = (double)(clock() - start) / CLOCKS_PER_SEC;
        if (took > 20) {
            print_message("# %s takes %.1f s\n", heavy[i].unit, took);
            n_failed++;
        }
    }
}

static void heavy_files_are_refused_soon(void **state)
{
    (void)state;
    n_failed = 0;
    expect_silence(each_heavy);
    assert_int_equal(n_failed, 0);
    struct job *job = NULL;
    assert_int_equal(load_repeated("", "#", "\n", 5 << 20, &job), E_INPUT);
}

static void alias_bombs_do_not_go_off(void **state)
{
    (void)state;
    char text[2000];
    size_t n = (size_t)snprintf(text, sizeof text, "a0: &a0 [x, x, x, x, x, x, x, x, x]\n");
    for (int i = 1; i < 20; i++)
        n += (size_t)snprintf(text + n, sizeof text - n, "a%d: &a%d [*a%d, *a%d, *a%d, *a%d, *a%d, *a%d]\n",
                              i, i, i - 1, i - 1, i - 1, i - 1, i - 1, i - 1);
    struct job *job = NULL;
    assert_int_equal(load_text(text, &job), E_USAGE);
    assert_non_null(strstr(status_message(), "anchors (&) and aliases (*) are not allowed"));
}

/* Shapes nest 24 deep, whether in the file or by --set; the resolved file of the deepest loads again. */
static void deep_shapes(void **state)
{
    (void)state;
    for (int depth = 20; depth <= 30; depth++) {
        char text[2000];
        size_t n = (size_t)snprintf(
            text, sizeof text, "{name: a, frames: 1, domain: {size_m: [1, 1, 1], spacing_m: 1}, scene: ");
        for (int i = 0; i < depth; i++)
            n += (size_t)snprintf(text + n, sizeof text - n, "{union: [");
        n += (size_t)snprintf(text + n, sizeof text - n, "{sphere: {center_m: [0, 0, 0], radius_m: 1}}");
        for (int i = 0; i < depth; i++)
            n += (size_t)snprintf(text + n, sizeof text - n, "]}");
        snprintf(text + n, sizeof text - n, "}");
        struct job *job = NULL;
        struct text again = {0};
        assert_int_equal(load_text(text, &job), depth <= 24 ? OK : E_USAGE);
        if (depth > 24) {
            assert_non_null(strstr(status_message(), "nested too deeply")
                                ? status_message()
                                : strstr(status_message(), "more than 24"));
            continue;
        }
        assert_int_equal(job_resolved(job, &again), OK);
        job_destroy(&job);
        job = load_good(again.data);
        job_destroy(&job);
        text_free(&again);
    }
}

static uint32_t random_bits(uint32_t *x)
{
    *x ^= *x << 13;
    *x ^= *x >> 17;
    *x ^= *x << 5;
    return *x;
}

/* One to four bytes of the good job replaced, removed, inserted or copied from elsewhere in it. */
static size_t mutate(char *text, size_t n, uint32_t *seed)
{
    static const char likely[] = "[]{},:-\n \"'#&*!|>%?@.0123456789eE+~<\\\t";
    for (uint32_t edits = 1 + random_bits(seed) % 4; edits > 0; edits--) {
        size_t at = random_bits(seed) % n, from = random_bits(seed) % n;
        char byte =
            random_bits(seed) % 4 ? likely[random_bits(seed) % (sizeof likely - 1)] : (char)random_bits(seed);
        switch (random_bits(seed) % 4) {
        case 0:
            text[at] = byte;
            break;
        case 1:
            memmove(text + at, text + at + 1, --n - at);
            break;
        case 2:
            memmove(text + at + 1, text + at, n++ - at);
            text[at] = byte;
            break;
        default:
            text[at] = text[from];
        }
    }
    return n;
}

static void each_mutation(void)
{
    uint32_t seed = 20250101;
    for (size_t i = effort_of(2000); i > 0; i--) {
        char text[sizeof good_job + 16];
        memcpy(text, good_job, sizeof good_job - 1);
        size_t n = mutate(text, sizeof good_job - 1, &seed);
        write_bytes("mutated.yaml", text, n);
        struct job *job = NULL;
        status st = job_load("mutated.yaml", NULL, 0, &job);
        if (st != OK) {
            assert_true(st == E_USAGE && job == NULL);
            assert_non_null(strstr(status_message(), "mutated.yaml:"));
            continue;
        }
        struct text page = {0};
        assert_int_equal(job_resolved(job, &page), OK);
        struct job *again = load_good(page.data);
        assert_true(hash_of(job) == hash_of(again));
        text_free(&page);
        job_destroy(&job);
        job_destroy(&again);
    }
}

static void mutated_jobs_are_refused_or_survive_the_round_trip(void **state)
{
    (void)state;
    expect_silence(each_mutation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_refused_with_place_and_reason),
        cmocka_unit_test(wrong_sets_are_refused),
        cmocka_unit_test(missing_files_and_folders_are_input_errors),
        cmocka_unit_test(documents_that_are_no_job),
        cmocka_unit_test(heavy_files_are_refused_soon),
        cmocka_unit_test(alias_bombs_do_not_go_off),
        cmocka_unit_test(deep_shapes),
        cmocka_unit_test(mutated_jobs_are_refused_or_survive_the_round_trip),
    };
    return cmocka_run_group_tests_name("job_wrong", tests, NULL, NULL);
}
