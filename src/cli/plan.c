/* hoodoo plan JOB: what a run would do and take, without doing it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/words.h"
#include "farm/describe.h"
#include "gpu/primitives.h"
#include "run/room.h"

/* Device time of one particle in one step, in units of one word read and written, measured on lavapipe with
 * jobs/demo.yaml: what a plan's time rests on. Off by a factor of two is to be expected. */
static const double WORDS_PER_PARTICLE_STEP = 200;

/* Seconds a word takes to be read and written here: a gather, after one of a few words, which has the driver make what it
 * needs for it. It is as large as it must be to be timed, so that planning stays quick on processors and true on GPUs. */
static status word_seconds(struct gpu *gpu, double *out)
{
    enum { LEAST = 1 << 18, MOST = 1 << 24, FEW = 1 << 10 };
    const uint64_t enough_ns = 2000000;
    status st = OK;
    struct gpu_buffer *order = NULL, *from = NULL, *to = NULL;
    uint64_t ns = 0;
    for (uint n = LEAST; n <= MOST && ns < enough_ns; n *= 4) {
        struct count_params k = {n};
        gpu_buffer_destroy(gpu, &order);
        gpu_buffer_destroy(gpu, &from);
        gpu_buffer_destroy(gpu, &to);
        TRY(gpu_buffer_create(gpu, "plan", n, 4, &order));
        TRY(gpu_buffer_create(gpu, "plan", n, 4, &from));
        TRY(gpu_buffer_create(gpu, "plan", n, 4, &to));
        GPU_RUN(gpu, gpu_iota, n, k, order);
        gpu_gather(gpu, order, from, to, FEW);
        TRY(gpu_wait(gpu));
        gpu_times_reset(gpu);
        gpu_gather(gpu, order, from, to, n);
        TRY(gpu_wait(gpu));
        ns = gpu_kernel_time(gpu, KERNEL_gpu_gather_u)->ns;
        *out = (double)ns * 1e-9 / n;
    }
done:
    gpu_buffer_destroy(gpu, &order);
    gpu_buffer_destroy(gpu, &from);
    gpu_buffer_destroy(gpu, &to);
    return st;
}

/* Seconds of a frame: as the folder's frames came, or by what a word takes on the device (without one nobody knows: 0). */
static status time_frames(struct farm *f, struct gpu *gpu, bool *measured)
{
    status st = OK;
    struct path root;
    double word = 0;
    for (size_t i = 0; i < f->n_wedges; i++) {
        struct farm_wedge *w = &f->wedge[i];
        double n = (double)range_count(w->job->frames);
        TRY(farm_root(f, (int)w->job->wedge.index, &root));
        w->frame_seconds = farm_frame_seconds(root.text, w->job->name);
        *measured |= w->frame_seconds > 0;
        if (w->frame_seconds > 0 || !gpu)
            continue;
        if (word == 0)
            TRY(word_seconds(gpu, &word));
        w->frame_seconds =
            word * WORDS_PER_PARTICLE_STEP * (double)w->estimate.n_particles * (w->estimate.steps + n) / n;
    }
done:
    return st;
}

static void describe_memory(const struct model_estimate *e, const struct gpu *gpu, uint64_t process,
                            struct text *t)
{
    if (gpu)
        json_text(t, "device", gpu_info(gpu)->name);
    json_integer(t, "device_bytes", (int64_t)e->device_bytes);
    if (gpu)
        json_integer(t, "device_free_bytes", (int64_t)gpu_memory_free(gpu));
    json_integer(t, "host_bytes", (int64_t)e->host_bytes);
    json_integer(t, "process_bytes", (int64_t)process);
    json_integer(t, "host_free_bytes", (int64_t)memory_available());
}

/* `gpu` may be NULL: what only a device knows is left out. */
static status answer(struct farm *f, struct gpu *gpu, bool words, const char *device, struct text *t)
{
    status st = OK;
    const struct job *job = f->wedge[0].job;
    const struct model_estimate e = f->wedge[0].estimate;
    bool measured = false;
    char frames[48];
    size_t n_frames = range_count(job->frames);
    const uint64_t process = room_process(gpu, &e);
    TRY(time_frames(f, gpu, &measured));
    TRY(farm_graph(f));
    size_t n_checkpoints =
        (size_t)fmin((double)job->checkpoint.keep, ceil((double)n_frames / (double)job->checkpoint.every));
    json_object(t, NULL);
    json_text(t, "name", f->base->name);
    json_text(t, "model", job_model(job)->name);
    json_text(t, "frames", range_text(job->frames, frames));
    json_integer(t, "frame_count", (int64_t)n_frames);
    json_number(t, "years", job_years(job, job->frames.first, job->frames.last));
    json_integer(t, "particles", (int64_t)e.n_particles);
    json_object(t, "voxels");
    json_integer(t, "x", e.voxels[0]);
    json_integer(t, "y", e.voxels[1]);
    json_integer(t, "z", e.voxels[2]);
    json_end_object(t);
    json_integer(t, "erosion_steps", (int64_t)e.steps);
    describe_memory(&e, gpu, process, t);
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
    if (measured || gpu) {
        json_number(t, "estimated_seconds", round(f->wedge[0].frame_seconds * (double)n_frames));
        json_text(t, "estimated_from", measured ? "the frames there are" : "the device's speed");
    }
    if (gpu)
        json_bool(t, "fits_in_memory", room_enough(room_free(gpu), room_needed(gpu, &e)));
    TRY(farm_describe(f, words, device, t));
    json_end_object(t);
    TRY(text_status(t));
done:
    return st;
}

status cli_plan(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct words operands = {0};
    struct farm farm = {0};
    struct gpu *gpu = NULL;
    struct text t = {0};
    bool help = false;
    int wedge = 0;
    const struct option options[] = {OPTION_OUT(&c),       OPTION_DEVICE_OR_NONE(&c), OPTION_SET(&c),
                                     OPTION_WEDGE(&wedge), OPTION_FROM(&c),           OPTION_JSON(&c)};
    TRY(options_parse(&usage_plan, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    TRY(farm_load(operands.word[0], c.sets.word, c.sets.n, c.from, wedge, c.out, &farm));
    const bool none = c.device && strcmp(c.device, "none") == 0;
    if (!none)
        TRY(gpu_create(&(struct gpu_options){.device = c.device}, &gpu));
    TRY(answer(&farm, gpu, !c.json, none ? NULL : c.device, &t));
    TRY(words_print(&t, c.json));
done:
    text_free(&t);
    gpu_destroy(&gpu);
    farm_free(&farm);
    words_free(&operands);
    common_free(&c);
    return st;
}
