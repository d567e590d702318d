#version 460
#extension GL_GOOGLE_include_directive : require
// Per surface particle that is a floor: intensity += F = k_t (tau - tau_c)+ (Arenite eq. 14), the mean over the
// stream's share of the floor and the rest. The threshold of deposits is at least carry_Pa, above which they
// would not come to rest. Water lowers its floor by F times erodibility: the division by the bare area cancels
// the factor that erosion/weather applies.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, position)
READ_V(2, normal)
READ_U(3, occupied)
READ_U(4, floors)
READ_U(5, first)
READ_V(6, pull)
READ_F(7, erodibility)
READ_U(8, layer)
READ_V(9, layers)
WRITE_F(10, intensity)
WRITE_U(11, parts)    // the processes' shares
READ_F(12, drop)
WRITE_F(13, slopes) // 1/kyr, by place in the list: rate of change of the drop, relative to it; 0 before
READ_U(14, phase)
PARAMS(water_surface_params)
#include "particles/voxel.glsl"
#include "water/columns.glsl"
#include "water/floor.glsl"
#include "erosion/bare.glsl"
#include "erosion/layer.glsl"
#include "erosion/parts.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint self = LOAD_U(list, i);
    ivec3 v = voxel_of(LOAD_V(position, self).xyz);
    uint node = floor_at(v);
    float rate = LOAD_F(erodibility, self);
    if (node == NONE || rate <= 0.0)
        return;
    vec4 p = LOAD_V(pull, node), own = layer_weather(LOAD_U(layer, self));
    float threshold = own.w < 0.0 ? k.threshold : own.w;
    if (LOAD_U(phase, self) == PHASE_DEPOSIT)
        threshold = max(threshold, k.carry);
    float k_t = own.z < 0.0 ? k.rate : own.z;
    vec2 above = max(p.xy - threshold, vec2(0.0));
    float cut = k_t * mix(above.y, above.x, p.z);
    float area = max(bare_area(v, LOAD_V(normal, self).xyz), 0.1);
    if (cut <= 0.0)
        return;
    float moved = k_t * mix(above.y > 0.0 ? p.y : 0.0, above.x > 0.0 ? p.x : 0.0, p.z);
    AT(slopes, i) = 0.7 * moved * rate / max(LOAD_F(drop, node), k.h * WATER_LEVEL_DROP);
    cut /= area;
    float sum = AT(intensity, i) + cut;
    AT(intensity, i) = sum;
    AT(parts, i) = parts_of(shares_in(AT(parts, i)).x * (1.0 - cut / sum), cut / sum);
}
