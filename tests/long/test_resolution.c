/* A coarse run shows the rock that the fine one makes: the demo at spacings of 1 and 0.5 m, dry and in the rain, at the same share
 * left. Minutes. */
#include "physics/model_help.h"

#include <math.h>
#include <string.h>

struct course {
    double frames_to_80, frames_to_50; /* until that share of the volume is left, interpolated */
    double share;                      /* that is left in the frame nearest to the wanted one */
    struct frame_grids grids;          /* of that */
};

static void keep(struct course *c, struct frame *frame, double share)
{
    frame_free(&(struct frame){.grids = c->grids});
    c->share = share;
    c->grids = frame->grids;
    memset(&frame->grids, 0, sizeof frame->grids);
}

/* Until less than `wanted` is left, and half. */
static struct course erode(const char *spacing, const char *rain, double wanted)
{
    struct course out = {0};
    char path[4096], set[64];
    const char *top = getenv("HOODOO_TOP");
    snprintf(path, sizeof path, "%s/jobs/demo.yaml", top ? top : ".");
    snprintf(set, sizeof set, "domain.spacing_m=%s", spacing);
    struct sim s = sim_open(path, (const char *[]){set, rain, "output.aov.cameras=[]"}, 3);
    double before = 1;
    for (bool done = false; !done;) {
        struct frame frame = sim_output(&s);
        const double share = frame.volume_m3 / frame.start_volume_m3,
                     number = frame.number - s.job->frames.first;
        done = (share <= 0.5 && share <= wanted) || frame.number >= s.job->frames.last;
        if (share <= 0.8 && before > 0.8)
            out.frames_to_80 = number - (0.8 - share) / (before - share);
        if (share <= 0.5 && before > 0.5)
            out.frames_to_50 = number - (0.5 - share) / (before - share);
        if (fabs(share - wanted) < fabs(out.share - wanted))
            keep(&out, &frame, share);
        before = share;
        frame_free(&frame);
        if (!done)
            assert_ok(model_step(s.model));
    }
    sim_end(&s);
    assert_true(out.grids.n_grids > 0);
    return out;
}

/* A grid between its samples. */
static double value_at(const struct frame_grids *g, int grid, const double x[3])
{
    const struct grid_lattice *l = &g->lattice;
    double f[3], sum = 0;
    int c[3];
    for (int a = 0; a < 3; a++) {
        double s = fmin(fmax((x[a] - l->origin[a]) / l->voxel, 0), l->n[a] - 1.001);
        c[a] = (int)s;
        f[a] = s - c[a];
    }
    for (int b = 0; b < 8; b++) {
        int o[3] = {b & 1, (b >> 1) & 1, b >> 2};
        double w = 1;
        for (int a = 0; a < 3; a++)
            w *= o[a] ? f[a] : 1 - f[a];
        sum += w * (double)grid_at(g, &g->grid[grid], c[0] + o[0], c[1] + o[1], c[2] + o[2]);
    }
    return sum;
}

/* How much of the rock of either is rock of both, by the surface and by the share of space. */
static void overlap(const struct frame_grids *coarse, const struct frame_grids *fine, double *surface,
                    double *density)
{
    const struct grid_lattice *l = &fine->lattice;
    size_t both = 0, either = 0;
    double least = 0, most = 0;
    assert_string_equal(fine->grid[0].name, "surface");
    assert_string_equal(fine->grid[1].name, "density");
    for (int k = 0; k < fine->lattice.n[2]; k++)
        for (int j = 0; j < fine->lattice.n[1]; j++)
            for (int i = 0; i < fine->lattice.n[0]; i++) {
                double x[3] = {l->origin[0] + i * l->voxel, l->origin[1] + j * l->voxel,
                               l->origin[2] + k * l->voxel};
                if (x[2] < 0)
                    continue;
                int a = value_at(fine, 0, x) < 0, b = value_at(coarse, 0, x) < 0;
                double da = value_at(fine, 1, x), db = value_at(coarse, 1, x);
                both += a && b;
                either += a || b;
                least += fmin(da, db);
                most += fmax(da, db);
            }
    *surface = (double)both / (double)either;
    *density = least / most;
}

static void compare(const char *coarser, const char *finer, const char *rain)
{
    double surface, density;
    struct course coarse = erode(coarser, rain, 0.5), fine = erode(finer, rain, coarse.share);
    overlap(&coarse.grids, &fine.grids, &surface, &density);
    print_message("# frames until 80 %% is left: %.2f and %.2f; until 50 %%: %.2f and %.2f\n",
                  coarse.frames_to_80, fine.frames_to_80, coarse.frames_to_50, fine.frames_to_50);
    print_message(
        "# at %.3f and %.3f: the surfaces enclose the same for %.1f %%, the densities for %.1f %%\n",
        coarse.share, fine.share, 100 * surface, 100 * density);
    assert_true(fabs(coarse.frames_to_80 / fine.frames_to_80 - 1) < 0.15);
    assert_true(fabs(coarse.frames_to_50 / fine.frames_to_50 - 1) < 0.15);
    assert_true(surface >= 0.85);
    frame_free(&(struct frame){.grids = coarse.grids});
    frame_free(&(struct frame){.grids = fine.grids});
}

static void coarse_and_fine_are_the_same_rock(void **state)
{
    (void)state;
    compare("1", "0.5", "rain.m_per_yr=0");
}

static void in_the_rain_too(void **state)
{
    (void)state;
    compare("1", "0.5", "rain={m_per_yr: 1, threshold_Pa: 0.5}");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coarse_and_fine_are_the_same_rock),
        cmocka_unit_test(in_the_rain_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
