/* Parameters of the kernels (push constants) and constants, shared by C and GLSL. Only scalars, so that layouts cannot differ, and at
 * most 128 bytes per struct. The first member `n` is the number of invocations with work to do. */
#ifndef HOODOO_PARAMS_H
#define HOODOO_PARAMS_H

#ifdef __STDC_VERSION__
#include <stdint.h>
typedef uint32_t uint;
#define SHARED_SIZE(type, bytes) _Static_assert(sizeof(struct type) == (bytes), #type " drifted");
#else
#define SHARED_SIZE(type, bytes)
#endif

/* For kernels that need only a count. */
struct count_params {
    uint n;
};
SHARED_SIZE(count_params, 4)

/* ---- numbers */

/* For each of NUMBERS_ARRAYS arrays of n items, found[slot] becomes the smallest number of an item that is not finite or whose magnitude
 * exceeds `most`. NUMBERS_THREADS threads check every NUMBERS_THREADS-th item each. On a CPU device, starting a thread costs more than
 * checking a number, and starting a kernel more than checking an array of a small job. */
#define NUMBERS_THREADS 8192u
#define NUMBERS_ARRAYS 8
struct numbers_params {
    uint n[NUMBERS_ARRAYS], slot[NUMBERS_ARRAYS];
    float most;
};
SHARED_SIZE(numbers_params, 68)

/* ---- gpu: scan, sort, reduce */

/* `flag` is the item of gpu_rounds.flags that a kernel sets if another round is needed. */
struct double_params {
    uint n;
    uint flag;
};
SHARED_SIZE(double_params, 8)

#define SCAN_RUN 64u
#define REDUCE_THREADS 2048u

struct scan_params {
    uint n; /* runs */
    uint n_values;
};
SHARED_SIZE(scan_params, 8)

struct sort_params {
    uint n;
    uint n_ordered; /* items of keys >= n_ordered may come in any order */
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

/* ---- the domain's sides: bits of `walls`. Beyond a wall the rock continues as its mirror image; at the other sides, which are open,
 * it ends. See particles/sides.glsl. */

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

/* Joining of blocks: `parted` is 1 if joints separate voxels. */
struct join_params {
    uint n;
    uint nx, ny, nz;
    float h;
    uint parted;
    uint flag; /* gpu_rounds */
};
SHARED_SIZE(join_params, 28)

/* The ratio of the speeds of a front along beds and across them is stored as MAPS_OCTAVE log2(ratio). */
#define MAPS_OCTAVE 32

struct lead_params {
    uint n;
    uint nx, ny, nz;
    float h;
    float bed_x, bed_y, bed_z; /* unit normal of the beds */
};
SHARED_SIZE(lead_params, 32)

/* Blocks with fewer than `least` particles become fragments. */
struct crumble_params {
    uint n;
    uint nx, ny, nz;
    float h;
    uint least;
};
SHARED_SIZE(crumble_params, 24)

/* Stride of `words` per word of bits (particles/held.glsl). */
#define HELD_STRIDE 3u

struct hold_params {
    uint n; /* words of bits, plus one */
    uint nx, ny, nz;
    uint around; /* 1: voxels around occupied ones are held, too */
};
SHARED_SIZE(hold_params, 20)

/* Deep voxels whose particles are to be created. */
struct born_params {
    uint n;   /* words of bits */
    uint all; /* 1: all of them */
};
SHARED_SIZE(born_params, 8)

/* Rock within NEAR_REACH voxels of an empty one, along every axis, always has particles, and so have its neighbours: no process and
 * no output at the surface reads deeper rock. When a voxel without particles comes that near, NEAR_AHEAD more layers get theirs, too,
 * so that this does not happen in every step. */
#define NEAR_REACH 4u
#define NEAR_AHEAD 3u

/* Runs of deep voxels among the nodes of blocks. */
struct runs_params {
    uint n; /* words of bits (plus one to count runs), or entries of the list */
    uint nx, ny, nz;
    uint slots; /* number of held voxels, whose nodes come first */
    uint words; /* number of words of bits */
    uint flag;  /* gpu_rounds */
};
SHARED_SIZE(runs_params, 28)

/* One axis of the search for voxels near the surface. */
struct near_params {
    uint n; /* words of bits */
    uint nx, ny, nz;
    uint axis, reach; /* 0 to 2; voxels, at most 31 */
};
SHARED_SIZE(near_params, 24)

#define PHASE_ROCK 0u
#define PHASE_DEPOSIT 1u
#define PHASE_FALLING 2u

/* Weights of the share of rock around a voxel's centre, from the fill of the voxel, its 6 face and its 12 edge neighbours. The
 * surface is where the share is 1/2. They are those of (1 - r^2 / 4 h^2)^3, rounded so that they sum to 1; the surface of a plane face
 * is exactly where its fill puts it. */
#define SHARE_SELF 0.2f
#define SHARE_FACE (1.0f / 12.0f)
#define SHARE_EDGE 0.025f

/* ---- stress: hexahedra of 2 h; nodes and cells have a margin of one empty cell on every side */

#define STRESS_FILL_FLOOR 0.05f

/* Sparse storage (stress/grid.glsl): runs of STRESS_RUN nodes or cells along x. The STRESS_FIRST runs before the first kept one and
 * one after the last are zero; lookups of runs that are not kept lead to the item STRESS_EMPTY. */
#define STRESS_RUN 8u
#define STRESS_FIRST 2u
#define STRESS_EMPTY 8u
#define STRESS_NO_RUN 0xffffffffu /* entry of `run` for the zero runs */

struct stress_params {
    uint n;
    uint cx, cy, cz;  /* cells with margin; nodes are one more on each axis */
    float lambda, mu; /* Pa */
    float dx;         /* m: cell size */
    float weight;     /* N: weight of a full cell */
    uint walls;
    float loose;  /* stiffness of deposits, as a share of the rock's */
    uint jointed; /* 1: `stiff` holds the stiffness of jointed rock */
};
SHARED_SIZE(stress_params, 44)

/* Multigrid smoother: stress parameters of a level, and the weights of a step. */
struct smooth_params {
    uint n;
    uint cx, cy, cz;
    float lambda, mu;
    float dx;
    float keep, gain;
    uint second; /* 1: the previous correction was zero */
    uint walls;
};
SHARED_SIZE(smooth_params, 44)

/* Between a level of cells (cx, cy, cz) and the coarser one of cells (px, py, pz). Along each axis coarse cell c has the children
 * 2 c - 1 and 2 c, and coarse node a coincides with node 2 a - 1: the ground is node 1 on all levels. */
struct coarse_params {
    uint n;
    uint cx, cy, cz;
    uint px, py, pz;
    uint walls;
};
SHARED_SIZE(coarse_params, 32)

/* Items of the solver's scalar buffer. From CG_ENERGY on: the energy that each of the last CG_CHECK iterations removed from the
 * error. */
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
    uint first;     /* 1: first iteration, beta = 0 */
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

/* A round of erosion/carry: the rest of a step is carried on by one voxel in each. */
struct carry_params {
    uint n;
    uint nx, ny, nz;
    float h;
    uint walls;
    uint round;
};
SHARED_SIZE(carry_params, 28)

/* Frost and heat: intensity *= exp(n.x * x + n.y * y + per_m * z). */
struct aspect_params {
    uint n;
    float x, y;  /* log(rate) / 2 times the azimuth's unit vector */
    float per_m; /* 1/m: log(rate_per_100m) / 100 */
};
SHARED_SIZE(aspect_params, 16)

/* Sheeting in a step. */
struct sheeting_params {
    uint n;
    uint seed;
    float thick, wide; /* m */
    float strength;    /* Pa */
    float from, to;    /* begin and end of the step, in sheets per patch (per_kyr t) */
    float kyr;         /* length of the step */
};
SHARED_SIZE(sheeting_params, 32)

/* Exposure age, crust and damp. */
struct skin_params {
    uint n;
    uint nx, ny, nz;
    float h; /* m */
    uint walls;
    float depth; /* m: depth at which exposure is 1/e of the face's */
    uint reach;  /* voxels: search distance for faces */
    float kyr;   /* length of the step, or age in the first frame */
    float crust_kyr;
    float crust;  /* how many times more slowly rock weathers under a full crust */
    float damp;   /* how many times faster rock weathers in the damp */
    float radius; /* m: of the ball in which rock is counted; 0: no damp */
};
SHARED_SIZE(skin_params, 52)

/* Seepage. */
struct seep_params {
    uint n;
    uint nx, ny, nz;
    float h; /* m */
    uint walls;
    uint beds;             /* number of beds that hold water */
    float zone;            /* m: height of the wet zone above a bed */
    float rate, threshold; /* yr/m, m/yr: k and q_c of sapping, k (q - q_c)+ */
    float strength;        /* strength of wet rock, as a share of dry rock's */
    float band;
};
SHARED_SIZE(seep_params, 48)

/* Items of the erosion's counters; the FASTEST ones are floats. */
#define COUNT_ERODED 0u
#define COUNT_FALLEN 1u
#define COUNT_FASTEST_ROCK 3u
#define COUNT_FASTEST_LOOSE 4u
#define COUNT_FASTEST_SLOPE 5u
#define COUNT_BORN 5u

/* The budget of a frame: a row for each process (enum process in job/job.h), with a two-word sum for each lane. */
#define BUDGET_LANES 2048u

struct budget_params {
    uint n; /* lanes */
    uint n_values;
    uint row;
    uint after; /* 1: add; 0: subtract */
};
SHARED_SIZE(budget_params, 16)

struct budget_split_params {
    uint n; /* lanes */
    uint n_values;
    uint deflation, water, abrasion, reworking, sheets; /* rows of the processes */
};
SHARED_SIZE(budget_split_params, 28)

/* ---- wind */

struct wind_params {
    uint n;
    uint nx, ny, nz;
    float h;                            /* m */
    float deflation;                    /* k_d */
    float cohesion, friction, strength; /* mu_c (Pa), mu_f, alpha (Pa) */
    float abrasion, gale;               /* k_a (|v| / v_ref)^2, and (|v| / v_ref)^2 */
    float wind_x, wind_y, wind_z;       /* unit vector that the wind blows to */
    float shelter;            /* m: sheltering distance; with a flow, distance at which the air is sampled */
    uint bx, by, bz;          /* cells of the averaged flow */
    float origin_x, origin_y; /* m: their low corner */
    float cell;               /* m: their size */
    uint walls;
};
SHARED_SIZE(wind_params, 88)

/* Units of the flow: spacing of its particles, and wind speed. The origin is the low corner of the box, on the ground. */
#define FLOW_SUPPORT 2.0f          /* kernel support radius */
#define FLOW_NEIGHBOURS 80u        /* longest neighbour list */
#define FLOW_FIXED 256.0f          /* fixed-point scale of positions and normals in integer sums */
#define FLOW_ROCK_ID 0xc0000000u   /* first id of the rock's boundary particles */
#define FLOW_GROUND_ID 0x80000000u /* first id of the ground's */

/* Kind of a particle, in w of its velocity. */
#define FLOW_AIR 0.0f
#define FLOW_SKIN 1.0f /* air near the sides or the top, which moves with the wind */
#define FLOW_ROCK 2.0f
#define FLOW_GROUND 3.0f

struct flow_params {
    uint n;
    uint slots;           /* capacity of the particle arrays */
    uint first;           /* first slot or id; or the colour of a half sweep */
    uint bx, by, bz;      /* size of the box */
    uint gx, gy, gz;      /* cells of the neighbour search, one support wide */
    float wind_x, wind_y; /* unit vector */
    float dt;
    float viscosity;
    float warm; /* share of the last step's pressure to start from; or 1 / samples of a block */
    float full; /* density from which pressure may be negative */
    float keep,
        gain; /* weights of the old average and of a block; gain also: factor of drift, viscosity, relaxation */
    float column_x, column_y; /* emission: offset of the lattice's first column in the box */
    uint enter_x, enter_y;    /* emission: plane of the lattice that has just entered; box size: none */
    uint nx, ny, nz;          /* the rock's voxels */
    float h;                  /* m */
    float origin_x, origin_y; /* m: of the box in the rock's domain */
    float spacing;            /* m */
    uint walls;
};
SHARED_SIZE(flow_params, 116)

/* ---- water: see water/water.h. Cells are cubes of `size` voxels a side; voxel v is in cell (v + shift) / size. A column's cells are
 * bits, `words` words of 32 levels each; its spans are nodes, numbered upwards, column by column. */

#define WATER_EMPTY 0u
#define WATER_SURF 1u
#define WATER_WALL 2u
#define WATER_SOLID 3u
#define WATER_KIND 3u
#define WATER_OUT 4u
#define WATER_DEAD 8u
#define WATER_SWEPT 16u

/* In spacings: lower bound of drops between floors, the size of their random roughness (water/altitude). */
#define WATER_LEVEL_DROP 0.015625f

/* Upper bound of falls in units of altitude, 2^-16 cells, so that the sum of four fits an int. */
#define WATER_FALL 0x1fffffff

/* 2^32 over the golden ratio: multiples modulo 2^32 are evenly distributed. */
#define WATER_TURN 2654435769u

/* Purposes of hashes (with water_params.random). */
#define RANDOM_ROUGHNESS 1u
#define RANDOM_RECEIVER 2u
#define RANDOM_SHIFT 3u

struct water_params {
    uint n;
    uint vx, vy, vz; /* voxels of the domain */
    uint size;       /* voxels along a cell's side: 1 or 2 */
    uint sx, sy, sz; /* shift; 0 where size is 1 */
    uint cx, cy, cz; /* cells */
    uint words;      /* words of a column */
    uint nodes;      /* number of nodes; also the number of the outside */
    uint basins;     /* number of basins; also the number of the outside */
    uint leak;
    uint random; /* hash of seed, frame and step */
    uint rain;   /* units of rain on a column of voxels */
    uint round;
    float per_row, per_slab; /* 1 / cx, 1 / (cx cy) */
    uint walls;
    uint flag; /* gpu_rounds */
};
SHARED_SIZE(water_params, 88)

/* Shares of a span's rain sum to this. */
#define WATER_WHOLE 0x8000u

/* Width and shear stress of streams; cells of one voxel. */
struct water_stream_params {
    uint n;
    uint cx, cy, cz;
    uint words;
    float h;                      /* m */
    float rain_unit, spring_unit; /* m3/yr */
    float width, power, least;    /* width of a stream of Q m3/yr, m: max(width Q^power, least) */
    float narrowest, widest;      /* m: limits of the width that cells resolve */
    float window;                 /* m: radius within which slopes are measured */
    float deep;           /* m: height of banks; and depth of standing water at which shear stress vanishes */
    uint reach;           /* cells: the farthest reach of a stream or a slope */
    float pull, steepest; /* k_f (Pa); largest slope */
    float per_row, per_slab; /* 1 / cx, 1 / (cx cy) */
    uint walls;
};
SHARED_SIZE(water_stream_params, 84)

struct water_surface_params {
    uint n;
    uint nx, ny, nz;               /* voxels, which are the cells */
    float h;                       /* m */
    uint words;                    /* words of a column */
    uint size, sx, sy, sz, cx, cy; /* size, shift and number of the fragments' cells */
    float rate, threshold;         /* k_t (1/Pa), tau_c (Pa) */
    float carry;                   /* Pa: shear stress above which no deposit comes to rest */
    uint walls;
};
SHARED_SIZE(water_surface_params, 64)

/* ---- deposits: voxels as bits of columns, 32 to a word; routing cells of 2^3 voxels, on a shifted grid */

#define DEPOSIT_ROOM 4u /* most fragments that land in a cell in a round */

/* A fragment's place is the number of its voxel plus one, or: */
#define DEPOSIT_WAITS 0u         /* it has not landed yet */
#define DEPOSIT_LEFT 0xffffffffu /* it has left the domain */
#define DEPOSIT_HELD 0xfffffffeu /* it stays where it is until the next landing */

struct deposit_params {
    uint n;
    uint nx, ny, nz; /* voxels */
    float h;         /* m */
    uint words;      /* words of a column */
    uint cx, cy, cz; /* routing cells */
    int sx, sy, sz;  /* shift: voxel v is in cell (v + shift) / 2 */
    float repose;    /* tangent of the angle of repose */
    uint seed;       /* hash of the job's seed, the frame and the step */
    uint round;
    uint last;     /* 1: last round of a landing; 2: and no landing follows */
    float quicker; /* factor of a deposit's rate against the rock it was */
    uint walls;
    float through; /* share of plant cover that grows through one voxel of deposits */
    uint dust;     /* hash of the job's seed */
    float bulk;    /* share of eroded rock that comes to rest */
};
SHARED_SIZE(deposit_params, 84)

/* Items of the deposition's counters. */
#define COUNT_LANDED 0u
#define COUNT_GONE 1u
#define COUNT_SLID 2u
#define COUNT_WAITING 3u

/* ---- plants */

struct plants_params {
    uint n;
    uint nx, ny, nz;
    float h;             /* m */
    float steepest;      /* cosine of the steepest slope on which plants stand */
    float growth, death; /* factors of this frame: e^(rate dt), e^(-rate dt) */
    float binding, shelter;
    uint seed;
    uint spread;  /* number of the voxel step in this frame */
    float seeds;  /* m: mean distance of seeds */
    float chance; /* chance of a seedling on a particle in this frame, for seeds from full cover */
    uint walls;
};
SHARED_SIZE(plants_params, 60)

/* ---- mpm: material points on cells of 2 h. Nodes and base cells share a numbering, on a lattice three longer than the domain's cells
 * along every axis; a particle's base cell is that of the first of its 27 nodes. Node (1, 1, 1) is at the origin or, for rock in
 * motion, 3/4 of a cell below it, so that rock on the ground touches it without a gap. See mpm/mpm.h. */

struct mpm_params {
    uint n;
    uint cx, cy, cz;             /* cells of the domain */
    uint n_parts;                /* number of parts: row length of the partial sums */
    uint bodies;                 /* 1: several bodies; 0: one */
    uint rock;                   /* 1: resting rock is an obstacle */
    float dx;                    /* m */
    float dt;                    /* s */
    float lambda, mu, viscosity; /* Pa, Pa, Pa s */
    float push;                  /* m3/(kg m2): 4 / (density dx^2), or 0 to leave out the stress */
    float mass;                  /* kg: of a full particle */
    float gravity;               /* m/s2 */
    float friction;              /* Coulomb coefficient */
    float alpha;                 /* of the Drucker-Prager cone */
    float fastest; /* m/s: limit of nodes' speeds; in mpm/store: speed above which points count as falling */
    float lift;    /* cells: height of the ground above its nodes */
    float rebound; /* factor of the stress during fast unloading */
    float full;    /* kg: a node's volume full of rock */
    uint walls;
    float played; /* factor for velocities given to particles */
};
SHARED_SIZE(mpm_params, 92)

/* 1/s: unloading at this rate or faster has the full rebound factor; slower unloading proportionally less of it. */
#define MPM_REBOUND_RATE 0.2f

struct mpm_load_params {
    uint n;
    uint seed;
    float strength; /* Pa */
    float joint;    /* Pa: at joints */
    float block;    /* m: size of the pieces between joints; 0: no joints */
    float width;    /* half the width of a joint, in `block` */
    uint nx, ny;    /* lattice of the pieces' seeds, one longer than the domain at both ends */
    uint pieces;    /* number of seeds */
};
SHARED_SIZE(mpm_load_params, 36)

/* The piece of loose grains, and the joint of particles that are not at one. */
#define MPM_LOOSE 0u
#define MPM_NO_JOINT 0xffffffffu

/* Number of a piece's joints: with the pieces that follow it in order, at most two seeds away along every axis. */
#define MPM_JOINTS 62u

/* Bodies that a node distinguishes. */
#define MPM_BODIES 8

/* MPM_APART of a particle that has not broken; broken ones hold the volume strain by which they have come apart. */
#define MPM_WHOLE (-1.0f)

/* Items of the static solver's scalars. */
#define MPM_LAST 0u
#define MPM_KEEP 1u
#define MPM_PEAK 2u
#define MPM_ENERGY 3u

/* ---- field: the surface field and what it carries */

struct field_params {
    uint n;
    uint nx, ny, nz; /* voxels of the domain (particle index) */
    float h;         /* m */
    uint fx, fy, fz; /* samples of the field: the voxels and a margin */
    uint margin;     /* voxels */
    uint walls;
    float repose;   /* tangent of the angle of repose */
    uint component; /* of a vector */
};
SHARED_SIZE(field_params, 48)

/* Slot of a brick that is all inside and has no samples. */
#define SLOT_INSIDE 0xffffffffu

/* Extents that field/reach writes. */
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
    uint ray, rays; /* sample number, and samples per pixel; a single one has a point sun and an open sky */
    float film_x, film_y; /* px: position in the pixel */
    uint ground;          /* 1: rays that hit no rock see level ground at z = 0 */
    uint cut;             /* 0: none; CUT_KEEPS_LOW or CUT_KEEPS_HIGH, and the axis */
    float cut_at;         /* m: rock on one side of this plane is not shown */
};
SHARED_SIZE(march_params, 128)

#define CUT_KEEPS_LOW 4u
#define CUT_KEEPS_HIGH 8u

#define LIT_SUN 1.0f
#define LIT_SKY 2.0f

/* Albedo of the ground around the rock: dry sand. */
#define GROUND_R 0.46f
#define GROUND_G 0.33f
#define GROUND_B 0.22f

/* hit.w of a ray that hits the ground is HIT_GROUND - depth. */
#define HIT_GROUND -2.0f

struct shade_params {
    uint n;
    uint nx, ny, nz;
    float h;
    uint fx, fy, fz;
    float voxel;
    float origin_x, origin_y, origin_z;
    float sun_x, sun_y, sun_z;
    float sun_r, sun_g, sun_b;          /* irradiance of a face towards the sun */
    float sky_r, sky_g, sky_b;          /* of an upward face under open sky */
    float bounce_r, bounce_g, bounce_b; /* of a downward face above the ground */
    uint ray, rays;
};
SHARED_SIZE(shade_params, 104)

/* The lattice of the averaged air; with one sample, the wind is uniform. */
struct pixel_air_params {
    uint n;
    uint ax, ay, az;
    float cell;
    float origin_x, origin_y, origin_z; /* m: position of sample 0 */
};
SHARED_SIZE(pixel_air_params, 32)

/* ---- voxels: a bit per voxel, in words of 32 along x, with `margin` rows and slabs around the domain and one word of margin between
 * rows. A voxel's number is that of its bit. See voxels/voxels.h. */

#define VOXELS_BRICK 8u        /* rows and slabs of a brick, which is one word wide */
#define VOXELS_PACERS 2048u    /* threads that search for the next event */
#define VOXELS_SLIVER 1e-5f    /* a voxel with at most this share left vanishes */
#define VOXELS_UNKNOWN 0xffffu /* air count of a voxel that has not been active yet */

/* Items that the host reads. */
#define VOXELS_GONE 0u /* number of voxels that vanished */

struct voxels_params {
    uint n;
    uint words;      /* words of a bit set; `bits` holds two: gone, then rock */
    uint row, slab;  /* stride of rows and of slabs, in words */
    uint rows;       /* rows of a slab */
    uint margin;     /* rows and slabs around the domain */
    uint nx, ny, nz; /* voxels of the domain */
    uint reach;      /* bricks that a bubble reaches beyond its own, in y and z */
    uint brick_rows, brick_slabs;
    uint skin_rows; /* rows of the skin's ball, which begin at skin_first in the table of rows */
    uint skin_first;
    float dt;    /* kyr */
    float early; /* kyr: a voxel that would vanish within this time after the cycle vanishes in it */
    float per_row, per_slab; /* 1 / row, 1 / slab */
    uint walls;
    uint tilted; /* 1: strata are stored by voxel; 0: by slab */
    uint flag;   /* gpu_rounds */
};
SHARED_SIZE(voxels_params, 84)

#undef SHARED_SIZE
#endif
