#include "output/describe.h"

#include <stdio.h>

#include "output/exr.h"
#include "output/vdb.h"
#include "reader/reader.h"

status describe_ask(const char *kind, const char *path, struct text *out)
{
    status st = OK;
    struct reader_answer answer = {0};
    char depth[16], comma[2] = {out && out->comma ? '1' : '0', '\0'};
    snprintf(depth, sizeof depth, "%d", out ? out->depth : 0);
    const char *const word[] = {depth, comma, NULL};
    TRY(reader_ask(
        &(struct reader_question){.program = "hoodoo-read", .kind = kind, .path = path, .word = word},
        &answer));
    if (out && reader_size(&answer)) {
        TRY(reader_take_text(&answer, out));
        out->comma = true;
    }
done:
    reader_end(&answer);
    return st;
}

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

status exr_check(const char *path)
{
    return describe_ask("exr.check", path, NULL);
}

status exr_describe(const char *path, struct text *out)
{
    return describe_ask("exr.describe", path, out);
}
