#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle of rock: intensity += k (q - q_c)+ times the share of its voxel that is wet. The
// division by the bare area cancels the factor that erosion/weather applies, so that the front retreats by this
// rate.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_U(3, words)
READ_U(4, phase)
READ_V(5, wet)
WRITE_F(6, intensity) // by place in the list
WRITE_U(7, parts)     // the processes' shares
PARAMS(seep_params)
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/empty.glsl"
#include "erosion/bare.glsl"
#include "erosion/parts.glsl"
#include "groundwater/wet.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    if (LOAD_U(phase, self) != PHASE_ROCK)
        return;
    ivec3 v = voxel_of(LOAD_V(position, self).xyz);
    float cut = 0.0;
    for (uint bed = 0u; bed < k.beds; bed++) {
        vec4 w = wet_at(v, bed);
        cut += k.rate * wet_zone(v, w) * wet_front(v, bed) * max(w.z - k.threshold, 0.0);
        if (wet_top(v, w))
            cut += k.rate * max(w.w - k.threshold, 0.0);
    }
    if (cut <= 0.0)
        return;
    cut /= max(bare_area(v, LOAD_V(normal, self).xyz), 0.1);
    float before = AT(intensity, i), sum = before + cut;
    vec2 shares = shares_in(AT(parts, i)) * before;
    AT(intensity, i) = sum;
    AT(parts, i) = parts_of(shares.x / sum, (shares.y + cut) / sum);
}
