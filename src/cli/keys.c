/* hoodoo keys: describes the keys of jobs, for people and for editors. */
#include <stdio.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli/cli.h"
#include "job/job.h"
#include "text/text.h"

enum { NARROW = 40, USUAL = 80, WIDE = 120 };

/* Width of the terminal, limited to a range in which lines read well. */
static int terminal_width(void)
{
    struct winsize w;
    if (!isatty(STDOUT_FILENO) || ioctl(STDOUT_FILENO, TIOCGWINSZ, &w) != 0 || w.ws_col == 0)
        return USUAL;
    return w.ws_col < NARROW ? NARROW : w.ws_col > WIDE ? WIDE : w.ws_col;
}

status cli_keys(int argc, char **argv)
{
    status st = OK;
    struct arguments operands = {0};
    struct text t = {0};
    bool help = false, schema = false, list = false;
    const struct option options[] = {
        {"list", NULL, OPTION_FLAG, &list, "print the path of every key, one per line, for completion"},
        {"schema", NULL, OPTION_FLAG, &schema,
         "print a JSON Schema, with which editors complete and check jobs"},
    };
    TRY(options_parse(&usage_keys, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    if (schema)
        TRY(job_schema(&t));
    else if (list)
        TRY(job_keys_list(&t));
    else
        TRY(job_keys(operands.n ? operands.item[0] : NULL, terminal_width(), &t));
    fwrite(t.data, 1, t.size, stdout);
done:
    text_free(&t);
    arguments_free(&operands);
    return st;
}
