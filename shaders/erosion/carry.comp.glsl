#version 460
#extension GL_GOOGLE_include_directive : require
// What was left of the step when a particle was gone, its neighbours weather on through the faces it bared,
// so that the retreat does not depend on the step. Those that go, too, hand on what they leave in the next round, until all
// of the step is spent. Rock that lies deeper than rock is sure to have particles stays (erosion/beyond). What grows on a surface
// passes to what is bared below it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
WRITE_V(1, normal)
READ_U(2, start)
READ_F(3, erodibility)
READ_F(4, unspent) // of those that went in the round before
WRITE_F(5, viability)
WRITE_U(6, shares) // of the particles that are gone: by what
WRITE_U(7, spent)  // quanta
WRITE_U(8, parts)  // by what
READ_U(9, words)
WRITE_F(10, next) // what those leave that go in this round
WRITE_U(11, counts)
WRITE_F(12, vegetation)
READ_U(13, phase)
PARAMS(carry_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "erosion/budget.glsl"
#include "erosion/parts.glsl"

// What comes through faces: the step times their area, and the parts that processes have in it; their area, all of it and what
// plants cover; and the normals, by their step.
struct incoming {
    vec3 step;
    float area, cover;
    vec3 normal;
};

void through(ivec3 v, int axis, inout incoming sum)
{
    if (!voxel_inside(v))
        return;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++) {
        float left = LOAD_F(unspent, j);
        if (left <= 0.0)
            continue;
        vec3 n = AT(normal, j).xyz;
        float face = abs(n[axis]);
        sum.step += left * face * vec3(1.0, shares_in(AT(shares, j)));
        sum.area += face;
        sum.cover += face * AT(vegetation, j);
        sum.normal += left * face * n;
    }
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    float before = AT(viability, i);
    AT(spent, i) = 0u;
    if (before <= 0.0 || (k.round >= NEAR_REACH && LOAD_U(phase, i) != PHASE_DEPOSIT))
        return;
    ivec3 v = voxel_of(LOAD_V(position, i).xyz);
    incoming sum = incoming(vec3(0.0), 0.0, 0.0, vec3(0.0));
    for (int axis = 0; axis < 3; axis++) {
        ivec3 side = ivec3(axis == 0, axis == 1, axis == 2);
        through(v + side, axis, sum);
        through(v - side, axis, sum);
    }
    if (sum.area <= 0.0)
        return;
    bool inside = AT(normal, i).xyz == vec3(0.0);
    if (inside)
        AT(vegetation, i) = max(AT(vegetation, i), sum.cover / sum.area);
    float rate = LOAD_F(erodibility, i), taken = rate * sum.step.x;
    if (taken <= 0.0)
        return;
    vec2 share = sum.step.yz / sum.step.x;
    AT(parts, i) = parts_of(share.x, share.y);
    if (LOAD_U(phase, i) == PHASE_DEPOSIT) {
        taken *= share.y;
        AT(parts, i) = PARTS_LOOSE;
    }
    float after = before - taken;
    if (after <= 0.0 && taken > 0.0) {
        float left = sum.step.x / sum.area * (-after / taken);
        AT(next, i) = left;
        AT(shares, i) = AT(parts, i);
        if (inside) {
            float size = length(sum.normal);
            AT(normal, i) = vec4(size > 0.0 ? sum.normal / size : vec3(0.0, 0.0, 1.0), 0.0);
        }
        atomicAdd(AT(counts, COUNT_ERODED), 1u);
        after = -rate * left;
    }
    AT(viability, i) = after;
    AT(spent, i) = quanta(before) - quanta(after);
}
