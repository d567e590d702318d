#include "system/library.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "base/build.h"
#include "system/beside.h"

#define LIBRARY "hoodoo-vdb.so"

static pthread_once_t once = PTHREAD_ONCE_INIT;
static void *library;
static char why[BESIDE_PATH + 400];
static const char *(*message)(void);

static void *find(const char *name)
{
    void *at = dlsym(library, name);
    if (!at)
        snprintf(why, sizeof why, "the library has no function %s", name);
    return at;
}

/* The build must match, because the structs of another build may differ. */
static void load(void)
{
    char path[BESIDE_PATH];
    if (!beside_find(LIBRARY, path)) {
        snprintf(why, sizeof why, BESIDE_HINT, LIBRARY);
        return;
    }
    library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        snprintf(why, sizeof why, "%s", dlerror());
        return;
    }
    const char *build = find("hoodoo_build");
    void *said = find("status_message");
    if (build && said && strcmp(build, hoodoo_build) != 0)
        snprintf(why, sizeof why, "%s belongs to another build (%s); install both from the same build", path,
                 build);
    memcpy(&message, &said, sizeof message);
}

status library_find(const char *name, void *function)
{
    pthread_once(&once, load);
    void *at = *why ? NULL : dlsym(library, name);
    if (!at)
        return fail(E_OUTPUT, "OpenVDB files cannot be written: %s", *why ? why : name);
    memcpy(function, &at, sizeof at);
    return OK;
}

status library_status(status st)
{
    return st == OK ? OK : fail(st, "%s", message());
}
