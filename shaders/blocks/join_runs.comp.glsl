#version 460
#extension GL_GOOGLE_include_directive : require
// Per listed word of bits: blocks/join for its runs of deep voxels, with the runs and solid held voxels across
// their faces, in both directions at once.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, first)
READ_U(2, solid)
READ_U(3, root)
WRITE_U(4, pointer)
WRITE_U(5, flags)
READ_U(6, list)
PARAMS(runs_params)
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "blocks/runs.glsl"

void join(uint a, uint b)
{
    uint root_a = LOAD_U(root, a), root_b = LOAD_U(root, b);
    if (root_a == root_b)
        return;
    atomicMin(AT(pointer, max(root_a, root_b)), min(root_a, root_b));
    AT(flags, k.flag) = 1u;
}

// Joins the run at `bit` of word i with the held voxel at bit `at` of word w.
void join_held(uint i, uint bit, uint w, uint at)
{
    uint held = LOAD_U(words, HELD_STRIDE * w);
    uint slot = LOAD_U(words, HELD_STRIDE * w + 1u) + uint(bitCount(held & (at - 1u)));
    if ((held & at) != 0u && LOAD_U(solid, slot) != 0u)
        join(run_node(i, bit), slot);
}

// Joins the runs of word i with runs and held voxels of word w, in a neighbouring row.
void join_row(uint i, uint own, uint w)
{
    uint both = own & deep_word(w);
    for (uint bits = run_starts(both, last_before(i) & last_before(w)); bits != 0u; bits &= bits - 1u) {
        uint bit = bits & (~bits + 1u);
        join(run_node(i, bit), run_node(w, bit));
    }
    for (uint bits = own & LOAD_U(words, HELD_STRIDE * w); bits != 0u; bits &= bits - 1u) {
        uint bit = bits & (~bits + 1u);
        join_held(i, bit, w, bit);
    }
}

void main()
{
    if (THREAD >= k.n)
        return;
    uint i = LOAD_U(list, THREAD), own = deep_word(i), across = (k.nx + 31u) >> 5, slab = across * k.ny;
    // Held voxels before and after each run in its row.
    for (uint bits = own & ~(own << 1); bits != 0u; bits &= bits - 1u) {
        uint bit = bits & (~bits + 1u);
        if (bit > 1u)
            join_held(i, bit, i, bit >> 1);
        else if (i % across > 0u)
            join_held(i, bit, i - 1u, 0x80000000u);
    }
    for (uint bits = own & ~(own >> 1); bits != 0u; bits &= bits - 1u) {
        uint bit = bits & (~bits + 1u);
        if (bit < 0x80000000u)
            join_held(i, bit, i, bit << 1);
        else if (i % across + 1u < across)
            join_held(i, bit, i + 1u, 1u);
    }
    if (i / across % k.ny > 0u)
        join_row(i, own, i - across);
    if (i / across % k.ny + 1u < k.ny)
        join_row(i, own, i + across);
    if (i >= slab)
        join_row(i, own, i - slab);
    if (i + slab < k.words)
        join_row(i, own, i + slab);
}
