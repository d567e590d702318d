#version 460
#extension GL_GOOGLE_include_directive : require
// Per bare surface deposit: a seedling with the chance that wind brings one. The particle samples the place
// that its seed would come from, in a uniform direction at an exponentially distributed distance, and that
// place's cover scales the chance. So seedlings per area and time depend neither on the particles nor on the
// frames.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_U(2, phase)
READ_U(3, start)
READ_F(4, before)
READ_U(5, id)
WRITE_F(6, vegetation)
READ_U(7, words)
PARAMS(plants_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "particles/empty.glsl"
#include "plants/stand.glsl"
#include "shared/random.glsl"

// Cover of the highest voxel of a column.
float cover_of(ivec2 column)
{
    ivec3 v = ivec3(column, int(k.nz) - 1);
    if (!voxel_inside(v))
        return 0.0;
    while (v.z >= 0 && voxel_empty(v))
        v.z--;
    float most = 0.0;
    if (v.z < 0)
        return most;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++)
        most = max(most, LOAD_F(before, j));
    return most;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    if (LOAD_U(phase, self) != 1u || LOAD_F(before, self) > 0.0)
        return;
    uint hash = random_hash(k.seed, LOAD_U(id, self), 0u, 1u);
    float chance = random_float(hash);
    vec3 x = LOAD_V(position, self).xyz;
    if (chance >= k.chance || !stands(x))
        return;
    float far = -k.seeds * log(1.0 - random_float(random_hash(hash, 0u, 0u, 0u)));
    float turn = 6.2831853 * random_float(random_hash(hash, 1u, 0u, 0u));
    if (chance < k.chance * cover_of(ivec2(floor((x.xy + far * vec2(cos(turn), sin(turn))) / k.h))))
        AT(vegetation, self) = SEEDLING;
}
