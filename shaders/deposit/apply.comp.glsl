#version 460
#extension GL_GOOGLE_include_directive : require
// Per fragment: becomes a deposit in the voxel where it has landed, jittered as the initial particles are
// (scene/sample.c), or is removed, or keeps waiting. One whose viability was used up starts with viability 1
// and no plants; one that slid keeps both. Plants that it buries grow through it by a share that falls with its
// thickness.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, particle)
READ_U(1, crumb_id)
READ_U(2, place)
WRITE_V(3, position)
WRITE_F(4, viability)
WRITE_U(5, phase)
WRITE_F(6, rate_factor)
WRITE_F(7, vegetation)
WRITE_F(8, stress)
READ_U(9, start)
READ_U(10, words)
READ_U(11, crumb)
WRITE_U(12, counts)
PARAMS(deposit_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "shared/random.glsl"

const float JITTER = 0.25;
const float STILL_TO_COME = -1.0 / 4096.0; // upper bound of a waiting fragment's viability

float jitter(uint hash, uint axis)
{
    return 0.5 + JITTER * (2.0 * random_float(random_hash(hash, axis, 0u, 0u)) - 1.0);
}

// Share of the plant cover below that grows through to a voxel. Fragments landed in between are not indexed yet.
float cover_below(ivec3 v)
{
    float through = k.through;
    for (v.z--; v.z >= 0 && through > 1e-3; v.z--, through *= k.through) {
        uvec2 in_voxel = voxel_particles(v);
        for (uint j = in_voxel.x; j < in_voxel.y; j++)
            if (LOAD_U(crumb, j) == 0u)
                return through * AT(vegetation, j);
    }
    return 0.0;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint j = LOAD_U(particle, i), p = LOAD_U(place, i);
    if (p == DEPOSIT_HELD) {
        if (AT(viability, j) <= 0.0)
            AT(viability, j) = min(AT(viability, j), STILL_TO_COME);
        atomicAdd(AT(counts, COUNT_WAITING), 1u);
        return;
    }
    if (p == DEPOSIT_WAITS || p == DEPOSIT_LEFT) {
        AT(viability, j) = 0.0;
        atomicAdd(AT(counts, COUNT_GONE), 1u);
        return;
    }
    uint v = p - 1u, hash = random_hash(k.seed, LOAD_U(crumb_id, i), 0u, 2u);
    ivec3 corner = ivec3(v % k.nx, (v / k.nx) % k.ny, v / (k.nx * k.ny));
    AT(position, j) = vec4(k.h * (vec3(corner) + vec3(jitter(hash, 0u), jitter(hash, 1u), jitter(hash, 2u))), 0.0);
    bool is_new = AT(phase, j) != 1u;
    if (AT(viability, j) <= 0.0) {
        AT(viability, j) = 1.0;
        AT(vegetation, j) = 0.0;
    }
    AT(vegetation, j) = max(AT(vegetation, j), cover_below(corner));
    if (is_new) {
        AT(phase, j) = 1u;
        AT(rate_factor, j) *= k.quicker;
    }
    AT(stress, j) = 0.0;
    atomicAdd(AT(counts, COUNT_LANDED), 1u);
}
