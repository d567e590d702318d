#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell with fill: stress at its centre from u, sigma = lambda tr(eps) I + 2 mu eps, in Pa, tension
// positive: (xx, yy, zz, T = -trace) and (xy, yz, xz, von Mises). It is scaled by the rock's stiffness, or by
// the deposits' where the cell is as soft as deposits are.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, run)
READ_U(1, table)
READ_V(2, u)
READ_F(3, fill)
WRITE_V(4, normal_stress)
WRITE_V(5, shear_stress)
READ_F(6, stiff)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/stiff.glsl"
#include "stress/rows.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec4 normal = vec4(0.0), shear = vec4(0.0);
    float filled = LOAD_F(fill, i);
    if (filled != 0.0) {
        uint own = LOAD_U(run, i / STRESS_RUN), row = i;
        vec3 dx = vec3(0.0), dy = vec3(0.0), dz = vec3(0.0);
        for (int b = 0; b < 8; b++) {
            ivec3 corner = ivec3(b & 1, (b >> 1) & 1, b >> 2);
            if (corner.x == 0)
                row = row_at(own, i, corner.y, corner.z);
            vec3 at = LOAD_V(u, row + uint(corner.x)).xyz;
            dx += corner.x == 1 ? at : -at;
            dy += corner.y == 1 ? at : -at;
            dz += corner.z == 1 ? at : -at;
        }
        float scale = 0.25 / k.dx;
        dx *= scale;
        dy *= scale;
        dz *= scale;
        float trace = dx.x + dy.y + dz.z, soft = filled < 0.0 && -filled <= 1.01 * k.loose ? k.loose : stiff_rock(node_of(own, i, uvec3(k.cx, k.cy, k.cz)));
        vec3 s = k.lambda * trace + 2.0 * k.mu * vec3(dx.x, dy.y, dz.z);
        vec3 t = k.mu * vec3(dx.y + dy.x, dy.z + dz.y, dx.z + dz.x);
        s *= soft;
        t *= soft;
        vec3 d = s - s.yzx;
        normal = vec4(s, -(s.x + s.y + s.z));
        shear = vec4(t, sqrt(0.5 * dot(d, d) + 3.0 * dot(t, t)));
    }
    AT(normal_stress, i) = normal;
    AT(shear_stress, i) = shear;
}
