/* The answer of squeue, which a busy controller may cut anywhere. */
#include "fuzz/fuzz.h"

#include "farm/slurm_jobs.c" /* for read_queue() */

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    struct slurm_job *jobs = NULL;
    size_t n_jobs = 0, capacity = 0;
    char *answer = malloc(n + 1);
    if (!answer)
        abort();
    memcpy(answer, bytes, n);
    answer[n] = '\0';
    fuzz_refused(read_queue(answer, &jobs, &n_jobs, &capacity));
    for (size_t i = 0; i < n_jobs; i++)
        if (!is_id(jobs[i].id) || !*jobs[i].state)
            abort();
    free(jobs);
    free(answer);
    return 0;
}
