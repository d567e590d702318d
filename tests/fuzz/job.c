/* A job file. One that is taken is written out as it was understood, and that must load again with the same hash. */
#include "fuzz/fuzz.h"

#include "job/job.h"
#include "text/text.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    struct job *job = NULL, *again = NULL;
    struct text text = {0};
    uint64_t hash, hash_again;
    const status st = job_load(fuzz_file("job.yaml", bytes, n), NULL, 0, &job);
    fuzz_refused(st);
    if (st == OK && job_hash(job, &hash) == OK && job_resolved(job, &text) == OK) {
        if (job_load(fuzz_file("resolved.yaml", text.data, text.size), NULL, 0, &again) != OK ||
            job_hash(again, &hash_again) != OK || hash != hash_again) {
            fprintf(stderr, "the resolved job differs: %s\n%s", status_message(), text.data);
            abort();
        }
    }
    text_free(&text);
    job_destroy(&job);
    job_destroy(&again);
    return 0;
}
