/* hoodoo plan JOB: estimates what a run would do and cost, without running it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "cli/answer.h"
#include "cli/cli.h"
#include "cli/plan_time.h"
#include "farm/cost.h"
#include "farm/describe.h"
#include "run/groups.h"
#include "run/memory.h"
#include "scene/scene.h"
#include "text/text.h"

/* Memory before anything is rehearsed. */
struct memory {
    uint64_t process;
    struct run_memory there; /* set if there is a device */
    uint64_t host_free;
    bool fits;
};

static void describe_memory(const struct model_estimate *e, const struct gpu *gpu, const struct memory *m,
                            struct text *t)
{
    if (gpu)
        json_text(t, "device", gpu_info(gpu)->name);
    json_integer(t, "device_bytes", (int64_t)e->device_bytes);
    if (gpu)
        json_integer(t, "device_free_bytes", (int64_t)m->there.device);
    json_integer(t, "host_bytes", (int64_t)e->host_bytes);
    static const char *const paces[PACES] = {"overlap", "alternate", "stream"};
    json_text(t, "frame_pace", paces[e->pace]);
    json_integer(t, "process_bytes", (int64_t)m->process);
    json_integer(t, "host_free_bytes", (int64_t)m->host_free);
}

/* The files of the scene, with their volumes by their own measure and as they are sampled. */
static status describe_inputs(const struct job *job, struct text *t)
{
    status st = OK;
    struct scene_survey survey = {0};
    char sentence[600];
    const bool before = log_silence(true); /* the estimate has read the same files */
    if (!job->scene)
        goto done;
    TRY(scene_survey(job, &survey));
    if (!job_model(job)->terrain)
        TRY(scene_check(job, job->goblins.floats, &survey));
    log_silence(before);
    groups_describe(job, &survey.size, t);
    if (survey.n_inputs)
        json_array(t, "inputs");
    for (size_t i = 0; i < survey.n_inputs; i++) {
        const struct scene_input *in = &survey.input[i];
        if (scene_input_text(in, job->domain.spacing_m, sentence))
            log_warn("%s", sentence);
        json_object(t, NULL);
        json_text(t, "file", in->file);
        json_number(t, "own_m3", in->file_m3);
        json_number(t, "sampled_m3", in->sampled_m3);
        json_end_object(t);
    }
    if (survey.n_inputs)
        json_end_array(t);
done:
    log_silence(before);
    scene_survey_free(&survey);
    return st;
}

/* Without a device (`gpu` is NULL), what depends on the device is omitted. */
static status answer(struct farm *f, struct gpu *gpu, const struct plan_asked *asked,
                     const struct cost_asked *cost, bool words, const char *device, struct text *t)
{
    status st = OK;
    const struct job *job = f->wedge[0].job;
    const struct model_estimate e = f->wedge[0].estimate;
    struct plan_time time = {0};
    char frames[48];
    size_t n_frames = range_count(job->frames);
    struct memory memory = {.process = run_memory_process(gpu, &e), .host_free = memory_available()};
    if (gpu) {
        memory.there = run_memory_available(gpu);
        memory.fits = run_memory_fits(memory.there, run_memory_needed(gpu, &e, PACE_STREAM));
    }
    TRY(plan_frame_times(asked, gpu, f, &time));
    TRY(farm_graph(f));
    size_t n_checkpoints =
        (size_t)fmin((double)job->checkpoint.keep, ceil((double)n_frames / (double)job->checkpoint.every));
    answer_begin(t);
    json_text(t, "name", f->base->name);
    json_text(t, "model", job_model(job)->name);
    json_text(t, "frames", range_text(job->frames, frames));
    json_integer(t, "frame_count", (int64_t)n_frames);
    json_number(t, "years", job_years(job, job->frames.first, job->frames.last));
    TRY(describe_inputs(job, t));
    json_integer(t, "particles", (int64_t)e.n_particles);
    json_object(t, "voxels");
    json_integer(t, "x", e.voxels[0]);
    json_integer(t, "y", e.voxels[1]);
    json_integer(t, "z", e.voxels[2]);
    json_end_object(t);
    json_integer(t, "erosion_steps", (int64_t)e.steps);
    describe_memory(&e, gpu, &memory, t);
    struct disk_frame kinds;
    const uint64_t frame_bytes = disk_frames_bytes(job, &e.disk, job->frames, &kinds);
    json_integer(t, "frame_disk_bytes", (int64_t)disk_frame_bytes(&e.disk));
    json_object(t, "disk");
    json_integer(t, "points_bytes", (int64_t)kinds.points);
    json_integer(t, "usd_bytes", (int64_t)kinds.usd);
    json_integer(t, "volumes_bytes", (int64_t)kinds.volumes);
    json_integer(t, "pictures_bytes", (int64_t)kinds.pictures);
    json_integer(t, "checkpoints_bytes", (int64_t)(e.checkpoint_bytes * n_checkpoints));
    json_end_object(t);
    json_integer(t, "disk_bytes", (int64_t)(frame_bytes + e.checkpoint_bytes * n_checkpoints));
    if (time.job.wall > 0) {
        json_integer(t, "estimated_seconds", (int64_t)ceil(time.job.wall));
        if (time.job.cpu > 0)
            json_integer(t, "estimated_cpu_seconds", (int64_t)ceil(time.job.cpu));
        json_text(t, "estimated_from", time.from);
    }
    if (gpu)
        json_bool(t, "fits_in_memory", memory.fits);
    TRY(farm_describe(f, words, device, t));
    if (cost->n)
        TRY(cost_describe(&f->graph, cost, words, t));
    json_end_object(t);
    TRY(text_status(t));
done:
    return st;
}

status cli_plan(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct farm farm = {0};
    struct gpu *gpu = NULL;
    struct text t = {0};
    struct plan_asked asked = {.common = &c, .patience = 10};
    struct cost_asked cost = {0};
    const char *nodes = NULL, *price = NULL;
    bool help = false;
    int wedge = 0;
    const struct option options[] = {
        OPTION_OUT(&c),
        OPTION_DEVICE_OR_NONE(&c),
        OPTION_SET(&c),
        OPTION_WEDGE(&wedge),
        OPTION_FROM(&c),
        OPTION_JSON(&c),
        {"rehearse", "SECONDS", OPTION_NUMBER, &asked.patience,
         "time to spend on simulating the first frames on the device, from which the total time is estimated (default: 10; 0: no estimate)"},
        {"nodes", "N,N...", OPTION_TEXT, &nodes,
         "time, node hours and cost of the job on so many nodes, such as 1,4,16, each of which runs a task at a time"},
        {"price", "PRICE/h", OPTION_TEXT, &price,
         "the price of a node for an hour, such as 2.5/h (with --nodes)"}};
    TRY(options_parse(&usage_plan, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    if (asked.patience < 0) {
        st = fail(E_USAGE, "--rehearse %g: must be 0 or more seconds", asked.patience);
        goto done;
    }
    if (price && !nodes) {
        st = fail(E_USAGE, "--price needs --nodes");
        goto done;
    }
    if (nodes)
        TRY(cost_parse(nodes, price, &cost));
    asked.path = operands.item[0];
    TRY(farm_load(operands.item[0], c.sets.item, c.sets.n, c.from, wedge, c.out, &farm));
    const bool none = c.device && strcmp(c.device, "none") == 0;
    if (!none)
        TRY(gpu_create(&(struct gpu_options){.device = c.device}, &gpu));
    TRY(answer(&farm, gpu, &asked, &cost, !c.json, none ? NULL : c.device, &t));
    TRY(answer_print(&t, c.json));
done:
    text_free(&t);
    gpu_destroy(&gpu);
    farm_free(&farm);
    arguments_free(&operands);
    common_free(&c);
    return st;
}
