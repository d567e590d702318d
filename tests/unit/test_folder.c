/* The output folder: paths, manifests that vouch for files, files that are whole or absent. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#undef fail /* ours is another */

#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/hash.h"
#include "output/folder.h"
#include "system/atomic_file.h"
#include "text/json.h"
#include "unit/damage.h"

static void paths_are_those_of_the_design(void **state)
{
    (void)state;
    static const struct {
        enum folder_file kind;
        int frame;
        const char *camera, *path;
    } paths[] = {{FILE_POINTS, 1001, NULL, "out/arch/points/arch.1001.vdb"},
                 {FILE_VOLUMES, 7, NULL, "out/arch/volumes/arch.0007.vdb"},
                 {FILE_AOV, 1001, NULL, "out/arch/aov/arch.1001.exr"},
                 {FILE_AOV, 1001, "side", "out/arch/aov/arch.side.1001.exr"},
                 {FILE_MANIFEST, 123456, NULL, "out/arch/frames/arch.123456.json"},
                 {FILE_CHECKPOINT, 1010, NULL, "out/arch/checkpoint/arch.1010.ckpt"},
                 {FILE_MESH, -12, NULL, "out/arch/mesh/arch.-0012.ply"},
                 {FILE_STILL, -12, "stress", "out/arch/preview/arch.stress.-0012.png"},
                 {FILE_SHEET, -12, NULL, "out/arch/arch.contact.png"},
                 {FILE_VIDEO, 7, "stress", "out/arch/arch.stress.turntable.mp4"}};
    struct path path;
    char longest[5000];
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        assert_int_equal(
            folder_path(&path, "out/arch", "arch", paths[i].kind, paths[i].frame, paths[i].camera), OK);
        assert_string_equal(path.text, paths[i].path);
    }
    memset(longest, 'a', sizeof longest);
    longest[4090] = '\0';
    assert_int_equal(folder_path(&path, longest, "arch", FILE_AOV, 1, NULL), E_OUTPUT);
    assert_string_equal(path.text, "");
    assert_int_equal(folder_check_length(longest), E_OUTPUT);
    assert_int_equal(folder_prepare(longest), E_OUTPUT);
    longest[3583] = '\0';
    assert_int_equal(folder_check_length(longest), OK);
    assert_int_equal(folder_view(&path, "arch", "stress", -12, 7), OK);
    assert_string_equal(path.text, "turntable/arch.stress.-0012.007.png");
    assert_int_equal(folder_views(&path, "arch", NULL, -12), OK);
    assert_string_equal(path.text, "turntable/arch.-0012.%03d.png");
}

/* A frame of two files in `root`, and its manifest. */
static void make_frame(const char *root, int frame, struct manifest *m)
{
    static const char *const content[2] = {"not really points", "not really volumes"};
    assert_int_equal(folder_prepare(root), OK);
    *m = (struct manifest){.frame = frame,
                           .job_hash = 0xfedcba9876543210U,
                           .n_files = 2,
                           .file = calloc(2, sizeof *m->file),
                           .years = 1e6 / 3,
                           .volume_m3 = 1234.5678901234567,
                           .start_volume_m3 = 2000,
                           .max_stress_Pa = NAN,
                           .stress_iterations = 77,
                           .ledger = {1000, 700, 100, 50, 150}};
    for (int k = 0; k < 2; k++) {
        struct path path;
        assert_int_equal(folder_path(&path, root, "arch", k ? FILE_VOLUMES : FILE_POINTS, frame, NULL), OK);
        assert_int_equal(atomic_file_write(path.text, content[k], strlen(content[k])), OK);
        snprintf(m->file[k].path, sizeof m->file[k].path, "%s", path.text + strlen(root) + 1);
        assert_int_equal(hash_file(path.text, &m->file[k].hash, &m->file[k].size), OK);
    }
    assert_int_equal(manifest_write(root, "arch", m), OK);
}

static void manifests_come_back(void **state)
{
    (void)state;
    struct manifest in, out;
    make_frame("out", 1001, &in);
    assert_int_equal(manifest_read("out", "arch", 1001, &out), OK);
    assert_int_equal(out.frame, 1001);
    assert_true(out.job_hash == in.job_hash && out.years == in.years && out.volume_m3 == in.volume_m3 &&
                out.start_volume_m3 == in.start_volume_m3);
    assert_true(isnan(out.max_stress_Pa));
    assert_int_equal(out.stress_iterations, 77);
    assert_memory_equal(&out.ledger, &in.ledger, sizeof in.ledger);
    assert_int_equal(out.n_files, 2);
    for (int k = 0; k < 2; k++) {
        assert_string_equal(out.file[k].path, in.file[k].path);
        assert_true(out.file[k].size == in.file[k].size && out.file[k].hash == in.file[k].hash);
    }
    assert_int_equal(manifest_read("out", "arch", 1002, &out), E_INPUT);
    manifest_free(&in);
    manifest_free(&out);
}

static void manifests_are_the_same_each_time(void **state)
{
    (void)state;
    struct manifest m;
    size_t n[2];
    char *bytes[2];
    for (int k = 0; k < 2; k++) {
        make_frame(k ? "b" : "a", 1001, &m);
        bytes[k] = damage_read(k ? "b/frames/arch.1001.json" : "a/frames/arch.1001.json", &n[k]);
        manifest_free(&m);
    }
    assert_int_equal(n[0], n[1]);
    assert_memory_equal(bytes[0], bytes[1], n[0]);
    free(bytes[0]);
    free(bytes[1]);
}

static void missing_short_and_flipped_files_are_found(void **state)
{
    (void)state;
    struct manifest m;
    const char *bad = NULL;
    make_frame("out", 1001, &m);
    assert_int_equal(manifest_check("out", &m, true, &bad), OK);
    assert_string_equal(bad, "");

    assert_int_equal(unlink("out/points/arch.1001.vdb"), 0);
    assert_int_equal(manifest_check("out", &m, false, &bad), OK);
    assert_string_equal(bad, "points/arch.1001.vdb");
    assert_non_null(strstr(status_message(), "No such file"));

    damage_put("out/points/arch.1001.vdb", "not really point", 16);
    assert_int_equal(manifest_check("out", &m, false, &bad), OK);
    assert_string_equal(bad, "points/arch.1001.vdb");
    assert_non_null(strstr(status_message(), "16 bytes, but 17"));

    damage_put("out/points/arch.1001.vdb", "not_really points", 17);
    assert_int_equal(manifest_check("out", &m, false, &bad), OK);
    assert_string_equal(bad, "");
    assert_int_equal(manifest_check("out", &m, true, &bad), OK);
    assert_string_equal(bad, "points/arch.1001.vdb");
    assert_non_null(strstr(status_message(), "damaged"));
    manifest_free(&m);
}

static status read_copy(const char *path)
{
    struct manifest m;
    size_t n;
    char *bytes = damage_read(path, &n);
    damage_put("out/frames/copy.1001.json", bytes, n);
    free(bytes);
    const status st = manifest_read("out", "copy", 1001, &m);
    if (st == OK)
        manifest_free(&m);
    return st;
}

static void damaged_manifests_are_refused(void **state)
{
    (void)state;
    struct manifest m;
    make_frame("out", 1001, &m);
    assert_int_equal(read_copy("out/frames/arch.1001.json"), OK);
    damage_truncate("out/frames/arch.1001.json", read_copy, 400);
    damage_flip("out/frames/arch.1001.json", read_copy, 4000);
    damage_fuzz("out/frames/arch.1001.json", read_copy, 1000);
    manifest_free(&m);
}

/* Signed as a manifest signs itself. */
static status read_signed(const char *body)
{
    struct manifest m;
    char text[8192], hash[17];
    const int n = snprintf(text, sizeof text, "%s,\n  \"self_xxh3\": \"%s\"\n}\n", body,
                           hash_text(hash_bytes(body, strlen(body)), hash));
    damage_put("out/frames/evil.1001.json", text, (size_t)n);
    const status st = manifest_read("out", "evil", 1001, &m);
    if (st == OK)
        manifest_free(&m);
    return st;
}

static void hostile_manifests_are_refused(void **state)
{
    (void)state;
    static const char frame[] =
        "{\"kind\": \"hoodoo frame\", \"format\": %s, \"frame\": %s, \"job_xxh3\": "
        "\"0123456789abcdef\", \"output_xxh3\": \"0123456789abcdef\", \"years\": 1, \"files\": [{\"path\": "
        "\"%s\", \"size\": %s, "
        "\"xxh3\": \"%s\"}], \"statistics\": {\"volume_m3\": 1, \"start_volume_m3\": 2, "
        "\"max_stress_Pa\": 3, \"stress_iterations\": 4}, \"ledger\": {\"start\": 1, \"rock\": "
        "1, \"deposit\": 0, \"fallen\": 0, \"left\": %s}";
    static const struct {
        const char *format, *frame, *path, *size, *hash, *left;
        status want;
    } tries[] = {
        {"1", "1001", "points/a.vdb", "17", "0123456789abcdef", "0", OK},
        {"2", "1001", "points/a.vdb", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1002", "points/a.vdb", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1e3", "points/a.vdb", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "/etc/passwd", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "../a.vdb", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "points/../../a", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "points/..", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "points//a", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "./a", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "a\\u001bb", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "a\\u0000b", "17", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "points/a.vdb", "-1", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "points/a.vdb", "1.5", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "points/a.vdb", "99999999999999999999", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "points/a.vdb", "\"17\"", "0123456789abcdef", "0", E_INPUT},
        {"1", "1001", "points/a.vdb", "17", "0123456789ABCDEF", "0", E_INPUT},
        {"1", "1001", "points/a.vdb", "17", "0123456789abcde", "0", E_INPUT},
        {"1", "1001", "points/a.vdb", "17", "0123456789abcdef", "null", E_INPUT},
        {"1", "1001", "points/a.vdb", "17", "0123456789abcdef", "1}, {\"a\": 2", E_INPUT},
    };
    char body[4096];
    assert_int_equal(folder_prepare("out"), OK);
    for (size_t i = 0; i < sizeof tries / sizeof *tries; i++) {
        snprintf(body, sizeof body, frame, tries[i].format, tries[i].frame, tries[i].path, tries[i].size,
                 tries[i].hash, tries[i].left);
        const status st = read_signed(body);
        if (st != tries[i].want)
            print_error("try %zu: %s\n", i, status_message());
        assert_int_equal(st, tries[i].want);
    }
    assert_int_equal(read_signed("[1"), E_INPUT);
    assert_int_equal(read_signed("{\"a\": 1, \"a\": 2"), E_INPUT);
    char deep[5000];
    memset(deep, '[', sizeof deep);
    damage_put("out/frames/evil.1001.json", deep, sizeof deep);
    struct manifest m;
    assert_int_equal(manifest_read("out", "evil", 1001, &m), E_INPUT);
    assert_non_null(strstr(status_message(), "nested too deeply"));
}

static void frames_are_listed_in_order(void **state)
{
    (void)state;
    static const int frames[] = {1003, -5, 1001, 20000, 7};
    static const char *const other[] = {
        "arch.1004.json.tmp-1-2-3", "arch.01005.json", "arch.7.json",    "arch.x.json",
        "arches.1006.json",         "arch.1007.txt",   "arch.+1008.json"};
    int *found;
    size_t n;
    assert_int_equal(folder_prepare("list"), OK);
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        struct manifest m;
        make_frame("list", frames[i], &m);
        manifest_free(&m);
    }
    for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
        char path[256];
        snprintf(path, sizeof path, "list/frames/%s", other[i]);
        damage_put(path, "", 0);
    }
    assert_int_equal(folder_frames("list", "arch", &found, &n), OK);
    const int want[] = {-5, 7, 1001, 1003, 20000};
    assert_int_equal(n, 5);
    assert_memory_equal(found, want, sizeof want);
    free(found);
    assert_int_equal(folder_frames("nowhere", "arch", &found, &n), OK);
    assert_int_equal(n, 0);
    free(found);
    /* A new start sweeps what a killed one left long ago; what may be another machine's work under way stays.
     * */
    assert_int_equal(folder_prepare("list"), OK);
    assert_int_equal(access("list/frames/arch.1004.json.tmp-1-2-3", F_OK), 0);
    assert_int_equal(
        utimensat(AT_FDCWD, "list/frames/arch.1004.json.tmp-1-2-3", (struct timespec[2]){{0}}, 0), 0);
    assert_int_equal(folder_prepare("list"), OK);
    assert_int_equal(access("list/frames/arch.1004.json.tmp-1-2-3", F_OK), -1);
    assert_int_equal(access("list/frames/arch.1003.json", F_OK), 0);
}

static void a_folder_is_known_by_its_run(void **state)
{
    (void)state;
    static const struct {
        const char *run;
        status want;
    } runs[] = {{"{\"name\": \"arch_2-b\", \"version\": \"0.1.0\", \"inputs\": []}", OK},
                {"{\"name\": \"../evil\"}", E_INPUT},
                {"{\"name\": \"\"}", E_INPUT},
                {"{\"name\": 5}", E_INPUT},
                {"{\"name\": \"a\\u0007\"}", E_INPUT},
                {"[\"name\"]", E_INPUT},
                {"", E_INPUT},
                {"{\"name\": \"arch\"", E_INPUT}};
    char name[256];
    assert_int_equal(folder_open("no such folder", name), E_INPUT);
    assert_int_equal(folder_prepare("known"), OK);
    assert_int_equal(folder_open("known", name), E_INPUT);
    assert_non_null(strstr(status_message(), "not an output folder"));
    for (size_t i = 0; i < sizeof runs / sizeof *runs; i++) {
        damage_put("known/run.json", runs[i].run, strlen(runs[i].run));
        damage_put("known/job.yaml", "hoodoo: 1\n", 10);
        assert_int_equal(folder_open("known", name), runs[i].want);
        if (runs[i].want == OK)
            assert_string_equal(name, "arch_2-b");
    }
    damage_put("known/run.json", runs[0].run, strlen(runs[0].run));
    assert_int_equal(unlink("known/job.yaml"), 0);
    assert_int_equal(folder_open("known", name), E_INPUT);
}

/* Writes a first version that fits and a second one that does not: 4 on failure, as it should be. */
static int write_too_much(const char *path)
{
    static char much[1 << 20];
    if (atomic_file_write(path, "the old file", 12) != OK)
        return 1;
    const status st = atomic_file_write(path, much, sizeof much);
    return st == E_OUTPUT && strstr(status_message(), path) ? 4 : 2;
}

static void expect_old_file(const char *folder, const char *path)
{
    size_t n;
    char *bytes = damage_read(path, &n), command[512];
    assert_int_equal(n, 12);
    assert_memory_equal(bytes, "the old file", 12);
    free(bytes);
    /* and no temporary file beside it */
    snprintf(command, sizeof command, "test $(ls -A %s | wc -l) = 1", folder);
    assert_int_equal(system(command), 0);
}

static void a_full_disk_leaves_the_old_file(void **state)
{
    (void)state;
    assert_int_equal(folder_make("full"), OK);
    if (mount("tmpfs", "full", "tmpfs", 0, "size=64k") != 0) {
        print_message("# no tmpfs here (not root); the file size limit below tells the same\n");
        return;
    }
    const int code = write_too_much("full/file");
    expect_old_file("full", "full/file");
    assert_int_equal(umount("full"), 0);
    assert_int_equal(code, 4);
}

static void a_file_size_limit_leaves_the_old_file(void **state)
{
    (void)state;
    assert_int_equal(folder_make("limited"), OK);
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){100000, 100000});
        _exit(write_too_much("limited/file"));
    }
    int how;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(WEXITSTATUS(how), 4);
    expect_old_file("limited", "limited/file");
}

static void folders_that_cannot_be_made_are_named(void **state)
{
    (void)state;
    damage_put("a_file", "x", 1);
    assert_int_equal(folder_prepare("a_file/out"), E_OUTPUT);
    assert_non_null(strstr(status_message(), "a_file"));
    assert_int_equal(atomic_file_write("no/such/folder/file", "x", 1), E_OUTPUT);
}

/* A pipe nobody writes into would be waited for, without end. */
static void what_is_no_file_is_refused_at_once(void **state)
{
    (void)state;
    char *bytes = NULL;
    size_t n;
    assert_int_equal(mkfifo("pipe", 0600), 0);
    alarm(10);
    assert_int_equal(file_read("pipe", 100, &bytes, &n), E_INPUT);
    assert_string_equal(status_message(), "pipe: not a regular file");
    assert_int_equal(file_read(".", 100, &bytes, &n), E_INPUT);
    alarm(0);
    assert_null(bytes);
    assert_int_equal(remove("pipe"), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_file_is_refused_at_once),
        cmocka_unit_test(paths_are_those_of_the_design),
        cmocka_unit_test(manifests_come_back),
        cmocka_unit_test(manifests_are_the_same_each_time),
        cmocka_unit_test(missing_short_and_flipped_files_are_found),
        cmocka_unit_test(damaged_manifests_are_refused),
        cmocka_unit_test(hostile_manifests_are_refused),
        cmocka_unit_test(frames_are_listed_in_order),
        cmocka_unit_test(a_folder_is_known_by_its_run),
        cmocka_unit_test(a_full_disk_leaves_the_old_file),
        cmocka_unit_test(a_file_size_limit_leaves_the_old_file),
        cmocka_unit_test(folders_that_cannot_be_made_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
