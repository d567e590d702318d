/* Picture check: a frame of the demo at 1920 x 1080. */
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "model/model.h"
#include "selftest/selftest.h"

/* The share of the picture that rock covers in the demo's second frame, at a spacing of 2 m and with its own camera; recorded on llvmpipe. */
static const double COVERED = 0.33887, TOLERANCE = 0.01;

static const char *const sets[] = {"domain.spacing_m=2", "cameras.main.resolution=[1920, 1080]",
                                   "output.aov.every=1", "output.vdb.every=1000",
                                   "output.vdb.points_every=1000"};

static double covered(const struct aov_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height;
    double sum = 0;
    for (size_t c = 0; c < image->n_channels; c++)
        if (strcmp(image->channel[c].name, "A") == 0 && image->channel[c].value)
            for (size_t i = 0; i < n; i++)
                sum += (double)image->channel[c].value[i];
    return sum / (double)n;
}

static status picture(struct selftest *t, const void *what, struct row *row)
{
    (void)what;
    status st = OK;
    char why[WHY_BYTES];
    struct job *job = NULL;
    struct gpu *gpu = NULL;
    struct model *model = NULL;
    struct frame f = {0};
    double seconds = 0;
    TRY(selftest_load(t, t->demo, sets, sizeof sets / sizeof *sets, &job));
    TRY(gpu_create(&(struct gpu_options){.device = t->device}, &gpu));
    TRY(model_create(gpu, job, NULL, &model));
    TRY(model_step(model));
    for (int i = 0; i < 2; i++) { /* the first picture includes compiling kernels */
        TRY(selftest_stop(t));
        frame_free(&f);
        f = (struct frame){0};
        const double start = clock_seconds();
        TRY(model_output(model, &f));
        seconds = clock_seconds() - start;
    }
    if (f.n_images != 1 || f.image[0].width != 1920 || f.image[0].height != 1080) {
        row_wrong(row, "%zu pictures were made, or the picture does not have the requested size", f.n_images);
        goto done;
    }
    const double share = covered(&f.image[0]);
    if (!near_number("the share of the picture that is rock", COVERED, share, TOLERANCE, why))
        row_wrong(row, "%s", why);
    row_found(row, "%.3f s, %.2f %% of it rock", seconds, 100 * share);
    row_value(row, "picture_seconds", seconds);
    row_value(row, "covered", share);
done:
    frame_free(&f);
    model_destroy(&model);
    gpu_destroy(&gpu);
    job_destroy(&job);
    return st;
}

status selftest_picture(struct selftest *t)
{
    return selftest_do(t, "picture", "1920 x 1080", picture, NULL);
}
