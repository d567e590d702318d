#include "base/beside.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool find_in(char out[BESIDE_PATH], const char *folder, const char *below, const char *name)
{
    int n = snprintf(out, BESIDE_PATH, "%s%s%s", folder, below, name);
    return n > 0 && n < BESIDE_PATH && access(out, R_OK) == 0;
}

bool beside_find(const char *name, char out[BESIDE_PATH])
{
    const char *folder = getenv("HOODOO_LIBEXEC");
    char self[BESIDE_PATH];
    if (folder && *folder)
        return find_in(out, folder, "/", name);
    ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
    if (n <= 0)
        return false;
    self[n] = '\0';
    char *end = strrchr(self, '/');
    if (!end)
        return false;
    *end = '\0';
    return find_in(out, self, "/", name) || find_in(out, self, "/../libexec/hoodoo/", name);
}
