#include "run/room.h"

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "base/memory_limits.h"

struct room room_free(const struct gpu *gpu)
{
    return (struct room){.device = gpu_memory_free(gpu), .host = memory_available()};
}

/* What a process comes to hold after its device is opened, beside its job's own: OpenVDB, 32 MB, and on Mesa 22.3's
 * lavapipe the compiler's code and what it made: more of it where that was just now than where it comes from a cache. Of goblins, with 70
 * kernels, it took 75 to 115 MB, of models with 80 90 to 130. */
static uint64_t later(const struct model_estimate *e)
{
    return 50000000 + 625000 * (uint64_t)e->kernels;
}

/* And before: the program, the loader and the drivers that a Debian 12 has, as `hoodoo devices` opens them. */
static const uint64_t BEFORE = 68000000;

uint64_t room_process(const struct gpu *gpu, const struct model_estimate *e)
{
    return (gpu ? memory_resident() : BEFORE) + later(e);
}

struct room room_at_once(const struct gpu *gpu, const struct model_estimate *e)
{
    if (gpu_info(gpu)->is_cpu)
        return (struct room){.host = e->device_bytes + e->host_bytes + later(e)};
    return (struct room){.device = e->device_bytes, .host = e->host_bytes + later(e)};
}

struct room room_needed(const struct gpu *gpu, const struct model_estimate *e)
{
    struct room out = room_at_once(gpu, e);
    out.host -= e->waiting_bytes;
    return out;
}

bool room_enough(struct room there, struct room needed)
{
    return needed.device <= there.device && needed.host <= there.host;
}

/* Three digits, upwards. */
static double rounded(double spacing)
{
    double unit = pow(10, floor(log10(spacing)) - 2);
    return ceil(spacing / unit - 1e-6) * unit;
}

static bool would_fit(const struct gpu *gpu, const struct job *job, double spacing, struct room there)
{
    struct job coarser = *job;
    struct model_estimate e;
    coarser.domain.spacing_m = spacing;
    return model_estimate(&coarser, &e) == OK && room_enough(there, room_needed(gpu, &e));
}

/* The spacing from the job's own upwards, about, at which it fits; 0 if none does before a side of the domain is two
 * voxels. Every spacing that is answered was tried. */
static double fitting_spacing(const struct gpu *gpu, const struct job *job, struct room there)
{
    const double *size = job->domain.size_m, most = fmin(size[0], fmin(size[1], size[2])) / 2;
    double tight = job->domain.spacing_m, fits = tight;
    do {
        tight = fits;
        fits = rounded(2 * fits);
        if (fits > most)
            return 0;
    } while (!would_fit(gpu, job, fits, there));
    while (fits > 1.03 * tight) {
        double between = rounded(sqrt(fits * tight));
        *(would_fit(gpu, job, between, there) ? &fits : &tight) = between;
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

status room_check(const struct gpu *gpu, const struct job *job, struct model_estimate *out)
{
    const struct gpu_info *info = gpu_info(gpu);
    char device[400] = "", host[32], free_host[32], free_device[32],
         advice[64] = "no domain.spacing_m would fit";
    status st = model_estimate(job, out);
    struct room there = room_free(gpu), needed = room_needed(gpu, out);
    if (st != OK || room_enough(there, needed))
        return st;
    if (!info->is_cpu)
        snprintf(device, sizeof device, "%s on %s, where %s are free, and ", size_text(needed.device, host),
                 info->name, size_text(there.device, free_device));
    double fits = fitting_spacing(gpu, job, there);
    if (fits > 0)
        snprintf(advice, sizeof advice, "domain.spacing_m: %.3g would fit", fits);
    return fail(E_MEMORY,
                "this job's %zu particles in %d x %d x %d voxels need %s%s of memory, where %s are free; %s",
                out->n_particles, out->voxels[0], out->voxels[1], out->voxels[2], device,
                size_text(needed.host, host), size_text(there.host, free_host), advice);
}
