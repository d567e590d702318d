#version 460
#extension GL_GOOGLE_include_directive : require
// Per solid held voxel, one round of labelling: hangs its root below that of a face neighbour if that is lower.
// Integer minima: the result, each block's lowest voxel as its root, does not depend on order. Voxels are
// numbered upwards, so a block's root is in the first slab if the block stands on the ground. Joints separate
// voxels beside each other; a voxel always rests on the one below.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, list)
READ_U(2, solid)
READ_U(3, root)
WRITE_U(4, pointer)
WRITE_U(5, flags)
READ_U(6, parted) // geology/maps.h; not read if k.parted is 0
PARAMS(join_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"

// Whether a joint separates v from the voxel before it in x (axis 0) or y (1).
bool parts(ivec3 v, uint axis)
{
    return k.parted != 0u && voxel_inside(v) && (LOAD_U(parted, 2u * voxel_word(v) + axis) & voxel_bit(v)) != 0u;
}

// The smaller of a root and that of the neighbour v.
uint lower(uint least, ivec3 v)
{
    uint s = voxel_inside(v) ? voxel_slot(v) : NOT_HELD;
    if (s == NOT_HELD)
        return least;
    // Roots rarely differ, so compare them before reading `solid`.
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
        AT(flags, k.flag) = 1u;
    }
}
