#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: one step of the smoother, z = u + keep (u - u_previous) + gain (r - K u) / diagonal (Lottes
// 2022). z overwrites u_previous, which counts as 0 if `second` is set.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, run)
READ_U(2, table)
READ_V(3, u)
READ_F(4, fill)
READ_V(5, r)
READ_V(6, before)
WRITE_V(7, z)
PARAMS(smooth_params)
#include "stress/grid.glsl"
#include "stress/rows.glsl"
#include "stress/apply.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    vec4 residual = LOAD_V(r, i);
    vec3 now = LOAD_V(u, node).xyz;
    vec3 moved = now - (k.second != 0u ? vec3(0.0) : LOAD_V(before, node).xyz);
    vec3 left = residual.xyz - apply_stiffness(node).xyz;
    AT(z, node) = vec4(now + (k.keep != 0.0 ? k.keep * moved : vec3(0.0)) + k.gain * residual.w * left, 0.0);
}
