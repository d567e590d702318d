/* hoodoo selftest: checks that this machine computes correct results, and measures its speed. */
#include "selftest/selftest.h"

#include <stdio.h>
#include <string.h>

#include "base/log.h"
#include "cli/cli.h"
#include "cli/examples.h"
#include "system/signals.h"

static status print(const struct findings *findings, bool json)
{
    status st = OK;
    struct text text = {0};
    TRY(json ? findings_json(findings, &text) : findings_markdown(findings, &text));
    printf("%s%s", text.data, json ? "\n" : "");
done:
    text_free(&text);
    return st;
}

static const char *const *demo_lines(void)
{
    const struct job_example *e = job_examples;
    while (strcmp(e->name, "demo") != 0)
        e++;
    return e->line;
}

status cli_selftest(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct selftest t = {.demo = demo_lines(), .stop = stop_requested};
    bool help = false;
    const struct option options[] = {
        OPTION_DEVICE(&c),
        {"quick", NULL, OPTION_FLAG, &t.quick, "coarser tests, about a minute instead of five"},
        OPTION_JSON(&c)};
    TRY(options_parse(&usage_selftest, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    t.device = c.device;
    signals_install();
    TRY(selftest_run(&t));
    TRY(print(&t.findings, c.json));
    const struct row *wrong = findings_first_wrong(&t.findings);
    if (wrong)
        st = fail(E_DEVICE, "%s computes wrong results: %s, %s: %s", t.findings.device.name, wrong->group,
                  wrong->name, wrong->why);
done:
    selftest_end(&t);
    arguments_free(&operands);
    common_free(&c);
    return st;
}
