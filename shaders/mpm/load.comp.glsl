#version 460
#extension GL_GOOGLE_include_directive : require
// Particles of the rock become material points at rest, unstrained; they are taken out of the rock until they
// are stored again. Deposits are broken rock from the start. Joints, the faces of Voronoi cells around hashed
// points, are where rock breaks first.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "shared/random.glsl"

READ_U(0, list)
READ_V(1, position)
READ_U(2, phase)
READ_U(3, ids)
WRITE_F(4, viability)
WRITE_V(5, place)
WRITE_F(6, share)
WRITE_F(7, apart)
WRITE_F(8, strength)
WRITE_U(9, id)
WRITE_U(10, origin)
PARAMS(mpm_load_params)

// Half a joint's width, in sizes of the pieces.
const float JOINT = 0.1;

// How far x is from the nearest face between the cells of two seeds, in units of the seeds' spacing.
float to_joint(vec3 x)
{
    vec3 near = vec3(0.0), second = vec3(0.0);
    float best = 1e30, next = 1e30;
    for (int c = 0; c < 27; c++) {
        ivec3 cell = ivec3(floor(x)) + ivec3(c % 3, (c / 3) % 3, c / 9) - 1;
        uvec3 u = uvec3(cell + 4096);
        vec3 seed = vec3(cell) + 0.15 + 0.7 * vec3(random_float(random_hash(u.x, u.y, u.z, 3u * k.seed)),
                                                  random_float(random_hash(u.x, u.y, u.z, 3u * k.seed + 1u)),
                                                  random_float(random_hash(u.x, u.y, u.z, 3u * k.seed + 2u)));
        float d = distance(x, seed);
        if (d < best) {
            next = best;
            second = near;
            best = d;
            near = seed;
        } else if (d < next) {
            next = d;
            second = seed;
        }
    }
    return dot(0.5 * (near + second) - x, normalize(second - near));
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint j = LOAD_U(list, i);
    vec3 x = LOAD_V(position, j).xyz;
    bool joint = k.block > 0.0 && to_joint(x / k.block) < JOINT;
    AT(place, i) = vec4(x, 0.0);
    AT(share, i) = AT(viability, j);
    AT(viability, j) = 0.0;
    AT(apart, i) = LOAD_U(phase, j) == PHASE_DEPOSIT ? 0.0 : MPM_WHOLE;
    AT(strength, i) = joint ? k.joint : k.strength;
    AT(id, i) = LOAD_U(ids, j);
    AT(origin, i) = j;
}
