/* What hoodoo submit and hoodoo retry share. */
#ifndef HOODOO_CLI_SUBMIT_H
#define HOODOO_CLI_SUBMIT_H

#include "farm/farm.h"
#include "farm/submission.h"

struct submit_request {
    struct submission submission;
    bool dry_run, json;
    int progress; /* enum progress_style */
};

/* Hands the tasks of `f` (of f->chosen, if that is set) to the target, or prints what would be handed over. */
MUST_USE status submit_tasks(const struct submit_request *request, struct farm *f);

#endif
