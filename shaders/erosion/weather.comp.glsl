#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle: viability -= E W dt A / h, with erodibility E, intensity W and bare area A in h^2
// (Arenite eq. 1, in metres of retreat).
//
// A bare face of a voxel stands for |n_axis| h^2 of the surface with normal n. Over any plane these add up to
// its area, so a front loses its rate times its area whatever its direction and however rough the voxels make
// it. If the particle vanishes, the rest of the step goes to `unspent`, for its neighbours (carry.comp.glsl),
// and its viability becomes minus what that rest would have removed from it (used by beyond.comp.glsl). Only
// water erodes deposits: what wind can lift has not come to rest among them.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_F(3, intensity) // by place in the list
READ_F(4, erodibility)
READ_U(5, words)
WRITE_F(6, viability)
WRITE_F(7, unspent)
WRITE_U(8, counts)
WRITE_U(9, parts)   // by place in the list
WRITE_U(10, spent)  // by place in the list: quanta
WRITE_U(11, shares) // by particle, of those that vanish: their parts
READ_U(12, phase)
PARAMS(erosion_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/empty.glsl"
#include "erosion/bare.glsl"
#include "erosion/budget.glsl"
#include "erosion/parts.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    float rate = LOAD_F(erodibility, self);
    AT(spent, i) = 0u;
    if (rate <= 0.0)
        return;
    vec3 x = LOAD_V(position, self).xyz, n = LOAD_V(normal, self).xyz;
    float step = LOAD_F(intensity, i) * k.dt / k.h;
    float before = AT(viability, self), taken = rate * step * bare_area(voxel_of(x), n);
    if (LOAD_U(phase, self) == PHASE_DEPOSIT) {
        taken *= shares_in(AT(parts, i)).y;
        AT(parts, i) = PARTS_LOOSE;
    }
    float after = before - taken;
    if (after <= 0.0 && taken > 0.0) {
        float left = max(step * (-after / taken), 1e-30); // > 0 tells the neighbours that it vanished
        AT(unspent, self) = left;
        AT(shares, self) = AT(parts, i);
        atomicAdd(AT(counts, COUNT_ERODED), 1u);
        after = -rate * left;
    }
    AT(viability, self) = after;
    AT(spent, i) = quanta(before) - quanta(after);
}
