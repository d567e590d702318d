/* hoodoo cancel OUT: stops a submitted job. */
#include "farm/cancel.h"
#include "cli/answer.h"
#include "cli/cli.h"
#include "text/text.h"

status cli_cancel(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct farm farm = {0};
    struct text answer = {0};
    bool help = false;
    const struct option options[] = {OPTION_JSON(&c)};
    TRY(options_parse(&usage_cancel, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    TRY(farm_open(operands.item[0], &farm));
    answer_begin(&answer);
    json_text(&answer, "folder", farm.root.text);
    TRY(farm_cancel(&farm, &answer));
    json_end_object(&answer);
    TRY(answer_print(&answer, c.json));
done:
    text_free(&answer);
    farm_free(&farm);
    arguments_free(&operands);
    common_free(&c);
    return st;
}
