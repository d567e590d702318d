#include "frame/disk.h"

#include <math.h>

#include "field/aov.h"
#include "field/camera.h"
#include "field/channels.h"
#include "field/mattes.h"

/* Size of points relative to exact precision with blosc, measured on jobs of 3,000 to 500,000 particles. Without blosc, points take as
 * much as in memory, since zip does not compress them. */
static double packed(const struct job_vdb *vdb, bool inside)
{
    const bool small = vdb->precision == VDB_PRECISION_16_BIT, raw = vdb->codec != VDB_CODEC_BLOSC;
    const double of_inside[2][2] = {{1, 0.95}, {2.8, 2.0}}, of_bare[2][2] = {{1, 0.67}, {1.45, 1.0}};
    return (inside ? of_inside : of_bare)[raw][small];
}

static double points_bytes(const struct job_vdb *vdb, const struct scene_size *size,
                           const struct disk_particle *p)
{
    const double bare = (double)size->n_surface, inside = (double)size->n_particles - bare;
    if (vdb->points == VDB_POINTS_NONE)
        return 0;
    /* Without particles inside, their zeros in surface attributes are not stored. */
    if (vdb->points == VDB_POINTS_SURFACE)
        return bare * p->bare * (vdb->codec == VDB_CODEC_BLOSC ? 0.93 : 0.77) * packed(vdb, false);
    return inside * p->inside * packed(vdb, true) + bare * p->bare * packed(vdb, false);
}

static double volumes_bytes(const struct job *job, const struct scene_size *size,
                            const struct disk_particle *p)
{
    static const double codec[] = {[VDB_CODEC_BLOSC] = 1, [VDB_CODEC_ZIP] = 1.05, [VDB_CODEC_NONE] = 1.25};
    const struct job_vdb *vdb = &job->output.vdb;
    /* The measurements had this many grids; each further grid adds a tenth of the bytes at the surface. */
    enum { MEASURED = 5 };
    const double further = 0.1 * ((double)value_grids(HAS_ALWAYS | p->has) - MEASURED);
    return ((double)size->n_near * p->volumes_inside +
            (double)size->n_surface * (p->volumes_bare * (1 + further))) *
           codec[vdb->codec] * (vdb->half ? 0.75 : 1);
}

/* The share of a picture that shows rock: of its 32 x 18 tiles, those into which a point of the scene projects. */
static double covered(const struct job_camera *camera, int frame, const struct scene_size *size)
{
    enum { WIDE = 32, HIGH = 18 };
    bool part[WIDE * HIGH] = {false};
    int n = 0;
    const struct camera c = camera_of(camera, frame);
    if (size->n_points == 0)
        return 1;
    for (size_t i = 0; i < size->n_points; i++) {
        const double x[3] = {(double)size->point[i][0], (double)size->point[i][1], (double)size->point[i][2]};
        double px[2];
        if (!camera_project(&c, x, px) || !(px[0] >= 0 && px[0] < c.width && px[1] >= 0 && px[1] < c.height))
            continue;
        bool *at = &part[(int)(px[1] / c.height * HIGH) * WIDE + (int)(px[0] / c.width * WIDE)];
        n += !*at;
        *at = true;
    }
    return (double)n / (WIDE * HIGH);
}

/* Pixels without rock are uniform and take almost nothing. The channels of mattes, pairs of an id and a share, are mostly uniform
 * too. */
static double pictures_bytes(const struct job *job, const struct scene_size *size, double channel)
{
    double bytes = 0;
    const int frame[] = {job->frames.first, (job->frames.first + job->frames.last) / 2, job->frames.last};
    const size_t channels = aov_channel_count(job), mattes = job->output.aov.cryptomatte ? MATTE_CHANNELS : 0;
    for (size_t i = 0; i < job->output.aov.n_cameras; i++) {
        const struct job_camera *camera = camera_named(job, job->output.aov.cameras[i]);
        double share = 0;
        for (int k = 0; camera && k < 3; k++)
            share += covered(camera, frame[k], size) / 3;
        if (camera)
            bytes += (double)aov_camera_pixels(camera) * share *
                     (channel * (double)(channels - mattes) + 0.3 * (double)mattes);
    }
    return bytes;
}

struct disk_frame disk_frame(const struct job *job, const struct scene_size *size,
                             const struct disk_particle *particle)
{
    enum { USD_PARTICLE = 60, USD_HEAD = 2500, VOLUMES_HEAD = 15000, PICTURE_HEAD = 10000, MANIFEST = 1100 };
    struct disk_frame f = {
        .points = (uint64_t)points_bytes(&job->output.vdb, size, particle),
        .volumes = VOLUMES_HEAD + (uint64_t)volumes_bytes(job, size, particle),
        .pictures =
            PICTURE_HEAD * job->output.aov.n_cameras + (uint64_t)pictures_bytes(job, size, particle->channel),
        .other = MANIFEST,
    };
    if (job->output.usd.points != USD_POINTS_NONE)
        f.usd = USD_HEAD + USD_PARTICLE * (uint64_t)size->n_surface;
    return f;
}

uint64_t disk_frame_bytes(const struct disk_frame *f)
{
    return f->points + f->usd + f->volumes + f->pictures + f->other;
}

uint64_t disk_frames_bytes(const struct job *job, const struct disk_frame *frame, struct frame_range frames,
                           struct disk_frame *kinds)
{
    struct disk_frame sum = {0};
    for (int64_t f = frames.first; f <= frames.last; f += frames.step) {
        const uint64_t points = job_writes(job, JOB_POINTS, (int)f);
        sum.points += points * frame->points;
        sum.usd += points * frame->usd;
        sum.volumes += job_writes(job, JOB_VOLUMES, (int)f) * frame->volumes;
        sum.pictures += job_writes(job, JOB_PICTURES, (int)f) * frame->pictures;
        sum.other += frame->other;
    }
    if (kinds)
        *kinds = sum;
    return disk_frame_bytes(&sum);
}
