/* A checkpoint with whatever index and chunks, under hashes of the file that are right. A seed that is a whole file loses its end. */
#include "fuzz/fuzz.h"

#include "base/hash.h"
#include "checkpoint/layout.h"
#include "text/text.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    struct checkpoint c = {0};
    struct text text = {0};
    struct file_end end = {0};
    if (n >= sizeof end && memcmp(bytes + n - 8, end_magic, 8) == 0)
        n -= sizeof end;
    const uint8_t *index = memmem(bytes, n, "{\n  \"", 5);
    end.index_at = index ? (size_t)(index - bytes) : 0;
    char *whole = malloc(n + sizeof end);
    if (!whole)
        abort();
    end.index_size = n - end.index_at;
    end.hash = hash_bytes(bytes, n);
    memcpy(end.magic, end_magic, sizeof end.magic);
    memcpy(whole, bytes, n);
    memcpy(whole + n, &end, sizeof end);
    const char *path = fuzz_file("c.ckpt", whole, n + sizeof end);
    free(whole);
    fuzz_refused(checkpoint_read(path, &c));
    checkpoint_free(&c);
    fuzz_refused(checkpoint_describe(path, &text));
    text_free(&text);
    return 0;
}
