/* hoodoo report OUT: writes one static page about an output folder. */
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "farm/status.h"
#include "render/report.h"
#include "render/report_wedges.h"
#include "system/atomic_file.h"
#include "system/signals.h"

static status write_page(const char *root, bool pictures, const struct text *page)
{
    static const char *const without[] = {"report", "--no-pictures"};
    struct path path;
    struct recipe recipe = report_recipe(root);
    status st = OK;
    if (stop_requested())
        return fail(STOPPED, "stopped before the page was written; to continue, run the same command again");
    if (!pictures) {
        recipe.word = without;
        recipe.n_words = 2;
    }
    TRY(path_join(&path, root, "report/index.html"));
    TRY(product_write(&recipe, "report/index.html", page->data, page->size));
    printf("%s\n", path.text);
done:
    return st;
}

static status report_on_wedges(const char *root, struct text *page)
{
    status st = OK;
    bool sound = false;
    signals_install();
    TRY(report_wedges(root, page, &sound));
    TRY(write_page(root, true, page));
    if (!sound)
        st = fail(E_INPUT, "%s: no wedge has an undamaged frame yet; the page lists the state of each", root);
done:
    return st;
}

static status report_on_run(const char *root, bool pictures, struct text *page)
{
    status st = OK;
    struct report r = {0};
    struct path path;
    TRY(report_gather(root, &r));
    signals_install(); /* from here on files are written */
    TRY(path_join(&path, r.root, "report"));
    TRY(folder_make(path.text));
    folder_sweep(r.root);
    if (pictures)
        TRY(report_pictures(&r));
    TRY(report_page(&r, page));
    TRY(write_page(root, pictures, page));
    if (r.n_sound == 0)
        st = fail(
            E_INPUT,
            "%s: none of the %zu frames is complete and undamaged (%zu damaged, %zu missing); the page lists the problems",
            root, range_count(r.frames), r.n_damaged, r.n_missing);
done:
    report_free(&r);
    return st;
}

status cli_report(int argc, char **argv)
{
    status st = OK;
    struct arguments operands = {0};
    struct text page = {0};
    bool help = false, no_pictures = false, wedges;
    const struct option options[] = {
        {"no-pictures", NULL, OPTION_FLAG, &no_pictures,
         "numbers and curves only: fast, and small enough to mail"},
    };
    TRY(options_parse(&usage_report, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    TRY(farm_has_wedges(operands.item[0], &wedges));
    if (wedges)
        TRY(report_on_wedges(operands.item[0], &page));
    else
        TRY(report_on_run(operands.item[0], !no_pictures, &page));
done:
    text_free(&page);
    arguments_free(&operands);
    return st;
}
