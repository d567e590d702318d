#version 460
#extension GL_GOOGLE_include_directive : require
// One round of joining blocks across faces. Every voxel points to its block's root; where a neighbour's root
// is lower, the own root is hung below it. Minima of integers: the outcome, each block's lowest voxel as its
// root, does not depend on order. Voxels are numbered upwards, so that this is a voxel on the ground if the
// block has any.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, solid)
READ_U(1, root)
WRITE_U(2, pointer)
WRITE_U(3, counts)
PARAMS(voxel_params)

bool rock(uint v)
{
    return LOAD_U(solid, v) != 0u;
}

void main()
{
    uint v = THREAD;
    if (v >= k.n || !rock(v))
        return;
    uint x = v % k.nx, y = (v / k.nx) % k.ny, own = LOAD_U(root, v), least = own;
    // A root differs from the own only across a boundary of blocks: look there before asking whether there is
    // rock.
    if (x > 0u && LOAD_U(root, v - 1u) < least && rock(v - 1u))
        least = LOAD_U(root, v - 1u);
    if (x + 1u < k.nx && LOAD_U(root, v + 1u) < least && rock(v + 1u))
        least = LOAD_U(root, v + 1u);
    if (y > 0u && LOAD_U(root, v - k.nx) < least && rock(v - k.nx))
        least = LOAD_U(root, v - k.nx);
    if (y + 1u < k.ny && LOAD_U(root, v + k.nx) < least && rock(v + k.nx))
        least = LOAD_U(root, v + k.nx);
    if (least < own) {
        atomicMin(AT(pointer, own), least);
        AT(counts, COUNT_CHANGED) = 1u;
    }
}
