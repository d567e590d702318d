/* Wedges side by side: the same four on one worker and on two, one thread each. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"

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
    const char *const argv[] = {hoodoo,      "submit", "four.yaml", "--to",  "local",
                                "--workers", workers,  "--out",     workers, NULL};
    return run(argv) == 0 ? clock_seconds() - start : -1;
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
    double one = farm(hoodoo, "1"), two = farm(hoodoo, "2");
    const char *const clean[] = {"/bin/rm", "-rf", folder, NULL};
    if (chdir("/") != 0 || run(clean) != 0)
        return 1;
    if (one < 0 || two < 0) {
        fprintf(stderr, "farm: a run failed\n");
        return 1;
    }
    printf("farm: 4 wedges, one thread each: 1 worker %.1f s, 2 workers %.1f s: %.2f of the time\n", one, two,
           two / one);
    return 0;
}
