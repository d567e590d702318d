#version 460
#extension GL_GOOGLE_include_directive : require
// Per kept cell: `fill` is the viability of the particles in its eight voxels, divided by eight; `weight` is
// its weight in full cells of rock. In a cell with deposits or softened by joints `fill` is instead
// minus its share of the full stiffness. The weight of deposits acts on the next cell below with at least half
// its volume in rock, so that a heap presses down and does not hang on a wall beside it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, run)
READ_U(1, words)
READ_U(2, start)
READ_F(3, viability)
READ_U(4, phase)
WRITE_F(5, fill)
WRITE_F(6, weight)
READ_F(7, stiff)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/stiff.glsl"
#define HELD_NX (2u * (k.cx - 2u))
#define HELD_NY (2u * (k.cy - 2u))
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

const float BEARS = 4.0; // voxels of rock in a cell, of 8, from which it carries deposits above it

// (rock, deposits) in a voxel, by viability; deep voxels are full of rock.
vec2 rock_in(ivec3 v)
{
    if (voxel_deep(v))
        return vec2(1.0, 0.0);
    vec2 sum = vec2(0.0);
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++)
        sum += LOAD_U(phase, j) == 1u ? vec2(0.0, LOAD_F(viability, j)) : vec2(LOAD_F(viability, j), 0.0);
    return sum;
}

// (rock, deposits) in a cell: the sum over its eight voxels.
vec2 held_in(ivec3 c)
{
    vec2 sum = vec2(0.0);
    for (int b = 0; b < 4; b++) {
        ivec3 v = 2 * (c - 1) + ivec3(0, b & 1, b >> 1);
        sum += rock_in(v) + rock_in(v + ivec3(1, 0, 0));
    }
    return sum;
}

// Deposits in the cells above this one, up to the next cell that carries them itself or has none.
float on_top(ivec3 c)
{
    float sum = 0.0;
    for (c.z++; c.z < int(k.cz) - 1; c.z++) {
        vec2 above = held_in(c);
        if (above.x >= BEARS || above.y == 0.0)
            break;
        sum += above.y;
    }
    return sum;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint own = LOAD_U(run, i / STRESS_RUN);
    ivec3 c = node_of(own, i, uvec3(k.cx, k.cy, k.cz)), cells = ivec3(k.cx, k.cy, k.cz);
    vec2 sum = vec2(0.0);
    if (own != STRESS_NO_RUN && all(greaterThanEqual(c, ivec3(1))) && all(lessThan(c, cells - 1)))
        sum = held_in(c);
    float full = min((sum.x + sum.y) / 8.0, 1.0);
    float rock = stiff_rock(c);
    AT(fill, i) = sum.y > 0.0 ? -stiffness(full) * (rock * sum.x + k.loose * sum.y) / (sum.x + sum.y)
                  : rock < 1.0 && full > 0.0 ? -stiffness(full) * rock : full;
    AT(weight, i) = min(sum.x / 8.0, 1.0) + (sum.x >= BEARS ? (sum.y + on_top(c)) / 8.0 : 0.0);
}
