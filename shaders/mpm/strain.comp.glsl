#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle at rest, grid to particles: positions are fixed and strains small, so H += dt G and the stress
// is linear in H. F = I + H is never formed, since increments of H are below its last bit.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, part)
READ_V(1, velocity)
READ_V(2, place)
READ_V(3, stretch_x)
READ_V(4, stretch_y)
READ_F(5, scalars)
READ_U(6, reach)
WRITE_V(7, place_out)
WRITE_V(8, velocity_out)
WRITE_V(9, affine_x_out)
WRITE_V(10, affine_y_out)
WRITE_V(11, stretch_x_out)
WRITE_V(12, stretch_y_out)
PARAMS(mpm_params)
#include "mpm/grid.glsl"
#include "mpm/collect.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint own = LOAD_U(part, i), home = LOAD_U(reach, 27u * k.n_parts + own);
    vec4 xh = LOAD_V(place, i), hx = LOAD_V(stretch_x, i), hy = LOAD_V(stretch_y, i);
    mat3 h = mat3(hx.xyz, hy.xyz, vec3(hx.w, hy.w, xh.w)), g;
    vec3 v;
    collect(mpm_offset(xh.xyz, home), own, v, g[0], g[1], g[2]);
    float keep = LOAD_F(scalars, MPM_KEEP);
    g *= keep / k.dx;
    h += k.dt * g;
    mat3 stress = k.mu * (h + transpose(h)) + mat3(k.lambda * (h[0][0] + h[1][1] + h[2][2]));
    mat3 q = g - k.dt * k.push * stress;
    AT(place_out, i) = vec4(xh.xyz, h[2].z);
    AT(velocity_out, i) = vec4(keep * v, q[2].z);
    AT(affine_x_out, i) = vec4(q[0], q[2].x);
    AT(affine_y_out, i) = vec4(q[1], q[2].y);
    AT(stretch_x_out, i) = vec4(h[0], h[2].x);
    AT(stretch_y_out, i) = vec4(h[1], h[2].y);
}
