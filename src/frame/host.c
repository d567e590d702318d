#include "frame/host.h"

#include "field/aov.h"
#include "field/field.h"
#include "particles/pieces.h"

uint64_t host_rock_bytes(size_t n)
{
    uint64_t bytes = 0;
    for (int f = 0; f < ROCK_FIELDS; f++)
        bytes += f == ROCK_v || rock_field_is_optional(f) ? 0 : n * rock_field_size((enum rock_field)f);
    return bytes;
}

/* Voxels that bricks store beyond the surface, in air and in rock: the narrow band and, on average, half a brick. */
enum { AIR = GRID_BAND + BRICK_SIDE / 2 };

uint64_t host_grid_samples(const int voxels[3], uint64_t rock, uint64_t bare)
{
    const uint64_t kept = (rock < AIR * bare ? rock : AIR * bare) + AIR * bare;
    int samples[3], bricks[3];
    for (int a = 0; a < 3; a++)
        samples[a] = voxels[a] + 2 * FIELD_MARGIN;
    const uint64_t all = grid_bricks_of(samples, bricks) * BRICK_SAMPLES;
    return kept < all ? kept : all;
}

static uint64_t most(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* Temporary memory while a frame is made: the vectors from which the channels of a picture are taken. */
static uint64_t making(const struct job *job)
{
    enum { VECTOR = 16, IDS = 12, SOURCES = 4 };
    const uint64_t moving = job->clock.seconds_per_frame > 0;
    return aov_pixels(job) * ((SOURCES + moving) * VECTOR + IDS);
}

/* The particles that a frame's files show. */
static uint64_t shown(const struct job *job, const struct scene_size *size)
{
    return job->output.vdb.points == VDB_POINTS_ALL ? size->n_particles : size->n_kept;
}

/* Temporary memory while a frame is written, one file at a time. Points are written piece by piece: 8 bytes of sort order per particle,
 * and the attributes that are not uniform within a leaf of the file's tree: 32 bytes for all, 32 more at the surface. Volumes are
 * written one grid at a time; a grid may be full, and the leaves at the surface take six times the size of their content. USD lists the
 * particles at the surface. Pictures need their compressed rows and the file assembled from them. */
static uint64_t writing(const struct job *job, const struct scene_size *size, const struct disk_frame *files)
{
    const uint64_t n = shown(job, size), bare = size->n_surface, cameras = job->output.aov.n_cameras;
    const uint64_t piece = n < PIECE_MAX ? n : PIECE_MAX, copied = n > piece ? 2 * host_rock_bytes(piece) : 0;
    const uint64_t points = job->output.vdb.points == VDB_POINTS_NONE
                                ? 0
                                : piece * (8 + 32) + copied + (bare < piece ? bare : piece) * 32;
    return most(points,
                most(n * 4 + bare * 6 * 4, most(4 * bare, cameras ? 2 * files->pictures / cameras : 0)));
}

/* A frame with so many floats per sample of its lattice. */
static uint64_t one(const struct job *job, const struct scene_size *size, const struct host_frame *f,
                    size_t grids)
{
    const uint64_t n = size->n_kept, deep = shown(job, size) - n;
    const bool moves = job->clock.seconds_per_frame > 0 || job->collapse.blocks == COLLAPSE_FALL;
    return host_rock_bytes(n) + (moves ? 16 * n : 0) + deep * DEEP_VALUES * sizeof(float) +
           grids * f->samples * sizeof(float) + f->own + aov_picture_bytes(job) * job->output.aov.n_cameras;
}

uint64_t host_frames_bytes(const struct job *job, const struct scene_size *size, const struct host_frame *f,
                           const struct disk_frame *files, enum frame_pace pace)
{
    const uint64_t all = one(job, size, f, f->grids);
    if (pace == PACE_STREAM) /* the largest grids are vectors */
        return one(job, size, f, f->kept) +
               most(making(job), writing(job, size, files) + 3 * f->samples * sizeof(float));
    return (pace == PACE_OVERLAP ? 2 : 1) * all + making(job) + writing(job, size, files);
}
