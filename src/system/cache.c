#include "system/cache.h"

#include <stdlib.h>

bool cache_folder(struct path *out)
{
    static const struct {
        const char *variable, *folder;
    } places[] = {{"HOODOO_CACHE", ""}, {"XDG_CACHE_HOME", "hoodoo"}, {"HOME", ".cache/hoodoo"}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const char *value = getenv(places[i].variable);
        if (value && *value)
            return (*places[i].folder ? path_join(out, value, places[i].folder)
                                      : path_format(out, "%s", value)) == OK;
    }
    return false;
}

status temporary_folder(struct path *out)
{
    static const char *const variables[] = {"HOODOO_TMP", "TMPDIR"};
    for (size_t i = 0; i < sizeof variables / sizeof *variables; i++) {
        const char *value = getenv(variables[i]);
        if (value && *value)
            return path_format(out, "%s", value);
    }
    return path_format(out, "/tmp");
}
