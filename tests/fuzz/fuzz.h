/* What the fuzz targets share. Each target is one file: LLVMFuzzerTestOneInput() hands a reader bytes that anybody might hand it. The
 * reader may take them or refuse them with a sentence; the sanitizers and the limits of run.sh say what else happened. */
#ifndef HOODOO_FUZZ_H
#define HOODOO_FUZZ_H

#include <assert.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/status.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n);

/* The folder of this process, made at the first call; run.sh sets FUZZ_FOLDER and removes it. */
static inline const char *fuzz_folder(void)
{
    static char folder[256];
    if (!*folder) {
        const char *root = getenv("FUZZ_FOLDER");
        snprintf(folder, sizeof folder, "%s/hoodoo-fuzz-XXXXXX", root ? root : "/tmp");
        if (!mkdtemp(folder))
            abort();
    }
    return folder;
}

/* Writes a file of that name there; its path lasts until the next call. */
static inline const char *fuzz_file(const char *name, const void *bytes, size_t n)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", fuzz_folder(), name);
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(bytes, 1, n, f) != n || fclose(f) != 0)
        abort();
    return path;
}

/* A refusal has a sentence. */
static inline void fuzz_refused(status st)
{
    if (st != OK && !*status_message())
        abort();
}

#endif
