/* hoodoo run JOB: simulate, from wherever the output folder stands. */
#include "model/run.h"

#include <stdio.h>

#include "base/log.h"
#include "cli/cli.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "output/folder.h"

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

status cli_run(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct words operands = {0};
    struct job *job = NULL;
    struct shown shown = {0};
    char root[4096], path[4200];
    bool help = false;
    const struct option options[] = {OPTION_OUT(&c), OPTION_FRAMES(&c),   OPTION_DEVICE(&c),
                                     OPTION_SET(&c), OPTION_PROGRESS(&c), OPTION_RESUME(&c),
                                     OPTION_FROM(&c)};
    TRY(options_parse(&usage_run, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    TRY(load_job(operands.word[0], &c, &job, root));
    TRY(folder_prepare(root));
    snprintf(path, sizeof path, "%s/log/run.log", root);
    TRY(log_open(path));
    signals_install();
    shown.style = (enum progress_style)c.progress;
    TRY(run_job(job, &(struct run_options){.root = root,
                                           .device = c.device,
                                           .frames = c.frames,
                                           .resume = (enum run_resume)c.resume,
                                           .begin = show_begin,
                                           .frame = show_frame,
                                           .stop = stop_requested,
                                           .user = &shown}));
done:
    progress_end(&shown.progress);
    job_destroy(&job);
    words_free(&operands);
    common_free(&c);
    return st;
}
