/* A CSV of wedges, and each wedge's job. */
#include "fuzz/fuzz.h"

#include "job/job.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    static const char base[] = "hoodoo: 1\nname: n\nframes: 1-4\ndomain: {size_m: [8, 8, 8], spacing_m: 1}\n"
                               "scene: {box: {min_m: [1, 1, 0], max_m: [7, 7, 6]}}\n"
                               "strata: [{weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.01, interlock_MPa: 1}]\n"
                               "wedge: {csv: w.csv}\n";
    struct job *job = NULL;
    fuzz_file("w.csv", bytes, n);
    const char *path = fuzz_file("wedges.yaml", base, sizeof base - 1);
    const status st = job_load(path, NULL, 0, &job);
    fuzz_refused(st);
    const size_t wedges = st == OK ? job_wedges(job) : 0;
    for (size_t i = 1; i <= wedges && i <= 4; i++) {
        struct job *wedge = NULL;
        fuzz_refused(job_load_wedge(path, NULL, 0, job, (int)i, &wedge));
        job_destroy(&wedge);
    }
    job_destroy(&job);
    return 0;
}
