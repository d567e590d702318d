#include "cli/options.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "text/nearest.h"
#include "text/text.h"

status arguments_add(struct arguments *a, const char *argument)
{
    status st = memory_grow(&a->item, &a->capacity, a->n + 1, sizeof *a->item, "the arguments");
    if (st == OK)
        a->item[a->n++] = argument;
    return st;
}

void arguments_free(struct arguments *a)
{
    free(a->item);
    *a = (struct arguments){0};
}

void common_free(struct common *c)
{
    arguments_free(&c->sets);
}

/* ---- help */

/* A term, followed by its meaning in a column of its own. */
static void add_help(struct text *t, const char *term, const char *meaning)
{
    enum { COLUMN = 28, WIDTH = 80 };
    const bool fits = strlen(term) + 4 <= COLUMN;
    text_add(t, "  %-*s%s", COLUMN - 3, term, fits ? "" : "\n");
    text_add_wrapped(t, meaning, fits ? COLUMN - 1 : 0, COLUMN, WIDTH);
}

static void print_help(const struct usage *usage, const struct option *options, size_t n)
{
    enum { LONGEST = 76 };
    struct text t = {0};
    char term[256];
    text_add(&t, "usage: hoodoo %s%s%s%s\n\n", usage->verb, n ? " [OPTIONS]" : "",
             *usage->operands ? " " : "", usage->operands);
    text_add_wrapped(&t, usage->summary, 0, 0, 80);
    text_add(&t, "\n");
    for (size_t i = 0; i < n; i++) {
        const struct option *o = &options[i];
        struct text meaning = {0};
        snprintf(term, sizeof term, "--%s%s%s", o->name, o->value ? " " : "", o->value ? o->value : "");
        if (strlen(term) > LONGEST) { /* a long list of choices is moved into the meaning */
            snprintf(term, sizeof term, "--%s NAME", o->name);
            for (const char *s = o->value; *s; s++)
                text_add(&meaning, "%.*s", *s == '|' ? 2 : 1, *s == '|' ? ", " : s);
            text_add(&meaning, ": ");
        }
        text_add(&meaning, "%s", o->help);
        add_help(&t, term, meaning.data ? meaning.data : "");
        text_free(&meaning);
    }
    add_help(&t, "-h, --help", "print this help");
    printf("%s", t.data ? t.data : "");
    text_free(&t);
}

/* ---- values */

static status wrong_value(const struct usage *usage, const struct option *o, const char *value,
                          const char *what)
{
    return fail(E_USAGE, "%s: --%s %.80s: %s", usage->verb, o->name, value, what);
}

static status parse_number(const struct usage *usage, const struct option *o, const char *value)
{
    char *end;
    errno = 0;
    if (o->kind == OPTION_INT) {
        long whole = strtol(value, &end, 10);
        if (end == value || *end || errno || whole < INT_MIN || whole > INT_MAX)
            return wrong_value(usage, o, value, "not a whole number");
        *(int *)o->target = (int)whole;
        return OK;
    }
    double number = strtod(value, &end);
    if (end == value || *end || !isfinite(number))
        return wrong_value(usage, o, value, "not a number");
    *(double *)o->target = number;
    return OK;
}

static status parse_choice(const struct usage *usage, const struct option *o, const char *value)
{
    size_t length = strlen(value);
    const char *word = o->value;
    for (int i = 0;; i++) {
        size_t n = strcspn(word, "|");
        if (n == length && strncmp(word, value, n) == 0) {
            *(int *)o->target = i;
            return OK;
        }
        if (!word[n])
            break;
        word += n + 1;
    }
    return fail(E_USAGE, "%s: --%s %.80s: must be one of %s", usage->verb, o->name, value, o->value);
}

static status parse_value(const struct usage *usage, const struct option *o, const char *value)
{
    switch (o->kind) {
    case OPTION_FLAG:
        *(bool *)o->target = true;
        return OK;
    case OPTION_TEXT:
        *(const char **)o->target = value;
        return *value ? OK : wrong_value(usage, o, "''", "is empty");
    case OPTION_INT:
    case OPTION_NUMBER:
        return parse_number(usage, o, value);
    case OPTION_RANGE:
        if (range_parse(value, o->target) != OK)
            return fail(E_USAGE, "%s: --%s: %s", usage->verb, o->name, status_message());
        return OK;
    case OPTION_CHOICE:
        return parse_choice(usage, o, value);
    case OPTION_LIST:
        return arguments_add(o->target, value);
    }
    return OK;
}

/* ---- the line */

static status unknown_option(const struct usage *usage, const struct option *options, size_t n,
                             const char *argument)
{
    const char *known[64] = {"help"};
    size_t n_known = 1;
    for (size_t i = 0; i < n && n_known < sizeof known / sizeof *known; i++)
        known[n_known++] = options[i].name;
    char word[64];
    const char *name = argument + strspn(argument, "-");
    snprintf(word, sizeof word, "%.*s", (int)strcspn(name, "="), name);
    const char *near = nearest_word(word, known, n_known);
    if (near)
        return fail(E_USAGE, "%s: unknown option %.80s; did you mean --%s?", usage->verb, argument, near);
    return fail(E_USAGE, "%s: unknown option %.80s; 'hoodoo %s -h' lists them", usage->verb, argument,
                usage->verb);
}

/* Parses the option argv[*i]; increments *i if the next argument is its value. */
static status parse_option(const struct usage *usage, const struct option *options, size_t n, int argc,
                           char **argv, int *i)
{
    const char *argument = argv[*i];
    const struct option *o = NULL;
    const char *name = argument + 2;
    size_t length = strcspn(name, "=");
    const char *value = name[length] ? name + length + 1 : NULL;
    for (size_t k = 0; k < n && strncmp(argument, "--", 2) == 0; k++)
        if (strlen(options[k].name) == length && strncmp(options[k].name, name, length) == 0)
            o = &options[k];
    if (!o)
        return unknown_option(usage, options, n, argument);
    if (o->kind == OPTION_FLAG && value)
        return fail(E_USAGE, "%s: --%s takes no value", usage->verb, o->name);
    if (o->kind != OPTION_FLAG && !value) {
        /* An option is never taken as the value of the one before it: the mistake would surface much later. */
        if (*i + 1 >= argc || strncmp(argv[*i + 1], "--", 2) == 0)
            return fail(E_USAGE, "%s: --%s requires a value: --%s %s", usage->verb, o->name, o->name,
                        o->value);
        value = argv[++*i];
    }
    return parse_value(usage, o, value);
}

static status count_operands(const struct usage *usage, const struct arguments *operands)
{
    size_t least = 0, most = 0;
    for (const char *p = usage->operands; *p; p += strspn(p, " ")) {
        size_t length = strcspn(p, " ");
        const size_t name = length - (p[length - 1] == ']');
        bool many = name > 3 && strncmp(p + name - 3, "...", 3) == 0;
        least += *p != '[';
        most = many || most == SIZE_MAX ? SIZE_MAX : most + 1;
        p += length;
    }
    if (operands->n > most)
        return fail(E_USAGE, "%s: unexpected argument '%.80s'; usage: hoodoo %s [OPTIONS] %s", usage->verb,
                    operands->item[most], usage->verb, usage->operands);
    if (operands->n < least)
        return fail(E_USAGE, "%s: %s is missing; usage: hoodoo %s [OPTIONS] %s", usage->verb, usage->operands,
                    usage->verb, usage->operands);
    return OK;
}

status options_parse(const struct usage *usage, const struct option *options, size_t n, int argc, char **argv,
                     struct arguments *operands, bool *help)
{
    status st = OK;
    bool ended = false;
    *help = false;
    for (int i = 1; i < argc; i++) {
        const char *a = argv[i];
        if (ended || a[0] != '-' || a[1] == '\0') {
            TRY(arguments_add(operands, a));
        } else if (strcmp(a, "--") == 0) {
            ended = true;
        } else if (strcmp(a, "-h") == 0 || strcmp(a, "--help") == 0) {
            *help = true;
            print_help(usage, options, n);
            return OK;
        } else {
            TRY(parse_option(usage, options, n, argc, argv, &i));
        }
    }
    TRY(count_operands(usage, operands));
done:
    return st;
}
