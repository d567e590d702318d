/* A frame's manifest, under a hash of its own that is right: what anybody can write who reads src/output/FORMAT.md. */
#include "fuzz/fuzz.h"

#include "base/hash.h"
#include "output/folder.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    static const char self[] = ",\n  \"self_xxh3\": \"";
    char path[512], digits[17];
    struct manifest manifest = {0};
    const char *bad;
    /* A seed that is a whole manifest loses its own seal. */
    const uint8_t *old = memmem(bytes, n, self, sizeof self - 1);
    n = old ? (size_t)(old - bytes) : n;
    snprintf(path, sizeof path, "%s/frames", fuzz_folder());
    mkdir(path, 0777);
    char *sealed = malloc(n + sizeof self + 24);
    if (!sealed)
        abort();
    memcpy(sealed, bytes, n);
    hash_text(hash_bytes(bytes, n), digits);
    const int more = sprintf(sealed + n, "%s%s\"\n}\n", self, digits);
    fuzz_file("frames/n.1001.json", sealed, n + (size_t)more);
    free(sealed);
    const status st = manifest_read(fuzz_folder(), "n", 1001, &manifest);
    fuzz_refused(st);
    if (st == OK)
        fuzz_refused(manifest_check(fuzz_folder(), &manifest, true, &bad));
    manifest_free(&manifest);
    return 0;
}
