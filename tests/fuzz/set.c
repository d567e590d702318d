/* --set: each line is one, over a small job. */
#include "fuzz/fuzz.h"

#include "job/job.h"

enum { SETS = 8 };

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    static const char base[] = "hoodoo: 1\nname: n\nframes: 1-4\ndomain: {size_m: [8, 8, 8], spacing_m: 1}\n"
                               "scene: {box: {min_m: [1, 1, 0], max_m: [7, 7, 6]}}\n"
                               "strata: [{weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.01, interlock_MPa: 1}]\n"
                               "cameras: {main: {position_m: [-9, 0, 5], target_m: [4, 4, 3]}}\n";
    char *text = malloc(n + 1);
    const char *sets[SETS];
    size_t n_sets = 0;
    struct job *job = NULL;
    if (!text)
        abort();
    memcpy(text, bytes, n);
    text[n] = '\0';
    for (char *at = text, *line; n_sets < SETS && (line = strsep(&at, "\n"));)
        sets[n_sets++] = line;
    fuzz_refused(job_load(fuzz_file("set.yaml", base, sizeof base - 1), sets, n_sets, &job));
    job_destroy(&job);
    free(text);
    return 0;
}
