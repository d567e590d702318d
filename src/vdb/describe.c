#include "reader/describe.h"
#include "vdb/vdb.h"

status vdb_check(const char *path)
{
    return describe_ask("vdb.check", path, NULL);
}

status vdb_describe(const char *path, struct text *out)
{
    return describe_ask("vdb.describe", path, out);
}

status vdb_describe_lattices(const char *path, struct text *out)
{
    return describe_ask("vdb.lattices", path, out);
}
