/* hoodoo new NAME: writes a job to start from. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/examples.h"
#include "text/nearest.h"
#include "text/text.h"

enum { NAME_MOST = 64, EXAMPLES_MOST = 256 };

/* Refers editors to the schema beside the examples; omitted from copies. */
static const char MODELINE[] = "# yaml-language-server:";

static bool good_name(const char *name)
{
    const size_t n = strlen(name);
    return n > 0 && n <= NAME_MOST &&
           strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == n;
}

/* Prints the names and the first comment line of each example. */
static void list_examples(void)
{
    for (const struct job_example *e = job_examples; e->name; e++)
        printf("%s\n    %s", e->name, strncmp(e->line[0], "# ", 2) == 0 ? e->line[0] + 2 : e->line[0]);
}

static status find_example(const char *like, const struct job_example **out)
{
    const char *known[EXAMPLES_MOST];
    size_t n = 0;
    for (*out = job_examples; (*out)->name; (*out)++) {
        if (strcmp((*out)->name, like) == 0)
            return OK;
        if (n < EXAMPLES_MOST)
            known[n++] = (*out)->name;
    }
    const char *near = nearest_word(like, known, n);
    return fail(E_USAGE, "--like %.64s: unknown example%s%s%s; 'hoodoo new --list' lists them", like,
                near ? "; did you mean " : "", near ? near : "", near ? "?" : "");
}

/* Adds a line of the example with its name replaced in the key `name`, in paths and in the output folder. */
static void add_renamed(struct text *t, const char *line, const char *from, const char *to)
{
    char key[NAME_MOST + 16], file[NAME_MOST + 16], folder[NAME_MOST + 16];
    snprintf(key, sizeof key, "name: %s\n", from);
    snprintf(file, sizeof file, "jobs/%s.yaml", from);
    snprintf(folder, sizeof folder, "out/%s", from);
    if (strcmp(line, key) == 0) {
        text_add(t, "name: %s\n", to);
        return;
    }
    while (*line) {
        if (strncmp(line, file, strlen(file)) == 0) {
            text_add(t, "%s.yaml", to);
            line += strlen(file);
        } else if (strncmp(line, folder, strlen(folder)) == 0) {
            text_add(t, "out/%s", to);
            line += strlen(folder);
        } else {
            text_add(t, "%c", *line++);
        }
    }
}

/* Writes a new file; an existing one is never overwritten. */
static status write_new(const char *path, const struct text *t)
{
    const int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0)
        return errno == EEXIST ? fail(E_USAGE, "%s already exists; choose another name", path)
                               : fail(E_OUTPUT, "%s: cannot be written: %s", path, strerror(errno));
    size_t at = 0;
    while (at < t->size) {
        const ssize_t k = write(fd, t->data + at, t->size - at);
        if (k < 0 && errno == EINTR)
            continue;
        if (k <= 0)
            break;
        at += (size_t)k;
    }
    const int bad = at < t->size ? errno : 0;
    if (close(fd) != 0 || at < t->size) {
        unlink(path);
        return fail(E_OUTPUT, "%s: cannot be written: %s", path, strerror(bad ? bad : errno));
    }
    return OK;
}

status cli_new(int argc, char **argv)
{
    status st = OK;
    struct arguments operands = {0};
    struct text t = {0};
    struct path path;
    const struct job_example *example;
    const char *like = "demo", *name;
    bool help = false, list = false;
    const struct option options[] = {
        {"like", "EXAMPLE", OPTION_TEXT, &like, "the example to copy (default: demo, an arch)"},
        {"list", NULL, OPTION_FLAG, &list, "list the examples"},
    };
    TRY(options_parse(&usage_new, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    if (list) {
        list_examples();
        goto done;
    }
    name = operands.n ? operands.item[0] : "";
    if (!good_name(name)) {
        st = fail(E_USAGE,
                  *name ? "'%.70s' is not a valid name; use 1 to 64 letters, digits, _ and -"
                        : "new: NAME is missing; write 'hoodoo new %.70s', for example",
                  *name ? name : "cliff");
        goto done;
    }
    TRY(find_example(like, &example));
    for (size_t i = 0; example->line[i]; i++)
        if (strncmp(example->line[i], MODELINE, sizeof MODELINE - 1) != 0)
            add_renamed(&t, example->line[i], example->name, name);
    TRY(text_status(&t));
    TRY(path_format(&path, "%s.yaml", name));
    TRY(write_new(path.text, &t));
    printf("%s: 'hoodoo plan %s' estimates its cost, 'hoodoo run %s' simulates it\n", path.text, path.text,
           path.text);
done:
    text_free(&t);
    arguments_free(&operands);
    return st;
}
