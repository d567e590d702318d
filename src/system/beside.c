#include "system/beside.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool find_in(char out[BESIDE_PATH], const char *folder, const char *below, const char *name)
{
    int n = snprintf(out, BESIDE_PATH, "%s%s%s", folder, below, name);
    return n > 0 && n < BESIDE_PATH && access(out, R_OK) == 0;
}

/* A program of a bundle is executed by a loader, which /proc/self/exe then names; its launcher passes its own path as argv[0]
 * (farm/bundle/launch.c). */
bool beside_self(char out[BESIDE_PATH])
{
    const char *name = program_invocation_name;
    const ssize_t n = readlink("/proc/self/exe", out, BESIDE_PATH - 1);
    if (n <= 0 || n == BESIDE_PATH - 1)
        return false;
    out[n] = '\0';
    const char *file = strrchr(out, '/');
    if (!file || strncmp(file, "/ld-", 4) != 0)
        return file != NULL;
    if (name[0] != '/' || strlen(name) >= BESIDE_PATH)
        return false;
    strcpy(out, name);
    return true;
}

bool beside_find(const char *name, char out[BESIDE_PATH])
{
    const char *folder = getenv("HOODOO_LIBEXEC");
    char self[BESIDE_PATH];
    if (folder && *folder)
        return find_in(out, folder, "/", name);
    if (!beside_self(self))
        return false;
    *strrchr(self, '/') = '\0';
    return find_in(out, self, "/", name) || find_in(out, self, "/../libexec/hoodoo/", name);
}
