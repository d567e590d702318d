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
    struct path path;
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
        TRY(path_join(&path, operands.word[0], "report/index.html"));
        TRY(atomic_file_write(path.text, page.data, page.size));
        printf("%s\n", path.text);
        goto done;
    }
    TRY(report_gather(operands.word[0], &r));
    TRY(path_join(&path, r.root, "report"));
    TRY(folder_make(path.text));
    atomic_file_sweep(path.text);
    if (!no_pictures)
        TRY(report_pictures(&r));
    report_page(&r, &page);
    TRY(text_status(&page));
    TRY(path_join(&path, r.root, "report/index.html"));
    TRY(atomic_file_write(path.text, page.data, page.size));
    printf("%s\n", path.text);
done:
    text_free(&page);
    report_free(&r);
    words_free(&operands);
    return st;
}
