#version 460
#extension GL_GOOGLE_include_directive : require
// One round of joining blocks across faces. Every voxel points to its block's root; where a neighbour's root
// is lower, the own root is hung below it. Minima of integers: the outcome, each block's lowest voxel as its
// root, does not depend on order. Voxels are numbered upwards, so that this is a voxel on the ground if the
// block has any. A joint parts what is beside it; what is above lies on what is below.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, list)
READ_U(2, solid)
READ_U(3, root)
WRITE_U(4, pointer)
WRITE_U(5, counts)
READ_U(6, parted) // geology/maps.h; none of its words means anything where k.parted is 0
PARAMS(join_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"

// Whether a joint parts v from the voxel before it, in x (0) or y (1).
bool parts(ivec3 v, uint axis)
{
    return k.parted != 0u && voxel_inside(v) && (LOAD_U(parted, 2u * voxel_word(v) + axis) & voxel_bit(v)) != 0u;
}

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
    for (uint axis = 0u; axis < 2u; axis++) {
        ivec3 next = ivec3(axis == 0u, axis == 1u, 0);
        if (!parts(v, axis))
            least = lower(least, v - next);
        if (!parts(v + next, axis))
            least = lower(least, v + next);
    }
    if (least < own) {
        atomicMin(AT(pointer, own), least);
        AT(counts, COUNT_CHANGED) = 1u;
    }
}
