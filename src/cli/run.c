/* hoodoo run JOB: simulates, continuing from the state of the output folder. */
#include "run/run.h"

#include <stdio.h>

#include "base/log.h"
#include "cli/cli.h"
#include "output/folder.h"
#include "run/branch.h"
#include "system/progress.h"
#include "system/signals.h"

struct shown {
    struct progress progress;
    enum progress_style style;
};

static void show_begin(void *user, struct frame_range frames, size_t done)
{
    struct shown *s = user;
    progress_begin(&s->progress, s->style, frames, done);
}

static void show_frame(void *user, int frame, double volume_share, int iterations)
{
    struct shown *s = user;
    char note[64];
    snprintf(note, sizeof note, "stress %d iterations", iterations);
    progress_frame(&s->progress, frame, volume_share, note);
}

static void show_stage(void *user, int frame, const char *name)
{
    struct shown *s = user;
    progress_stage(&s->progress, frame, name);
}

/* Replaces the job by one of its wedges. */
static status load_wedge(const char *path, const struct common *c, int wedge, struct job **job)
{
    struct job *base = *job;
    status st = job_load_wedge(path, c->sets.item, c->sets.n, base, wedge, job);
    job_destroy(&base);
    return st;
}

status cli_run(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct job *job = NULL;
    struct shown shown = {0};
    struct path root, path, folder;
    const char *farm = NULL, *path_map = NULL;
    bool help = false, repair = false, change = false;
    int wedge = 0;
    const struct option options[] = {
        OPTION_OUT(&c),
        OPTION_FRAMES(&c),
        OPTION_DEVICE(&c),
        OPTION_SET(&c),
        OPTION_PROGRESS(&c),
        OPTION_RESUME(&c),
        OPTION_WEDGE(&wedge),
        OPTION_FROM(&c),
        {"farm", "DIR", OPTION_TEXT, &farm,
         "the farm's output folder; with --wedge, output goes to the wedge's folder in it"},
        {"path-map", "FILE", OPTION_TEXT, &path_map,
         "path mapping rules of an OpenJD session, applied to the job's input files"},
        {"continue", NULL, OPTION_FLAG, &change,
         "the job was changed from some frame on: keep the frames before, and make the others again from the nearest checkpoint; says first what is kept"},
        {"repair", NULL, OPTION_FLAG, &repair,
         "also restore damaged and missing checkpoints, by simulating again, from the start if necessary"}};
    TRY(options_parse(&usage_run, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    if (change && c.resume == RUN_NEVER) {
        st = fail(E_USAGE, "run: --continue keeps frames and --resume never discards them; choose one");
        goto done;
    }
    if (c.from)
        TRY(arguments_add(&c.sets, BRANCH_SET));
    TRY(job_load(operands.item[0], c.sets.item, c.sets.n, &job));
    TRY(path_join(&folder, "out", job->name));
    if (wedge) {
        TRY(load_wedge(operands.item[0], &c, wedge, &job));
    } else if (job_wedges(job)) {
        log_info(
            "this job has %zu wedges; simulating the job itself (--wedge N selects one of them, hoodoo submit runs all)",
            job_wedges(job));
    }
    if (path_map)
        TRY(job_map_paths(job, path_map));
    if (c.out)
        TRY(path_format(&root, "%s", c.out));
    else
        TRY(path_wedge(&root, farm ? farm : folder.text, wedge));
    if (c.from)
        TRY(branch_from(job, c.from, root.text));
    TRY(folder_prepare(root.text));
    TRY(path_join(&path, root.text, "log/run.log"));
    TRY(log_open(path.text));
    signals_install();
    shown.style = (enum progress_style)c.progress;
    TRY(run_job(job, &(struct run_options){.root = root.text,
                                           .device = c.device,
                                           .frames = c.frames,
                                           .resume = (enum run_resume)c.resume,
                                           .repair = repair,
                                           .change = change,
                                           .begin = show_begin,
                                           .frame = show_frame,
                                           .stage = show_stage,
                                           .stop = stop_requested,
                                           .user = &shown}));
done:
    progress_end(&shown.progress);
    job_destroy(&job);
    arguments_free(&operands);
    common_free(&c);
    return st;
}
