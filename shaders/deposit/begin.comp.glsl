#version 460
#extension GL_GOOGLE_include_directive : require
// Per fragment: its id and its start cell: its own, or if that is solid the first open one across a face, the
// upper first; if there is none it leaves the domain. A hashed share of the fragments of rock leaves as dust.
// Its voxel becomes free.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, particle)
READ_V(1, position)
READ_U(2, id)
READ_U(3, tag)
READ_U(4, start)
READ_U(5, crumb)
WRITE_U(6, crumb_id)
WRITE_U(7, cell)
WRITE_U(8, place)
WRITE_U(9, bits)
READ_U(10, words)
READ_U(11, phase)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "shared/random.glsl"
#include "deposit/grid.glsl"

bool open(ivec3 c)
{
    return cell_inside(c) && (LOAD_U(tag, cell_index(c)) & WATER_KIND) != WATER_SOLID;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    const ivec3 step[7] = ivec3[](ivec3(0), ivec3(0, 0, 1), ivec3(-1, 0, 0), ivec3(1, 0, 0), ivec3(0, -1, 0),
                                  ivec3(0, 1, 0), ivec3(0, 0, -1));
    uint j = LOAD_U(particle, i);
    ivec3 v = voxel_of(LOAD_V(position, j).xyz), c = cell_of(v), from = c;
    for (int s = 6; s >= 0; s--)
        if (open(c + step[s]))
            from = c + step[s];
    uint own = LOAD_U(id, j);
    bool dust = LOAD_U(phase, j) != PHASE_DEPOSIT && random_float(random_hash(k.dust, own, 0u, 0u)) >= k.bulk;
    AT(crumb_id, i) = own;
    AT(cell, i) = cell_index(from);
    AT(place, i) = open(from) && !dust ? DEPOSIT_WAITS : DEPOSIT_LEFT;

    uvec2 in_voxel = voxel_particles(v);
    bool empty = true;
    for (uint other = in_voxel.x; other < in_voxel.y; other++)
        empty = empty && LOAD_U(crumb, other) != 0u;
    if (empty)
        atomicAnd(AT(bits, (uint(v.z >> 5) * k.ny + uint(v.y)) * k.nx + uint(v.x)), ~(1u << (v.z & 31)));
}
