#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of 32 voxels of a column: bit set where a voxel holds a particle that is not a fragment.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_U(1, crumb)
WRITE_U(2, bits)
READ_U(3, words)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint x = i % k.nx, y = (i / k.nx) % k.ny, z = i / (k.nx * k.ny) * 32u, word = 0u;
    for (uint b = 0u; b < 32u && z + b < k.nz; b++) {
        ivec3 v = ivec3(x, y, z + b);
        uvec2 in_voxel = voxel_particles(v);
        word |= voxel_deep(v) ? 1u << b : 0u;
        for (uint j = in_voxel.x; j < in_voxel.y; j++)
            if (LOAD_U(crumb, j) == 0u)
                word |= 1u << b;
    }
    AT(bits, i) = word;
}
