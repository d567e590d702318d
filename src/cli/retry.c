/* hoodoo retry OUT [TASK]: submits what is not done again, to where the job was submitted and with the same options. */
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"
#include "cli/cli.h"
#include "cli/submit.h"
#include "farm/slurm_jobs.h"

/* Chooses the task of that name and those behind it. */
static status choose(struct farm *f, const char *name, int to)
{
    status st = OK;
    size_t task;
    char(*job)[SLURM_ID] = NULL;
    bool *active = NULL;
    TRY(farm_find(f, name, &task));
    if (to == TO_SLURM) {
        TRY(memory_alloc(f->graph.n, sizeof *job, "the jobs", &job));
        TRY(memory_alloc(f->graph.n, sizeof *active, "the jobs", &active));
        TRY(slurm_active(f, job));
        for (size_t i = 0; i < f->graph.n; i++)
            active[i] = *job[i] != '\0';
    }
    TRY(farm_choose(f, task, active));
done:
    free(job);
    free(active);
    return st;
}

status cli_retry(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct farm farm = {0};
    struct submit_request request = {.submission.to = -1};
    bool help = false;
    const struct option options[] = {
        {"dry-run", NULL, OPTION_FLAG, &request.dry_run, "print what would be submitted, and do nothing"},
        OPTION_PROGRESS(&c),
        OPTION_JSON(&c)};
    TRY(options_parse(&usage_retry, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    request.progress = c.progress;
    request.json = c.json;
    TRY(farm_open(operands.item[0], &farm));
    TRY(submission_read(farm.root.text, &request.submission));
    const int to = request.submission.to;
    if (to != TO_LOCAL && to != TO_SLURM) {
        st = fail(E_USAGE, "%s was submitted to %s: retry its tasks there", farm.root.text,
                  submission_name(to));
        goto done;
    }
    if (to == TO_LOCAL && request.submission.process.pid && !request.dry_run &&
        process_fate(&request.submission.process) != PROCESS_GONE) {
        st = fail(
            E_USAGE,
            "the tasks of %s are run by process %ld on %s, which tries failed ones again itself: wait for it, or 'hoodoo cancel' it first",
            farm.root.text, request.submission.process.pid, request.submission.process.host);
        goto done;
    }
    if (operands.n > 1)
        TRY(choose(&farm, operands.item[1], to));
    TRY(submit_tasks(&request, &farm));
done:
    submission_free(&request.submission);
    farm_free(&farm);
    arguments_free(&operands);
    common_free(&c);
    return st;
}
