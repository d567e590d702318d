/* hoodoo report OUT: one static page of what is there. */
#include <stdio.h>
#include <string.h>

#include "base/atomic_file.h"
#include "base/signals.h"
#include "cli/cli.h"
#include "render/report.h"
#include "render/report_wedges.h"

status cli_report(int argc, char **argv)
{
    status st = OK;
    struct words operands = {0};
    struct report r = {0};
    struct text page = {0};
    char path[4300];
    bool help = false, no_pictures = false;
    const struct option options[] = {
        {"no-pictures", NULL, OPTION_FLAG, &no_pictures,
         "numbers and curves alone: quick, and small enough to mail"},
    };
    TRY(options_parse(&usage_report, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    signals_install();
    if (report_has_wedges(operands.word[0])) {
        TRY(report_wedges(operands.word[0], &page));
        TRY(text_status(&page));
        snprintf(path, sizeof path, "%.4096s/report/index.html", operands.word[0]);
        TRY(atomic_file_write(path, page.data, page.size));
        printf("%s\n", path);
        goto done;
    }
    TRY(report_gather(operands.word[0], &r));
    snprintf(path, sizeof path, "%.4096s/report", r.root);
    TRY(folder_make(path));
    atomic_file_sweep(path);
    if (!no_pictures)
        TRY(report_pictures(&r));
    report_page(&r, &page);
    TRY(text_status(&page));
    snprintf(path, sizeof path, "%.4096s/report/index.html", r.root);
    TRY(atomic_file_write(path, page.data, page.size));
    printf("%s\n", path);
done:
    text_free(&page);
    report_free(&r);
    words_free(&operands);
    return st;
}
