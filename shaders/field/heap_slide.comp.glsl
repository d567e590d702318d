#version 460
#extension GL_GOOGLE_include_directive : require
// Per column, one sweep: part of what exceeds repose between two columns slides to the lower one. Each column
// gathers what its neighbours give, so the volume is conserved.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, slot)
READ_F(2, height)
READ_V(3, base)
WRITE_F(4, after)
PARAMS(field_params)
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/sides.glsl"
#include "field/heap.glsl"

const float ENOUGH = 7.0; // units beyond repose from which material slides

// Units that slide to each of eight neighbours: a tenth of the excess, which is stable on the roughest ground, at most an eighth of
// what the column has, and one unit if the excess is only a few. The added half unit keeps the tenth away from integers, where
// rounding could change its floor.
float sliding(float over, float thick)
{
    return min(max(floor(0.1 * (over + 0.5)), over >= ENOUGH ? 1.0 : 0.0), floor(0.125 * thick));
}

// Sample of the nearest head in the column of v; SAMPLE_NONE if there is none within HEAP_REACH.
uint head_near(ivec3 v)
{
    for (int i = 0; i <= 2 * HEAP_REACH; i++) {
        uint s = voxel_sample(v + ivec3(0, 0, heap_look(i)));
        if (s != SAMPLE_NONE && LOAD_F(height, s) != HEAP_NONE)
            return s;
    }
    return SAMPLE_NONE;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    float own = LOAD_F(height, i), change = 0.0, bottom = LOAD_V(base, i).x;
    if (own == HEAP_NONE) {
        AT(after, i) = own;
        return;
    }
    ivec3 v = brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES) - int(k.margin);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            uint s = x == 0 && y == 0 ? SAMPLE_NONE : head_near(v + ivec3(x, y, 0));
            if (s == SAMPLE_NONE)
                continue;
            float drop = own - LOAD_F(height, s), most = round(HEAP_UNIT * k.repose * (x != 0 && y != 0 ? 1.41421356 : 1.0));
            if (drop > most)
                change -= sliding(drop - most, own - bottom);
            else if (-drop > most)
                change += sliding(-drop - most, LOAD_F(height, s) - LOAD_V(base, s).x);
        }
    AT(after, i) = own + change;
}
