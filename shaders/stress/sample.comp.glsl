#version 460
#extension GL_GOOGLE_include_directive : require
// Stress at the particles: trilinear between the centres of cells that hold rock, weighted by how much they
// hold.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
READ_F(1, fill)
READ_V(2, normal_stress)
READ_V(3, shear_stress)
WRITE_F(4, stress)
WRITE_F(5, von_mises)
PARAMS(stress_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec3 at = LOAD_V(position, i).xyz / k.dx + 0.5;
    ivec3 low = clamp(ivec3(floor(at)), ivec3(0), ivec3(k.cx, k.cy, k.cz) - 2);
    vec3 f = clamp(at - vec3(low), 0.0, 1.0);
    float weights = 0.0, t = 0.0, mises = 0.0;
    for (int b = 0; b < 8; b++) {
        ivec3 corner = ivec3(b & 1, (b >> 1) & 1, b >> 2);
        uint c = cell_index(low + corner);
        vec3 near = mix(1.0 - f, f, vec3(corner));
        float weight = near.x * near.y * near.z * LOAD_F(fill, c);
        weights += weight;
        t += weight * LOAD_V(normal_stress, c).w;
        mises += weight * LOAD_V(shear_stress, c).w;
    }
    AT(stress, i) = weights > 0.0 ? t / weights : 0.0;
    AT(von_mises, i) = weights > 0.0 ? mises / weights : 0.0;
}
