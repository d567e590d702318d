#version 460
#extension GL_GOOGLE_include_directive : require
// Per listed word of bits: marks in `born` the deep voxels of blocks that are not on the ground, whose
// particles must be created, and counts them. `born` is 0 in all other words.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, first)
READ_U(2, root)
WRITE_U(3, born)
WRITE_U(4, counts)
READ_U(5, list)
PARAMS(runs_params)
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "blocks/runs.glsl"

void main()
{
    if (THREAD >= k.n)
        return;
    uint i = LOAD_U(list, THREAD);
    uint ground = voxel_rank(ivec3(0, 0, 1)), own = deep_word(i), loose = 0u;
    for (uint bits = own; bits != 0u; bits &= bits - 1u) {
        uint bit = bits & (~bits + 1u);
        if (LOAD_U(root, run_node(i, bit)) >= ground)
            loose |= bit;
    }
    AT(born, i) = loose;
    if (loose != 0u)
        atomicAdd(AT(counts, COUNT_BORN), uint(bitCount(loose)));
}
