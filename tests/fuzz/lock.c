/* The lock file of an output folder, which a disk or another program may have changed. */
#include "fuzz/fuzz.h"

#include "system/lock.c" /* for read_lock() */

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    struct seen seen;
    fuzz_refused(read_lock(fuzz_file("lock", bytes, n), &seen));
    if (!seen.there)
        abort();
    (void)process_fate(&seen.holder);
    return 0;
}
