#version 460
#extension GL_GOOGLE_include_directive : require
// Per loose particle of a block with fewer than `least` particles: it becomes a fragment; its viability is set
// to 0.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, block)
READ_U(1, size)
WRITE_U(2, flags)
WRITE_F(3, viability)
WRITE_U(4, counts)
PARAMS(crumble_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n || AT(flags, i) == 0u)
        return;
    uint own = LOAD_U(block, i);
    if (own != 0xffffffffu && LOAD_U(size, own) >= k.least)
        return;
    AT(flags, i) = 0u;
    AT(viability, i) = 0.0;
    atomicAdd(AT(counts, COUNT_FALLEN), 1u);
}
