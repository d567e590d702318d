/* hoodoo VERB ...: calls the function of the verb, prints the message of a failure, and returns the exit code. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/build.h"
#include "base/log.h"
#include "base/version.h"
#include "cli/cli.h"
#include "system/begin.h"
#include "system/signals.h"
#include "text/nearest.h"
#include "text/text.h"

static const struct verb {
    const char *name, *operands, *summary;
    status (*call)(int argc, char **argv);
} verbs[] = {
#define VERB_ROW(verb, operands, summary) {#verb, operands, summary, cli_##verb},
    VERBS(VERB_ROW)
#undef VERB_ROW
};

enum { N_VERBS = sizeof verbs / sizeof *verbs };

static void print_help(void)
{
    printf("usage: hoodoo VERB [OPTIONS] ...\n\nErodes sandstone, frame by frame, for render farms.\n\n");
    enum { COLUMN = 24, WIDTH = 80 };
    for (size_t i = 0; i < N_VERBS; i++) {
        struct text t = {0};
        text_add(&t, "  %-8s %-*s", verbs[i].name, COLUMN - 12, verbs[i].operands);
        text_add_wrapped(&t, verbs[i].summary, COLUMN - 1, COLUMN, WIDTH);
        printf("%s", t.data ? t.data : "");
        text_free(&t);
    }
    printf("\n'hoodoo VERB -h' describes a verb and its options. Exit codes:\n");
#define CODE_LINE(name, code, text) printf("  %-3d %s\n", code, text);
    STATUS_MAP(CODE_LINE)
#undef CODE_LINE
}

static status unknown_verb(const char *word)
{
    const char *known[N_VERBS];
    for (size_t i = 0; i < N_VERBS; i++)
        known[i] = verbs[i].name;
    const char *near = nearest_word(word, known, N_VERBS);
    if (near)
        return fail(E_USAGE, "unknown verb '%.80s'; did you mean 'hoodoo %s'?", word, near);
    return fail(E_USAGE, "unknown verb '%.80s'; 'hoodoo --help' lists the verbs", word);
}

static status run_verb(int argc, char **argv)
{
    if (argc < 2) {
        print_help();
        return fail(E_USAGE, "no verb given");
    }
    if (strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "help") == 0) {
        print_help();
        return OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("hoodoo %s (%s, build %s)\n", hoodoo_version, hoodoo_commit, hoodoo_build);
        return OK;
    }
    for (size_t i = 0; i < N_VERBS; i++)
        if (strcmp(argv[1], verbs[i].name) == 0)
            return verbs[i].call(argc - 1, argv + 1);
    return unknown_verb(argv[1]);
}

int main(int argc, char **argv)
{
    process_begin();
    signals_end();
    status st = run_verb(argc, argv);
    /* Write errors, such as a full disk, may only show when buffered output is flushed. */
    if ((fflush(stdout) != 0 || ferror(stdout)) && st == OK)
        st = fail(E_OUTPUT, "standard output cannot be written: %s", strerror(errno));
    if (st != OK)
        log_error(status_message());
    return (int)st;
}
