/* hoodoo check JOB: reports errors and settings with surprising effects. Needs no device and writes nothing. */
#include <stdio.h>
#include <stdlib.h>

#include "cli/answer.h"
#include "cli/cli.h"
#include "job/job.h"
#include "run/advice.h"
#include "text/text.h"

struct found {
    const char *path;
    bool json;
    struct text json_text;
    size_t n;
};

static void print_one(struct found *f, const struct job *job, const struct advice *a)
{
    char place[300];
    job_key_place(f->path, a->key, place);
    f->n++;
    if (!f->json) {
        printf("%s: %s%s%s: %s\n", place, job->wedge.index ? job->name : "", job->wedge.index ? ": " : "",
               a->key, a->text);
        return;
    }
    json_object(&f->json_text, NULL);
    json_text(&f->json_text, "place", place);
    json_text(&f->json_text, "key", a->key);
    json_text(&f->json_text, "warning", a->text);
    if (job->wedge.index)
        json_integer(&f->json_text, "wedge", job->wedge.index);
    json_end_object(&f->json_text);
}

static status check_one(struct found *f, const struct job *job)
{
    status st = OK;
    struct advice_list a = {0};
    TRY(advice_collect(job, true, &a));
    for (size_t i = 0; i < a.n; i++)
        print_one(f, job, &a.item[i]);
done:
    advice_free(&a);
    return st;
}

/* Checks the job, or each of its wedges, whose values may be out of range too. */
static status check_all(struct found *f, const struct common *c)
{
    status st = OK;
    struct job *base = NULL, *wedge = NULL;
    TRY(job_load(f->path, c->sets.item, c->sets.n, &base));
    const size_t n = job_wedges(base);
    if (n == 0)
        TRY(check_one(f, base));
    for (size_t i = 1; i <= n; i++) {
        TRY(job_load_wedge(f->path, c->sets.item, c->sets.n, base, (int)i, &wedge));
        TRY(check_one(f, wedge));
        job_destroy(&wedge);
    }
done:
    job_destroy(&wedge);
    job_destroy(&base);
    return st;
}

status cli_check(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct found f = {0};
    bool help = false, strict = false;
    const struct option options[] = {
        OPTION_SET(&c),
        OPTION_JSON(&c),
        {"strict", NULL, OPTION_FLAG, &strict, "treat warnings as errors: exit code 2"}};
    TRY(options_parse(&usage_check, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    f.path = operands.item[0];
    f.json = c.json;
    if (f.json) {
        answer_begin(&f.json_text);
        json_array(&f.json_text, "warnings");
    }
    TRY(check_all(&f, &c));
    if (f.json) {
        json_end_array(&f.json_text);
        json_end_object(&f.json_text);
        TRY(answer_print(&f.json_text, true));
    } else if (f.n == 0) {
        printf("%s: no problems found\n", f.path);
    }
    if (strict && f.n)
        st = fail(E_USAGE, "%s: %zu warning%s", f.path, f.n, f.n == 1 ? "" : "s");
done:
    text_free(&f.json_text);
    arguments_free(&operands);
    common_free(&c);
    return st;
}
