#version 460
#extension GL_GOOGLE_include_directive : require
// Crumbs become deposits where they have landed, jittered in their voxels as the first particles are
// (scene/sample.c), or go. A crumb of rock begins anew, whole and bare; one that slid keeps what is left of it.
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
WRITE_U(8, counts)
PARAMS(deposit_params)
#include "shared/random.glsl"

const float JITTER = 0.25;

float jitter(uint hash, uint axis)
{
    return 0.5 + JITTER * (2.0 * random_float(random_hash(hash, axis, 0u, 0u)) - 1.0);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint j = LOAD_U(particle, i), p = LOAD_U(place, i);
    if (p == DEPOSIT_WAITS || p == DEPOSIT_LEFT) {
        AT(viability, j) = 0.0;
        atomicAdd(AT(counts, COUNT_GONE), 1u);
        return;
    }
    uint v = p - 1u, hash = random_hash(k.seed, LOAD_U(crumb_id, i), 0u, 2u);
    vec3 corner = vec3(v % k.nx, (v / k.nx) % k.ny, v / (k.nx * k.ny));
    AT(position, j) = vec4(k.h * (corner + vec3(jitter(hash, 0u), jitter(hash, 1u), jitter(hash, 2u))), 0.0);
    if (AT(viability, j) <= 0.0) {
        AT(viability, j) = 1.0;
        AT(vegetation, j) = 0.0;
    }
    if (AT(phase, j) != 1u) {
        AT(phase, j) = 1u;
        AT(rate_factor, j) *= k.quicker;
    }
    atomicAdd(AT(counts, COUNT_LANDED), 1u);
}
