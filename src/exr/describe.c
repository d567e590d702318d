#include "reader/describe.h"
#include "exr/exr.h"

status exr_check(const char *path)
{
    return describe_ask("exr.check", path, NULL);
}

status exr_describe(const char *path, struct text *out)
{
    return describe_ask("exr.describe", path, out);
}
