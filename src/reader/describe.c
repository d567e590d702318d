#include "reader/describe.h"

#include <stdio.h>

#include "reader/reader.h"

status describe_ask(const char *kind, const char *path, struct text *out)
{
    status st = OK;
    struct reader_answer answer = {0};
    char depth[16], comma[2] = {out && out->comma ? '1' : '0', '\0'};
    snprintf(depth, sizeof depth, "%d", out ? out->depth : 0);
    const char *const argument[] = {depth, comma, NULL};
    TRY(reader_ask(
        &(struct reader_question){.program = "hoodoo-read", .kind = kind, .path = path, .argument = argument},
        &answer));
    if (out && reader_size(&answer)) {
        TRY(reader_take_text(&answer, out));
        out->comma = true;
    }
done:
    reader_end(&answer);
    return st;
}
