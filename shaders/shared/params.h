/* Parameters of the kernels, read by both languages. Scalars only, so that layouts cannot differ. At most 128
 * bytes. `n` is always the number of invocations that work. */
#ifndef HOODOO_PARAMS_H
#define HOODOO_PARAMS_H

#ifdef __STDC_VERSION__
#include <stdint.h>
typedef uint32_t uint;
#define SHARED_SIZE(type, bytes) _Static_assert(sizeof(struct type) == (bytes), #type " drifted");
#else
#define SHARED_SIZE(type, bytes)
#endif

/* For kernels that need no more than a count. */
struct count_params {
    uint n;
};
SHARED_SIZE(count_params, 4)

/* ---- numbers */

/* Into found[slot] goes the least number of an item that is not finite or greater than `most`. Each of so many threads looks at every
 * so many'th item: where the device is a CPU, starting a thread takes longer than looking at a number. */
#define NUMBERS_THREADS 8192u
struct numbers_params {
    uint n, slot;
    float most;
};
SHARED_SIZE(numbers_params, 12)

/* ---- gpu: scan, sort, reduce */

#define SCAN_RUN 64u
#define REDUCE_THREADS 2048u

struct scan_params {
    uint n; /* runs */
    uint n_values;
};
SHARED_SIZE(scan_params, 8)

struct sort_params {
    uint n;
    uint n_ordered; /* keys from here on may come in any order */
};
SHARED_SIZE(sort_params, 8)

struct reduce_params {
    uint n; /* REDUCE_THREADS */
    uint n_values;
};
SHARED_SIZE(reduce_params, 8)

struct reduce_end_params {
    uint n; /* 64 */
    uint maximum;
    uint slot;
};
SHARED_SIZE(reduce_end_params, 12)

/* ---- the domain's sides, a bit each in `walls`: those beyond which the rock goes on, as its own mirror image. At the
 * others it ends. See particles/sides.glsl. */

#define WALL_X_MIN 1u
#define WALL_X_MAX 2u
#define WALL_Y_MIN 4u
#define WALL_Y_MAX 8u

/* ---- particles: the voxel index */

struct voxel_params {
    uint n;
    uint nx, ny, nz; /* voxels of the domain */
    float h;         /* m: voxel size, the particle spacing */
    uint walls;
};
SHARED_SIZE(voxel_params, 24)

/* Of blocks that joints part: the same, and whether any does. */
struct join_params {
    uint n;
    uint nx, ny, nz;
    float h;
    uint parted;
};
SHARED_SIZE(join_params, 24)

/* How much faster a front runs along beds than across them is kept as so many times the logarithm of base 2. */
#define MAPS_OCTAVE 32

struct lead_params {
    uint n;
    uint nx, ny, nz;
    float h;
    float bed_x, bed_y, bed_z; /* unit normal of the beds */
};
SHARED_SIZE(lead_params, 32)

/* Of blocks: the same, and how many particles one has at least. */
struct crumble_params {
    uint n;
    uint nx, ny, nz;
    float h;
    uint least;
};
SHARED_SIZE(crumble_params, 24)

/* Words for each word of bits in held voxels' `words` (particles/held.glsl). */
#define HELD_STRIDE 3u

struct hold_params {
    uint n; /* words of bits, and one */
    uint nx, ny, nz;
    uint around; /* 1: the voxels around occupied ones are held too */
};
SHARED_SIZE(hold_params, 20)

/* Deep voxels whose particles are due. */
struct born_params {
    uint n;   /* words of bits */
    uint all; /* 1: all of them */
};
SHARED_SIZE(born_params, 8)

/* Rock within NEAR_REACH voxels of an empty one, on every axis, always has particles, and so have its neighbours: nothing that
 * happens at the surface or is shown of it looks at others. Where a voxel without comes that near, NEAR_AHEAD more layers get
 * theirs as well, so that it is not asked for in every step. */
#define NEAR_REACH 4u
#define NEAR_AHEAD 3u

/* Runs of deep voxels among the nodes of blocks. */
struct runs_params {
    uint n; /* words of bits, and one where runs are counted; or those of the list */
    uint nx, ny, nz;
    uint slots; /* held voxels, whose nodes come first */
    uint words; /* of bits, in all */
};
SHARED_SIZE(runs_params, 24)

/* One axis of the search for voxels near the rock's surface. */
struct near_params {
    uint n; /* words of bits */
    uint nx, ny, nz;
    uint axis, reach; /* 0 to 2; voxels, at most 31 */
};
SHARED_SIZE(near_params, 24)

#define PHASE_ROCK 0u
#define PHASE_DEPOSIT 1u
#define PHASE_FALLING 2u

/* The share of space that is rock around a voxel's middle, from its own fill, its 6 face and its 12 edge
 * neighbours': the surface is where this is 1/2. The weights are those of (1 - r^2 / 4 h^2)^3, rounded so
 * that they add up to 1; on a plane face the surface lies exactly where the fill puts it. */
#define SHARE_SELF 0.2f
#define SHARE_FACE (1.0f / 12.0f)
#define SHARE_EDGE 0.025f

/* ---- stress: hexahedra of 2 h; nodes and cells have a margin of one empty cell on every side */

#define STRESS_FILL_FLOOR 0.05f

/* Nodes and cells are kept in runs of so many along x, one in each slot. Those of the slots before the first, and of one
 * behind the last, are zero; runs that are not kept are looked up at STRESS_EMPTY. */
#define STRESS_RUN 8u
#define STRESS_FIRST 2u
#define STRESS_EMPTY 8u
#define STRESS_NO_RUN 0xffffffffu /* of those slots */

struct stress_params {
    uint n;
    uint cx, cy, cz;  /* cells with margin; nodes are one more on each axis */
    float lambda, mu; /* Pa */
    float dx;         /* m */
    float weight;     /* N: of a full cell */
    uint walls;
    float loose;  /* deposits' stiffness, as a share of the rock's */
    uint jointed; /* 1: rock is not equally stiff everywhere */
};
SHARED_SIZE(stress_params, 44)

/* Of the multigrid smoother: the stress parameters of a level, and the weights of its step. */
struct smooth_params {
    uint n;
    uint cx, cy, cz;
    float lambda, mu;
    float dx;
    float keep, gain;
    uint second; /* 1: the correction before this one was zero */
    uint walls;
};
SHARED_SIZE(smooth_params, 44)

/* Between a level and the coarser one above it, whose cells are p. Cell c there has the children 2 c - 1 and 2 c
 * on each axis, and node a lies on node 2 a - 1: the ground is node 1 on all levels. */
struct coarse_params {
    uint n;
    uint cx, cy, cz;
    uint px, py, pz;
    uint walls;
};
SHARED_SIZE(coarse_params, 32)

/* Words of the solver's scalar buffer; the energy that each iteration took out of the error begins at
 * CG_ENERGY. */
#define CG_RZ 0u
#define CG_ALPHA 1u
#define CG_BETA 2u
#define CG_WORK 3u
#define CG_MOST 4u
#define CG_ENERGY 8u
#define CG_CHECK 16u

struct cg_params {
    uint n;         /* 64 */
    uint iteration; /* modulo CG_CHECK */
    uint first;     /* 1: there is no direction yet */
};
SHARED_SIZE(cg_params, 12)

struct interlock_params {
    uint n;
    float band;
};
SHARED_SIZE(interlock_params, 8)

/* ---- erosion */

struct erosion_params {
    uint n;
    uint nx, ny, nz;
    float h;  /* m */
    float dt; /* kyr */
    uint walls;
};
SHARED_SIZE(erosion_params, 28)

/* A round in which what is left of a step goes on by a voxel: 0, 1, ... */
struct carry_params {
    uint n;
    uint nx, ny, nz;
    float h;
    uint walls;
    uint round;
};
SHARED_SIZE(carry_params, 28)

/* Frost and heat. */
struct aspect_params {
    uint n;
    float x,
        y; /* towards the slopes that weather fastest: half of the logarithm of their rate over that of those opposite */
    float per_m; /* logarithm of the rate a metre higher */
};
SHARED_SIZE(aspect_params, 16)

/* Sheets that come off the surface in a step. */
struct sheeting_params {
    uint n;
    uint seed;
    float thick, wide; /* m */
    float strength;    /* Pa */
    float from, to;    /* when the step begins and ends, in sheets */
    float kyr;         /* how long it is */
};
SHARED_SIZE(sheeting_params, 32)

/* How long particles have been bare. */
struct skin_params {
    uint n;
    uint nx, ny, nz;
    float h; /* m */
    uint walls;
    float depth; /* m: where exposure is 1/e of what it is on the face */
    uint reach;  /* voxels: as far as a face is looked for */
    float kyr;   /* of a step, or before the first frame */
    float crust_kyr;
    float crust,
        damp; /* how many times more slowly, and faster, rock weathers under a full crust, and in the damp */
    float radius; /* m: of the ball in which rock is counted; 0: nothing is damp */
};
SHARED_SIZE(skin_params, 52)

/* Where groundwater comes out. */
struct seep_params {
    uint n;
    uint nx, ny, nz;
    float h; /* m */
    uint walls;
    uint beds;             /* that hold water */
    float zone;            /* m: how far above a bed faces are wet */
    float rate, threshold; /* yr/m, m/yr: what each m/yr above the threshold adds to the intensity */
    float strength;        /* of wet rock, as a share of dry rock's */
    float band;
};
SHARED_SIZE(seep_params, 48)

/* Words the erosion counts into; the fastest are floats. */
#define COUNT_ERODED 0u
#define COUNT_FALLEN 1u
#define COUNT_CHANGED 2u
#define COUNT_FASTEST_ROCK 3u
#define COUNT_FASTEST_LOOSE 4u
#define COUNT_FASTEST_SLOPE 5u
#define COUNT_BORN 5u

/* The budget of a frame: a row for each process (enum process in job/job.h), a sum of two words for each of the
 * lanes. */
#define BUDGET_LANES 2048u

struct budget_params {
    uint n; /* lanes */
    uint n_values;
    uint row;
    uint after; /* 1: added; 0: taken off */
};
SHARED_SIZE(budget_params, 16)

struct budget_split_params {
    uint n; /* lanes */
    uint n_values;
    uint deflation, water, abrasion, reworking, sheets; /* their rows */
};
SHARED_SIZE(budget_split_params, 28)

/* ---- wind */

struct wind_params {
    uint n;
    uint nx, ny, nz;
    float h;                            /* m */
    float deflation;                    /* k_d */
    float cohesion, friction, strength; /* mu_c (Pa), mu_f, alpha (Pa) */
    float abrasion, gale;               /* k_a (|v| / v_ref)^2, and without k_a */
    float wind_x, wind_y, wind_z;       /* unit vector, where it blows to */
    float shelter;                      /* m; with a flow, how far off the rock its speed counts */
    uint bx, by, bz;                    /* cells of the averaged flow, */
    float origin_x, origin_y;           /* m: where they begin, */
    float cell;                         /* m: and how wide they are */
    uint walls;
};
SHARED_SIZE(wind_params, 88)

/* The flow's units are the spacing of its particles and the wind's speed; its origin is the low corner of the
 * box of air, on the ground. */
#define FLOW_SUPPORT 2.0f        /* radius of the kernel */
#define FLOW_NEIGHBOURS 80u      /* most that one particle sees */
#define FLOW_FIXED 256.0f        /* steps of a spacing, or a unit normal, in integer sums */
#define FLOW_ROCK_ID 0xc0000000u /* identities of boundary particles begin here, */
#define FLOW_GROUND_ID 0x80000000u

/* What a particle is, in its velocity's w. */
#define FLOW_AIR 0.0f
#define FLOW_SKIN 1.0f /* air near the sides or the top: it moves with the wind */
#define FLOW_ROCK 2.0f
#define FLOW_GROUND 3.0f

struct flow_params {
    uint n;
    uint slots;           /* of the particle arrays */
    uint first;           /* slot, or identity, to begin at */
    uint bx, by, bz;      /* the box */
    uint gx, gy, gz;      /* cells of the neighbour search, each a support wide */
    float wind_x, wind_y; /* unit vector */
    float dt;
    float viscosity;
    float warm;               /* share of the last step's pressure to begin with; 1 / samples of a block */
    float full;               /* particles as dense as this may pull on each other */
    float keep, gain;         /* of the average: what stays, what of a block's sums is added */
    float column_x, column_y; /* emission: the first column of the lattice that is inside */
    uint enter_x, enter_y;    /* and which plane of it has just come in; box size: none */
    uint nx, ny, nz;          /* the rock's voxels */
    float h;                  /* m */
    float origin_x, origin_y; /* m: of the box in the rock's domain */
    float spacing;            /* m */
    uint walls;
};
SHARED_SIZE(flow_params, 116)

/* ---- water: see water/water.h. Cells are cubes of `size` voxels a side; voxel v lies in cell (v + shift) / size. A column's
 * cells are bits, `words` words of 32 levels each; its spans are nodes, numbered upwards, column by column. */

#define WATER_EMPTY 0u
#define WATER_SURF 1u
#define WATER_WALL 2u
#define WATER_SOLID 3u
#define WATER_KIND 3u
#define WATER_OUT 4u
#define WATER_DEAD 8u
#define WATER_SWEPT 16u

/* Spacings: floors that are no lower than so are as low, for altitudes are rough (water/altitude). */
#define WATER_LEVEL_DROP 0.015625f

/* Falls count up to this many units of altitude, 2^-16 cells, so that four of them fit an int. */
#define WATER_FALL 0x1fffffff

/* 2^32 over the golden ratio: whatever part of such turns is taken, they are spread evenly over it. */
#define WATER_TURN 2654435769u

/* What a hash is for (with water_params.random). */
#define RANDOM_ROUGHNESS 1u
#define RANDOM_RECEIVER 2u
#define RANDOM_SHIFT 3u

struct water_params {
    uint n;
    uint vx, vy, vz; /* voxels of the domain */
    uint size;       /* voxels along a cell's side: 1 or 2 */
    uint sx, sy, sz; /* shift; 0 where size is 1 */
    uint cx, cy, cz; /* cells */
    uint words;      /* of a column */
    uint nodes;      /* that many; also the number that stands for outside */
    uint basins;     /* likewise */
    uint leak;
    uint random; /* hash of seed, frame and step */
    uint rain;   /* units that fall on a voxel's column */
    uint round;
    float per_row, per_slab; /* 1 / cx, 1 / (cx cy) */
    uint walls;
};
SHARED_SIZE(water_params, 84)

/* What a span's water is split into. */
#define WATER_WHOLE 0x8000u

/* How wide streams are, and how they pull: cells of one voxel. */
struct water_stream_params {
    uint n;
    uint cx, cy, cz;
    uint words;
    float h;                      /* m */
    float rain_unit, spring_unit; /* m3/yr */
    float width, power, least;    /* a stream of Q m3/yr is width Q^power wide, but at least so many m */
    float narrowest, widest;      /* m: what cells can show of that */
    float window;                 /* m: slopes are measured up to so far around */
    float deep;              /* m: banks are so high; and water that stands so deep in a pit does not pull */
    uint reach;              /* cells: the farthest that a stream or a slope reaches */
    float pull, steepest;    /* k_f (Pa) */
    float per_row, per_slab; /* 1 / cx, 1 / (cx cy) */
    uint walls;
};
SHARED_SIZE(water_stream_params, 84)

struct water_surface_params {
    uint n;
    uint nx, ny, nz;               /* voxels, which are the cells */
    float h;                       /* m */
    uint words;                    /* of a column */
    uint size, sx, sy, sz, cx, cy; /* of the crumbs' cells */
    float rate, threshold;         /* k_t (1/Pa), tau_c (Pa) */
    float carry;                   /* Pa: deposits do not lie where water pulls harder */
    uint walls;
};
SHARED_SIZE(water_surface_params, 64)

/* ---- deposits: voxels as bits of columns, 32 to a word; routing cells of 2^3 voxels, on a shifted grid */

#define DEPOSIT_ROOM 4u          /* how many land in a cell in a round, at most */
#define DEPOSIT_WAITS 0u         /* a crumb's place: nowhere yet, */
#define DEPOSIT_LEFT 0xffffffffu /* out of the domain, */
#define DEPOSIT_HELD 0xfffffffeu /* where it broke off until it lands, or its voxel's number plus one */

struct deposit_params {
    uint n;
    uint nx, ny, nz; /* voxels */
    float h;         /* m */
    uint words;      /* of a column */
    uint cx, cy, cz; /* routing cells */
    int sx, sy, sz;  /* a voxel v is in cell (v + shift) / 2 */
    float repose;    /* tangent of the angle */
    uint seed;       /* hash of the job's seed, the frame and the step in it */
    uint round;
    uint last;     /* 1: the last round of a landing, 2: after which nothing waits for another either */
    float quicker; /* how many times faster than rock it was deposits erode */
    uint walls;
    float through; /* the share of a cover that comes through one voxel of deposits */
    uint dust;     /* hash of the job's seed */
    float bulk;    /* the share of eroded rock that comes to rest */
};
SHARED_SIZE(deposit_params, 84)

/* Words the deposition counts into. */
#define COUNT_LANDED 0u
#define COUNT_GONE 1u
#define COUNT_SLID 2u
#define COUNT_WAITING 3u

/* ---- plants */

struct plants_params {
    uint n;
    uint nx, ny, nz;
    float h;             /* m */
    float steepest;      /* least upward part of a normal on which plants stand */
    float growth, death; /* in this step: e^(rate dt), e^(-rate dt) */
    float binding, shelter;
    uint seed;
    uint spread;  /* which voxel's step of this frame */
    float seeds;  /* m: how far they go, on average */
    float chance; /* that seeds from full cover take root on a particle in this frame */
    uint walls;
};
SHARED_SIZE(plants_params, 60)

/* ---- mpm: material points on cells of 2 h. Nodes and base cells are numbered alike, on a lattice three longer
 * than the domain's cells on every axis; a particle's base cell is that of the first of its 27 nodes. Node (1, 1, 1) is the origin, or for rock in motion 3/4 of a cell below: what lies on
 * the ground then touches it without a gap. See mpm/mpm.h. */

struct mpm_params {
    uint n;
    uint cx, cy, cz;             /* cells of the domain */
    uint n_parts;                /* rows of partial sums */
    uint bodies;                 /* 1: there are pieces; 0: all is one body */
    uint rock;                   /* 1: resting rock is an obstacle */
    float dx;                    /* m */
    float dt;                    /* s */
    float lambda, mu, viscosity; /* Pa, Pa, Pa s */
    float push;                  /* m3/(kg m2): 4 / (density dx^2), or 0 to leave the stress out */
    float mass;                  /* kg: of a whole particle */
    float gravity;               /* m/s2 */
    float friction;              /* on ground and resting rock */
    float alpha;                 /* of Drucker and Prager's cone */
    float fastest;               /* m/s: nodes are not let go faster */
    float lift;                  /* cells: of the domain above the nodes that are its ground */
    float rebound;               /* share of elastic energy that comes back from an impact */
    float full;                  /* kg: of a node's room full of rock */
    uint walls;
    float played; /* m/s: what a particle's velocity is for one of its own */
};
SHARED_SIZE(mpm_params, 92)

/* 1/s: unloading this fast gives back no more than the rebound's share; slower, more. */
#define MPM_REBOUND_RATE 0.2f

struct mpm_load_params {
    uint n;
    uint seed;
    float strength; /* Pa */
    float joint;    /* Pa: at joints */
    float block;    /* m: size of the pieces that joints cut; 0: no joints */
    float width;    /* blocks: half of a joint's */
    uint nx, ny;    /* lattice of the pieces' seeds, one longer than the domain at both ends */
    uint pieces;    /* how many seeds there are */
};
SHARED_SIZE(mpm_load_params, 36)

/* Loose grains are of no piece, and particles that are not at a joint have none. */
#define MPM_LOOSE 0u
#define MPM_NO_JOINT 0xffffffffu

/* A joint lies between a piece and one of those after it, at most two seeds away on every axis. */
#define MPM_JOINTS 62u

/* Pieces that a node tells apart. */
#define MPM_BODIES 8

/* Of a particle that has not broken; others hold how much they have come apart, as a volume strain. */
#define MPM_WHOLE (-1.0f)

/* Words of the static solver's scalars. */
#define MPM_LAST 0u
#define MPM_KEEP 1u
#define MPM_PEAK 2u
#define MPM_ENERGY 3u

/* ---- field: the surface field and what lies on it */

struct field_params {
    uint n;
    uint nx, ny, nz; /* voxels of the domain (particle index) */
    float h;         /* m */
    uint fx, fy, fz; /* samples of the field: the voxels and a margin */
    uint margin;     /* voxels */
    uint walls;
    float repose;   /* tangent of the angle at which heaps lie */
    uint component; /* of a vector */
};
SHARED_SIZE(field_params, 48)

/* In a slot: all of the brick is inside, and none of its samples are kept. */
#define SLOT_INSIDE 0xffffffffu

/* Words of field/extent. */
#define EXTENT_ANY 0x80000000u
#define EXTENT_ALL (EXTENT_ANY | 0x3fe00u)

struct march_params {
    uint n;
    uint width, height;
    uint fx, fy, fz;
    float voxel;
    float origin_x, origin_y, origin_z;
    float eye_x, eye_y, eye_z;
    float right_x, right_y, right_z; /* half the film's width, in directions at distance 1 */
    float down_x, down_y, down_z;    /* half its height */
    float ahead_x, ahead_y, ahead_z;
    float sun_x, sun_y, sun_z; /* unit vector towards the sun */
    uint ray, rays;            /* of the pixel; a single one has a sun without extent and an open sky */
    float film_x, film_y;      /* px: where in the pixel */
    uint ground;               /* 1: rays that meet no rock see the level ground at z = 0 */
};
SHARED_SIZE(march_params, 120)

#define LIT_SUN 1.0f
#define LIT_SKY 2.0f

/* What the ground around the rock sends back of light: dry sand. */
#define GROUND_R 0.46f
#define GROUND_G 0.33f
#define GROUND_B 0.22f

/* Where a ray meets the ground and no rock, the last of its hit is this, less the depth. */
#define HIT_GROUND -2.0f

struct shade_params {
    uint n;
    uint nx, ny, nz;
    float h;
    uint fx, fy, fz;
    float voxel;
    float origin_x, origin_y, origin_z;
    float sun_x, sun_y, sun_z;
    float sun_r, sun_g,
        sun_b; /* on what faces it; of the open sky on what faces up; of the ground on what faces down */
    float sky_r, sky_g, sky_b;
    float bounce_r, bounce_g, bounce_b;
    uint ray, rays;
};
SHARED_SIZE(shade_params, 104)

/* The lattice of the wind; one sample of it, alone, is the same everywhere. */
struct pixel_air_params {
    uint n;
    uint ax, ay, az;
    float cell;
    float origin_x, origin_y, origin_z; /* m: sample 0 */
};
SHARED_SIZE(pixel_air_params, 32)

/* ---- voxels: a bit a voxel, in words of 32 along x, with a margin of M rows and slabs around the domain and
 * one word of air between rows. A voxel's number is its bit's. See voxels/voxels.h. */

#define VOXELS_BRICK 8u        /* rows and slabs of a brick, which is a word wide */
#define VOXELS_PACERS 2048u    /* threads that look for the next event */
#define VOXELS_SLIVER 1e-5f    /* a voxel with no more than this left is gone */
#define VOXELS_UNKNOWN 0xffffu /* the air in the bubble of a voxel that has not been active */

/* Words the device tells the host. */
#define VOXELS_GONE 0u /* how many vanished */
#define VOXELS_CHANGED 1u

struct voxels_params {
    uint n;
    uint words;      /* of a bit set: gone in the first half of `bits`, rock in the second */
    uint row, slab;  /* words from one row, or slab, to the next */
    uint rows;       /* rows of a slab */
    uint margin;     /* rows and slabs around the domain */
    uint nx, ny, nz; /* voxels of the domain */
    uint reach;      /* bricks that a bubble reaches beyond its own, in y and z */
    uint brick_rows, brick_slabs;
    uint skin_rows; /* rows of the skin's ball, at the end of the table of rows */
    uint skin_first;
    float dt;                /* kyr */
    float per_row, per_slab; /* 1 / row, 1 / slab */
    uint walls;
    uint tilted; /* 1: strata are known by voxel; 0: by slab */
};
SHARED_SIZE(voxels_params, 76)

#undef SHARED_SIZE
#endif
