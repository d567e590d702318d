/* Wedges side by side: the same four on one worker and on two, one thread each.
 *
 *   farm HOODOO
 */
#include <sys/wait.h>
#include <unistd.h>

#include "bench/bench.h"

static const char job[] = "hoodoo: 1\nname: four\nframes: 1001-1010\nclock: {years_per_frame: 2000}\n"
                          "domain: {size_m: [16, 8, 12], spacing_m: 0.25}\n"
                          "scene: {box: {min_m: [2, 2, 0], max_m: [14, 6, 10]}}\n"
                          "strata: [{weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.01, interlock_MPa: 0.2}]\n"
                          "farm: {still_every: 0, turntable: 0, block_frames: 5}\n"
                          "wedge: {over: [{key: seed, values: [1, 2, 3, 4]}]}\n";

static int run(const char *const *argv)
{
    int how;
    pid_t pid = fork();
    if (pid == 0) {
        if (freopen("/dev/null", "w", stderr))
            execv(argv[0], (char *const *)argv);
        _exit(127);
    }
    return pid > 0 && waitpid(pid, &how, 0) == pid && WIFEXITED(how) ? WEXITSTATUS(how) : -1;
}

/* Seconds, or -1. */
static double farm(const char *hoodoo, const char *workers)
{
    double start = clock_seconds();
    const char *const argv[] = {hoodoo,      "submit", "four.yaml", "--to", "local",
                                "--workers", workers,  "--out",     "out",  NULL};
    const char *const clean[] = {"/bin/rm", "-rf", "out", NULL};
    const int code = run(argv);
    const double seconds = clock_seconds() - start;
    return code == 0 && run(clean) == 0 ? seconds : -1;
}

int main(int argc, char **argv)
{
    char folder[] = "/tmp/hoodoo-bench-XXXXXX", hoodoo[4096];
    if (argc < 2 || !realpath(argv[1], hoodoo) || !mkdtemp(folder) || chdir(folder) != 0)
        return 1;
    FILE *f = fopen("four.yaml", "w");
    if (!f || fputs(job, f) < 0 || fclose(f) != 0)
        return 1;
    setenv("LP_NUM_THREADS", "1", 1);
    setenv("OMP_NUM_THREADS", "1", 1);
    struct row row = {
        .name = "farm: 4 wedges on 2 workers", .unit = "s", .peer = "1 worker", .at_least = 1.6};
    for (int r = 0; r < 3; r++) {
        sample(&row.theirs, farm(hoodoo, "1"));
        sample(&row.ours, farm(hoodoo, "2"));
    }
    const char *const clean[] = {"/bin/rm", "-rf", folder, NULL};
    if (chdir("/") != 0 || run(clean) != 0)
        return 1;
    for (size_t r = 0; r < row.ours.n; r++)
        if (row.ours.at[r] < 0 || row.theirs.at[r] < 0)
            check(fail(E_OUTPUT, "a farm of the bench failed"));
    print_row(&row);
    return 0;
}
