#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: exposure age. A particle that has an age keeps it. A new one has the larger of what it
// took over from those eroded in front of it (stored negative) and of A exp(-z / depth) over faces of age A
// near by, z being the distance through rock. Deposits take over nothing.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_U(3, phase)
READ_F(4, viability)
READ_F(5, exposed)
READ_U(6, start)
READ_U(7, words)
WRITE_F(8, found) // by place in the list
PARAMS(skin_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"

const float JUST_NOW = 1e-9; // kyr: least age of a particle that is no longer new

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    float age = LOAD_F(exposed, self);
    bool loose = LOAD_U(phase, self) == PHASE_DEPOSIT;
    if (age > 0.0 || loose) {
        AT(found, i) = max(age, JUST_NOW);
        return;
    }
    vec3 x = LOAD_V(position, self).xyz;
    ivec3 v = voxel_of(x), reach = ivec3(k.reach);
    ivec3 low = max(v - reach, ivec3(0)), high = min(v + reach, ivec3(k.nx, k.ny, k.nz) - 1);
    age = max(-age, JUST_NOW);
    for (int z = low.z; z <= high.z; z++)
        for (int y = low.y; y <= high.y; y++) {
            uvec2 row = row_particles(low.x, high.x, y, z);
            for (uint j = row.x; j < row.y; j++) {
                float other = LOAD_F(exposed, j);
                if (other <= age || LOAD_V(normal, j).xyz == vec3(0.0) || LOAD_U(phase, j) == PHASE_DEPOSIT)
                    continue;
                // the face's height follows the particle's viability
                float below = distance(x, LOAD_V(position, j).xyz) + (LOAD_F(viability, j) - 0.5) * k.h;
                age = max(age, other * exp(-max(below, 0.0) / k.depth));
            }
        }
    AT(found, i) = age;
}
