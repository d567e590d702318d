#include "reader/translate.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "reader/calls.h"
#include "reader/serve.h"
#include "system/child.h"

/* Bytes of memory for its libraries. */
#define MEMORY ((uint64_t)2 << 30)

int translate(const char *driver, const char *path)
{
    const char *const argv[] = {"gdal_translate",        "-q", "-if",         driver, "-of", "GTiff", "-co",
                                "STREAMABLE_OUTPUT=YES", path, "/vsistdout/", NULL};
    static const char *const variable[][2] = {{"GDAL_DRIVER_PATH", "disable"},
                                              {"GDAL_PAM_ENABLED", "NO"},
                                              {"GDAL_NUM_THREADS", "1"},
                                              {"OPENBLAS_NUM_THREADS", "1"},
                                              {"OMP_NUM_THREADS", "1"}};
    struct stat info;
    char *words[sizeof argv / sizeof *argv];
    if (stat(path, &info) != 0) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        return CHILD_NOT_SET_UP;
    }
    for (size_t i = 0; i < sizeof variable / sizeof *variable; i++)
        setenv(variable[i][0], variable[i][1], 1);
    serve_limits(MEMORY, (uint64_t)info.st_size);
    if (calls_limit(true) != OK) {
        fprintf(stderr, "%s\n", status_message());
        return CHILD_NOT_SET_UP;
    }
    memcpy(words, argv, sizeof words);
    execvp(words[0], words);
    return errno == ENOENT ? CHILD_NO_PROGRAM : CHILD_NOT_SET_UP;
}
