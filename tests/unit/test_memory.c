/* How much memory is left, by files as kernels show them: groups of both versions, groups in groups, nonsense. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/memory.h"
#include "effort.h"
#include "system/memory_limits.h"

enum { MIB = 1 << 20 };

struct file {
    const char *path, *content;
};

/* In a new folder below the test's own. */
static size_t left_in(const struct file *file, size_t n)
{
    static int number;
    char root[32], path[512];
    snprintf(root, sizeof root, "tree%d", number++);
    for (size_t i = 0; i < n; i++) {
        snprintf(path, sizeof path, "%s%s", root, file[i].path);
        for (char *slash = strchr(path, '/'); slash; slash = strchr(slash + 1, '/')) {
            *slash = '\0';
            mkdir(path, 0777);
            *slash = '/';
        }
        FILE *f = fopen(path, "w");
        assert_non_null(f);
        fputs(file[i].content, f);
        fclose(f);
    }
    return memory_available_below(root);
}
#define LEFT_IN(...)                                                                                         \
    left_in((const struct file[]){__VA_ARGS__},                                                              \
            sizeof((const struct file[]){__VA_ARGS__}) / sizeof(struct file))

/* What the trees share: 4 GiB are available. */
#define MACHINE                                                                                              \
    {                                                                                                        \
        "/proc/meminfo", "MemTotal:       8388608 kB\nMemFree:   1048576 kB\nMemAvailable:    4194304 kB\n"  \
    }
#define ALL ((size_t)4096 * MIB)

/* As a Debian 12 with systemd has it. */
#define MOUNTS_TWO                                                                                           \
    {                                                                                                        \
        "/proc/self/mountinfo",                                                                              \
            "22 29 0:20 / /proc rw,nosuid shared:5 - proc proc rw\n"                                         \
            "26 22 0:23 / /sys/fs/cgroup rw,nosuid,nodev,noexec,relatime shared:9 - cgroup2 cgroup2 "        \
            "rw,nsdelegate,memory_recursiveprot\n"                                                           \
    }
#define STEP "/sys/fs/cgroup/system.slice/slurmstepd.scope/job_7/step_0"

static void without_groups(void **state)
{
    (void)state;
    assert_int_equal(LEFT_IN(MACHINE), ALL);
    assert_int_equal(LEFT_IN({"/proc/nothing", ""}), SIZE_MAX);
    assert_int_equal(LEFT_IN({"/proc/meminfo", "MemFree: 12 kB\nMemAvailable: some\n"}), SIZE_MAX);
    assert_int_equal(LEFT_IN(MACHINE, {"/proc/self/cgroup", "0::/\n"}, MOUNTS_TWO), ALL);
}

static void a_group_of_version_two(void **state)
{
    (void)state;
    const struct file tree[] = {
        MACHINE,
        MOUNTS_TWO,
        {"/proc/self/cgroup", "0::/system.slice/slurmstepd.scope/job_7/step_0\n"},
        {STEP "/memory.max", "1073741824\n"},
        {STEP "/memory.high", "max\n"},
        {STEP "/memory.current", "805306368\n"},
        /* 256 + 128 + 64 MiB can be taken back */
        {STEP "/memory.stat", "anon 5000\nfile 400000000\ninactive_anon 7\nactive_anon 8\n"
                              "inactive_file 268435456\nactive_file 134217728\nslab_reclaimable 67108864\n"},
        {"/sys/fs/cgroup/memory.max", "5\n"}, /* the root of the hierarchy: read, too */
    };
    assert_int_equal(left_in(tree, 7), (size_t)(1024 - 768 + 256 + 128 + 64) * MIB);
    assert_int_equal(left_in(tree, 8), 5);
}

static void throttled_is_as_bad_as_limited(void **state)
{
    (void)state;
    assert_int_equal(LEFT_IN(MACHINE, MOUNTS_TWO, {"/proc/self/cgroup", "0::/a\n"},
                             {"/sys/fs/cgroup/a/memory.max", "1073741824\n"},
                             {"/sys/fs/cgroup/a/memory.high", "536870912\n"},
                             {"/sys/fs/cgroup/a/memory.current", "104857600\n"}),
                     (size_t)(512 - 100) * MIB);
}

/* The least of all levels counts, whichever it is; a level without limit says nothing. */
static void a_parent_limits_too(void **state)
{
    (void)state;
    static const char *const max[3][3] = {{"max", "629145600", "max"},
                                          {"629145600", "max", "2147483648"},
                                          {"2147483648", "1073741824", "629145600"}};
    for (int i = 0; i < 3; i++)
        assert_int_equal(LEFT_IN(MACHINE, MOUNTS_TWO, {"/proc/self/cgroup", "0::/a/b/c\n"},
                                 {"/sys/fs/cgroup/a/memory.max", max[i][0]},
                                 {"/sys/fs/cgroup/a/memory.current", "104857600\n"},
                                 {"/sys/fs/cgroup/a/b/memory.max", max[i][1]},
                                 {"/sys/fs/cgroup/a/b/memory.current", "104857600\n"},
                                 {"/sys/fs/cgroup/a/b/c/memory.max", max[i][2]},
                                 {"/sys/fs/cgroup/a/b/c/memory.current", "104857600\n"}),
                         (size_t)500 * MIB);
}

static void nothing_is_left(void **state)
{
    (void)state;
    static const char *const used[] = {"8589934592", "9589934592"};
    for (int i = 0; i < 2; i++)
        assert_int_equal(LEFT_IN(MACHINE, MOUNTS_TWO, {"/proc/self/cgroup", "0::/\n"},
                                 {"/sys/fs/cgroup/memory.max", "8589934592\n"},
                                 {"/sys/fs/cgroup/memory.current", used[i]}),
                         0);
    /* More page cache than is used is no reason to believe in more than the limit. */
    assert_int_equal(LEFT_IN(MACHINE, MOUNTS_TWO, {"/proc/self/cgroup", "0::/\n"},
                             {"/sys/fs/cgroup/memory.max", "1048576\n"},
                             {"/sys/fs/cgroup/memory.current", "1000\n"},
                             {"/sys/fs/cgroup/memory.stat", "inactive_file 99999999\n"}),
                     MIB);
}

/* In a container the hierarchy is mounted from the process's own group on, and the group's path may be told as the
 * machine knows it or as the container does. */
static void in_a_container(void **state)
{
    (void)state;
    static const struct {
        const char *group, *mounts, *folder;
        size_t left;
    } c[] = {
        {"0::/\n", "30 25 0:27 / /sys/fs/cgroup ro - cgroup2 cgroup rw\n", "", 1000},
        {"0::/docker/1f\n", "30 25 0:27 /docker/1f /sys/fs/cgroup ro - cgroup2 cgroup rw\n", "", 1000},
        {"0::/docker/1f/sub\n", "30 25 0:27 /docker/1f /sys/fs/cgroup ro - cgroup2 cgroup rw\n", "/sub",
         1000},
        {"0::/docker/1f\n", "30 25 0:27 /docker/1 /mnt/other ro - cgroup2 cgroup rw\n", "/../../mnt/other",
         ALL},
        {"0::/../out\n", "30 25 0:27 / /sys/fs/cgroup ro - cgroup2 cgroup rw\n", "/../out", ALL},
        {"0::/a b\n", "30 25 0:27 / /mnt/c\\040g rw shared:1 master:2 - cgroup2 - rw\n",
         "/../../../mnt/c g/a b", 1000},
        {"0::/a:b\n", "", "/a:b", 1000}, /* no list of mounts */
        {"", "", "", 1000},
    };
    for (size_t i = 0; i < sizeof c / sizeof *c; i++) {
        char path[128];
        snprintf(path, sizeof path, "/sys/fs/cgroup%s/memory.max", c[i].folder);
        assert_int_equal(LEFT_IN(MACHINE, {"/sys/fs/cgroup/there", ""}, {"/proc/self/cgroup", c[i].group},
                                 {"/proc/self/mountinfo", c[i].mounts}, {path, "1000\n"}),
                         c[i].left);
    }
}

/* As a Debian 10, a Slurm of version 1 or a Firecracker machine has it: memory is a hierarchy of its own, beside
 * one of version 2 that has no memory. */
#define HYBRID                                                                                               \
    MACHINE, {"/proc/self/cgroup", "10:cpuset:/\n9:name=systemd:/x\n4:cpu,memory:/slurm/uid_0\n0::/x\n"},    \
        {"/proc/self/mountinfo",                                                                             \
         "31 23 0:28 / /sys/fs/cgroup rw,relatime - tmpfs tmpfs rw,mode=755\n"                               \
         "34 31 0:31 / /sys/fs/cgroup/cpuset rw,relatime - cgroup cgroup rw,cpuset\n"                        \
         "35 31 0:32 / /sys/fs/cgroup/memory rw,relatime - cgroup cgroup rw,cpu,memory\n"                    \
         "41 31 0:38 / /sys/fs/cgroup/unified rw,relatime - cgroup2 cgroup2 rw\n"},                          \
    {                                                                                                        \
        "/sys/fs/cgroup/unified/x/cgroup.procs", "1\n"                                                       \
    }
#define ONE "/sys/fs/cgroup/memory"

static void a_group_of_version_one(void **state)
{
    (void)state;
    assert_int_equal(LEFT_IN(HYBRID, {ONE "/slurm/uid_0/memory.limit_in_bytes", "9223372036854771712\n"},
                             {ONE "/slurm/uid_0/memory.usage_in_bytes", "104857600\n"}),
                     ALL);
    assert_int_equal(
        LEFT_IN(HYBRID, {ONE "/slurm/uid_0/memory.limit_in_bytes", "1073741824\n"},
                {ONE "/slurm/uid_0/memory.usage_in_bytes", "805306368\n"},
                {ONE "/slurm/uid_0/memory.stat",
                 "cache 9\ninactive_file 1\nactive_file 1\nhierarchical_memory_limit 1073741824\n"
                 "total_cache 9\ntotal_inactive_file 268435456\ntotal_active_file 134217728\n"}),
        (size_t)(1024 - 768 + 256 + 128) * MIB);
    /* A parent that cannot be seen. */
    assert_int_equal(LEFT_IN(HYBRID, {ONE "/slurm/uid_0/memory.limit_in_bytes", "9223372036854771712\n"},
                             {ONE "/slurm/uid_0/memory.usage_in_bytes", "104857600\n"},
                             {ONE "/slurm/uid_0/memory.stat", "hierarchical_memory_limit 629145600\n"}),
                     (size_t)500 * MIB);
}

/* Of version 1 a parent counts its children only where it was told to. */
static void parents_of_version_one(void **state)
{
    (void)state;
    static const char *const counts[] = {"1\n", "0\n"};
    const size_t left[] = {(size_t)500 * MIB, (size_t)924 * MIB};
    for (int i = 0; i < 2; i++)
        assert_int_equal(LEFT_IN(HYBRID, {ONE "/slurm/uid_0/memory.limit_in_bytes", "1073741824\n"},
                                 {ONE "/slurm/uid_0/memory.usage_in_bytes", "104857600\n"},
                                 {ONE "/slurm/memory.use_hierarchy", counts[i]},
                                 {ONE "/slurm/memory.limit_in_bytes", "629145600\n"},
                                 {ONE "/slurm/memory.usage_in_bytes", "104857600\n"}),
                         left[i]);
}

static void nonsense(void **state)
{
    (void)state;
    static const char *const junk[] = {
        "",
        "\n",
        "-1\n",
        "nan\n",
        "0x\n0::\n:::\n::::::/\n- - - -\n - \n",
        "1 2 3 / /sys/fs/cgroup\\0 - cgroup2\n1 2 3 / /a\\77 a - cgroup2 b c\n"};
    for (size_t i = 0; i < sizeof junk / sizeof *junk; i++) {
        assert_int_equal(LEFT_IN({"/proc/meminfo", junk[i]}, {"/proc/self/cgroup", junk[i]},
                                 {"/proc/self/mountinfo", junk[i]}, {"/proc/self/limits", junk[i]},
                                 {"/proc/self/status", junk[i]}, {"/sys/fs/cgroup/memory.stat", junk[i]}),
                         SIZE_MAX);
        assert_int_equal(LEFT_IN(MACHINE, MOUNTS_TWO, {"/proc/self/cgroup", "0::/a\n"},
                                 {"/sys/fs/cgroup/a/memory.max", "1000\n"},
                                 {"/sys/fs/cgroup/a/memory.current", junk[i]},
                                 {"/sys/fs/cgroup/a/memory.stat", junk[i]}),
                         i < 4 ? 1000 : 1000 - (i == 5));
    }
}

static void own_limits(void **state)
{
    (void)state;
    const struct file process = {"/proc/self/status",
                                 "Name:\thoodoo\nVmSize:\t  204800 kB\nVmData:\t  102400 kB\n"};
    assert_int_equal(
        LEFT_IN(MACHINE, process,
                {"/proc/self/limits",
                 "Limit                     Soft Limit           Hard Limit           Units     \n"
                 "Max data size             unlimited            unlimited            bytes     \n"
                 "Max address space         1073741824           unlimited            bytes     \n"}),
        (size_t)(1024 - 200) * MIB);
    assert_int_equal(
        LEFT_IN(MACHINE, process,
                {"/proc/self/limits",
                 "Max data size             314572800            unlimited            bytes     \n"
                 "Max address space         1073741824           unlimited            bytes     \n"}),
        (size_t)(300 - 100) * MIB);
}

/* And as this machine has it. */
static void of_this_process(void **state)
{
    (void)state;
    int code;
    if (SANITIZED) {
        print_message("# skipped: no limit below the address space that the sanitizer has reserved\n");
        skip();
    }
    pid_t pid = fork();
    assert_true(memory_available() > MIB);
    if (pid == 0) {
        setrlimit(RLIMIT_AS, &(struct rlimit){(rlim_t)512 * MIB, (rlim_t)512 * MIB});
        size_t left = memory_available();
        _exit(left > 0 && left < (size_t)512 * MIB ? 0 : 1);
    }
    assert_int_equal(waitpid(pid, &code, 0), pid);
    assert_true(WIFEXITED(code));
    assert_int_equal(WEXITSTATUS(code), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_groups),
        cmocka_unit_test(a_group_of_version_two),
        cmocka_unit_test(throttled_is_as_bad_as_limited),
        cmocka_unit_test(a_parent_limits_too),
        cmocka_unit_test(nothing_is_left),
        cmocka_unit_test(in_a_container),
        cmocka_unit_test(a_group_of_version_one),
        cmocka_unit_test(parents_of_version_one),
        cmocka_unit_test(nonsense),
        cmocka_unit_test(own_limits),
        cmocka_unit_test(of_this_process),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
