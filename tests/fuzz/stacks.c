/* A file of stacks, under a hash that is right. */
#include "fuzz/fuzz.h"

#include "base/hash.h"
#include "stacks/file.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    struct stacks stacks = {0};
    uint32_t solid;
    uint8_t *whole = malloc(n + 8);
    if (!whole)
        abort();
    memcpy(whole, bytes, n);
    n = n >= 8 ? n - 8 : n;
    const uint64_t hash = hash_bytes(whole, n);
    memcpy(whole + n, &hash, sizeof hash);
    const status st = stacks_read(fuzz_file("s.stacks", whole, n + 8), &stacks, &solid);
    free(whole);
    fuzz_refused(st);
    if (st == OK)
        stacks_destroy(&stacks);
    return 0;
}
