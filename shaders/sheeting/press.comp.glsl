#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle of rock: adds the intensity by which sheets come off where the face is in tension beyond
// its strength, patch by patch at times of their own. The tension is that of the current face, so that erosion
// stops where a sheet has relieved it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_U(2, phase)
READ_F(3, stress)
READ_F(4, erodibility)
WRITE_F(5, intensity) // by place in the list
WRITE_U(6, parts)     // likewise
PARAMS(sheeting_params)
#include "shared/random.glsl"
#include "erosion/parts.glsl"

uint cell_hash(ivec3 cell, uint what)
{
    return random_hash(k.seed, uint(cell.x), uint(cell.y), random_hash(uint(cell.z), what, 0u, 0u));
}

// When the patch of a place loses its sheets, as a share of the time from one to the next: patches are what is nearest to points spread at
// random, one in each cube.
float phase_of_patch(vec3 x)
{
    vec3 at = x / k.wide;
    ivec3 own = ivec3(floor(at)), nearest = own;
    float least = 1e9;
    for (int b = 0; b < 27; b++) {
        ivec3 cell = own + ivec3(b % 3, b / 3 % 3, b / 9) - 1;
        vec3 point = vec3(cell) + vec3(random_float(cell_hash(cell, 1u)), random_float(cell_hash(cell, 2u)),
                                       random_float(cell_hash(cell, 3u)));
        float far = distance(at, point);
        if (far < least) {
            least = far;
            nearest = cell;
        }
    }
    return random_float(cell_hash(nearest, 0u));
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    float rate = LOAD_F(erodibility, self), pulled = clamp(-LOAD_F(stress, self) / k.strength - 1.0, 0.0, 1.0);
    if (pulled <= 0.0 || rate <= 0.0 || LOAD_U(phase, self) != PHASE_ROCK)
        return;
    float own = phase_of_patch(LOAD_V(position, self).xyz), sheets = floor(k.to + own) - floor(k.from + own);
    if (sheets <= 0.0)
        return;
    float more = sheets * k.thick * pulled / (k.kyr * rate), sum = AT(intensity, i) + more;
    float water = shares_in(AT(parts, i)).y * AT(intensity, i) / sum;
    AT(intensity, i) = sum;
    AT(parts, i) = parts_of(more / sum, water) | PARTS_SHEETS;
}
