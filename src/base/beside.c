#include "base/beside.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool is_there(char out[BESIDE_PATH], const char *folder, const char *way, const char *name)
{
    int n = snprintf(out, BESIDE_PATH, "%s%s%s", folder, way, name);
    return n > 0 && n < BESIDE_PATH && access(out, R_OK) == 0;
}

bool beside_find(const char *name, char out[BESIDE_PATH])
{
    const char *folder = getenv("HOODOO_LIBEXEC");
    char self[BESIDE_PATH];
    if (folder && *folder)
        return is_there(out, folder, "/", name);
    ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
    if (n <= 0)
        return false;
    self[n] = '\0';
    char *end = strrchr(self, '/');
    if (!end)
        return false;
    *end = '\0';
    return is_there(out, self, "/", name) || is_there(out, self, "/../libexec/hoodoo/", name);
}
