#version 460
#extension GL_GOOGLE_include_directive : require
// One round of joining blocks across faces. Every voxel points to its block's root; where a neighbour's root
// is lower, the own root is hung below it. Minima of integers: the outcome, each block's lowest voxel as its
// root, does not depend on order. Voxels are numbered upwards, so that this is a voxel on the ground if the
// block has any.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, list)
READ_U(2, solid)
READ_U(3, root)
WRITE_U(4, pointer)
WRITE_U(5, counts)
PARAMS(voxel_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"

// The lower one of a root and that of the neighbour v.
uint lower(uint least, ivec3 v)
{
    uint s = voxel_inside(v) ? voxel_slot(v) : NOT_HELD;
    if (s == NOT_HELD)
        return least;
    // Roots differ only across a boundary of blocks: look there before asking whether there is rock.
    uint other = LOAD_U(root, s);
    return other < least && LOAD_U(solid, s) != 0u ? other : least;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n || LOAD_U(solid, i) == 0u)
        return;
    ivec3 v = voxel_at(LOAD_U(list, i));
    uint own = LOAD_U(root, i), least = own;
    least = lower(least, v - ivec3(1, 0, 0));
    least = lower(least, v + ivec3(1, 0, 0));
    least = lower(least, v - ivec3(0, 1, 0));
    least = lower(least, v + ivec3(0, 1, 0));
    if (least < own) {
        atomicMin(AT(pointer, own), least);
        AT(counts, COUNT_CHANGED) = 1u;
    }
}
