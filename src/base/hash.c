#include "base/hash.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "base/memory.h"

uint64_t hash_bytes(const void *bytes, size_t n)
{
    return XXH3_64bits(bytes, n);
}

status hash_file(const char *path, uint64_t *hash, uint64_t *size)
{
    enum { CHUNK = 1 << 20 };
    status st = OK;
    char *chunk = NULL;
    XXH3_state_t *state = XXH3_createState();
    FILE *f = fopen(path, "rb");
    if (!f) {
        st = fail(E_INPUT, "%s: %s", path, strerror(errno));
        goto done;
    }
    TRY(memory_alloc(CHUNK, 1, "hashing a file", &chunk));
    if (!state) {
        st = fail(E_MEMORY, "out of memory: hashing %s", path);
        goto done;
    }
    XXH3_64bits_reset(state);
    *size = 0;
    for (size_t n; (n = fread(chunk, 1, CHUNK, f)) > 0; *size += n)
        XXH3_64bits_update(state, chunk, n);
    if (ferror(f))
        st = fail(E_INPUT, "%s: %s", path, strerror(errno));
    else
        *hash = XXH3_64bits_digest(state);
done:
    if (f)
        fclose(f);
    XXH3_freeState(state);
    free(chunk);
    return st;
}

const char *hash_text(uint64_t hash, char out[17])
{
    snprintf(out, 17, "%016" PRIx64, hash);
    return out;
}
