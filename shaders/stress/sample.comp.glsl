#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: T and von Mises stress at its position, trilinear between the centres of the cells around it,
// weighted by their fill, each extrapolated to the particle along its slope (slope.comp.glsl). Between centres
// the slope terms nearly cancel; at a face, up to a cell beyond the last centre, they give the face's stress
// instead of the interior's.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, table)
READ_V(1, position)
READ_F(2, fill)
READ_V(3, normal_stress)
READ_V(4, shear_stress)
READ_V(5, t_slope)
READ_V(6, mises_slope)
WRITE_F(7, stress)
WRITE_F(8, von_mises)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/rows.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec3 at = LOAD_V(position, i).xyz / k.dx + 0.5;
    ivec3 low = clamp(ivec3(floor(at)), ivec3(0), ivec3(k.cx, k.cy, k.cz) - 2);
    vec3 f = clamp(at - vec3(low), 0.0, 1.0);
    float weights = 0.0, t = 0.0, mises = 0.0;
    uint row = 0u;
    for (int b = 0; b < 8; b++) {
        ivec3 corner = ivec3(b & 1, (b >> 1) & 1, b >> 2), seen = low + corner;
        vec3 flip = vec3(1.0);
        if (k.walls != 0u) { // beyond a wall lies the mirror image
            seen = side_cell(seen);
            flip = mix(vec3(-1.0), flip, equal(seen, low + corner));
        }
        if (corner.x == 0 || k.walls != 0u)
            row = LOAD_U(table, run_of(seen, CELLS)) + uint(seen.x) % STRESS_RUN - uint(corner.x);
        uint c = row + uint(corner.x);
        vec3 near = mix(1.0 - f, f, vec3(corner));
        float weight = near.x * near.y * near.z * abs(LOAD_F(fill, c));
        if (weight == 0.0)
            continue;
        vec3 beyond = flip * (at - vec3(low + corner));
        weights += weight;
        t += weight * (LOAD_V(normal_stress, c).w + dot(LOAD_V(t_slope, c).xyz, beyond));
        mises += weight * (LOAD_V(shear_stress, c).w + dot(LOAD_V(mises_slope, c).xyz, beyond));
    }
    AT(stress, i) = weights > 0.0 ? t / weights : 0.0;
    AT(von_mises, i) = weights > 0.0 ? max(mises / weights, 0.0) : 0.0;
}
