#include "run/memory.h"

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "system/memory_limits.h"

struct run_memory run_memory_available(const struct gpu *gpu)
{
    return (struct run_memory){.device = gpu_memory_free(gpu), .host = memory_available()};
}

/* By how much the process grows after its device is opened, besides the job's data: 32 MB for OpenVDB and, with Mesa 22.3's lavapipe,
 * the compiler's code and the kernels, which take more when they are compiled than when they come from a cache. Goblins, with 70
 * kernels, took 75 to 115 MB; models with 80 kernels took 90 to 130 MB. */
static uint64_t process_growth(const struct model_estimate *e)
{
    return 50000000 + 625000 * (uint64_t)e->kernels;
}

/* What it holds before that: the program, the Vulkan loader and the drivers of Debian 12, as measured with `hoodoo devices`. */
static const uint64_t BEFORE = 68000000;

uint64_t run_memory_process(const struct gpu *gpu, const struct model_estimate *e)
{
    return (gpu ? memory_resident() : BEFORE) + process_growth(e);
}

struct run_memory run_memory_needed(const struct gpu *gpu, const struct model_estimate *e,
                                    enum frame_pace pace)
{
    const uint64_t host = e->host_at[pace] + process_growth(e);
    return gpu_info(gpu)->is_cpu ? (struct run_memory){.host = host + e->device_bytes}
                                 : (struct run_memory){.device = e->device_bytes, .host = host};
}

enum frame_pace run_memory_pace(const struct gpu *gpu, const struct model_estimate *e)
{
    const struct run_memory available = run_memory_available(gpu);
    enum frame_pace pace = e->pace;
    while (pace < PACE_STREAM && !run_memory_fits(available, run_memory_needed(gpu, e, pace)))
        pace++;
    return pace;
}

bool run_memory_fits(struct run_memory available, struct run_memory needed)
{
    return needed.device <= available.device && needed.host <= available.host;
}

/* Rounds up to three digits. */
static double round_up(double spacing)
{
    double unit = pow(10, floor(log10(spacing)) - 2);
    return ceil(spacing / unit - 1e-6) * unit;
}

static bool would_fit(const struct gpu *gpu, const struct job *job, double spacing,
                      struct run_memory available)
{
    struct job coarser = *job;
    struct model_estimate e;
    coarser.domain.spacing_m = spacing;
    return model_estimate(&coarser, &e) == OK &&
           run_memory_fits(available, run_memory_needed(gpu, &e, PACE_STREAM));
}

/* About the smallest spacing above the job's own at which it fits, found by doubling and bisection; 0 if it does not fit even with two
 * voxels along the shortest side of the domain. The result itself was tried. */
static double fitting_spacing(const struct gpu *gpu, const struct job *job, struct run_memory available)
{
    const double *size = job->domain.size_m, most = fmin(size[0], fmin(size[1], size[2])) / 2;
    double tight = job->domain.spacing_m, fits = tight;
    do {
        tight = fits;
        fits = round_up(2 * fits);
        if (fits > most)
            return 0;
    } while (!would_fit(gpu, job, fits, available));
    while (fits > 1.03 * tight) {
        double between = round_up(sqrt(fits * tight));
        *(would_fit(gpu, job, between, available) ? &fits : &tight) = between;
    }
    return fits;
}

static const char *size_text(uint64_t bytes, char out[32])
{
    if (bytes < 1000000000)
        snprintf(out, 32, "%.0f MB", (double)bytes / 1e6);
    else
        snprintf(out, 32, "%.1f GB", (double)bytes / 1e9);
    return out;
}

status run_memory_check(const struct gpu *gpu, const struct job *job, struct model_estimate *out)
{
    const struct gpu_info *info = gpu_info(gpu);
    char device[400] = "", host[32], free_host[32], free_device[32],
         advice[64] = "no domain.spacing_m would fit";
    status st = model_estimate(job, out);
    struct run_memory available = run_memory_available(gpu),
                      needed = run_memory_needed(gpu, out, PACE_STREAM);
    if (st != OK || run_memory_fits(available, needed))
        return st;
    if (!info->is_cpu)
        snprintf(device, sizeof device, "%s on %s, where %s are free, and ", size_text(needed.device, host),
                 info->name, size_text(available.device, free_device));
    double fits = fitting_spacing(gpu, job, available);
    if (fits > 0)
        snprintf(advice, sizeof advice, "domain.spacing_m: %.3g would fit", fits);
    return fail(E_MEMORY,
                "this job's %zu particles in %d x %d x %d voxels need %s%s of memory, where %s are free; %s",
                out->n_particles, out->voxels[0], out->voxels[1], out->voxels[2], device,
                size_text(needed.host, host), size_text(available.host, free_host), advice);
}
