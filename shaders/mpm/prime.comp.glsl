#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle, before a frame's first step: adds the impulse of its stress to the affine velocity, Q = C - dt
// 4 / (rho dx^2) tau. Between frames C is stored without it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, place)
READ_V(1, velocity)
READ_V(2, affine_x)
READ_V(3, affine_y)
READ_V(4, stretch_x)
READ_V(5, stretch_y)
WRITE_V(6, velocity_out)
WRITE_V(7, affine_x_out)
WRITE_V(8, affine_y_out)
PARAMS(mpm_params)
#include "mpm/rock.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec4 v = LOAD_V(velocity, i), cx = LOAD_V(affine_x, i), cy = LOAD_V(affine_y, i);
    vec4 hx = LOAD_V(stretch_x, i), hy = LOAD_V(stretch_y, i);
    mat3 c = mat3(cx.xyz, cy.xyz, vec3(cx.w, cy.w, v.w));
    mat3 f = mat3(hx.xyz, hy.xyz, vec3(hx.w, hy.w, LOAD_V(place, i).w)) + mat3(1.0);
    mat3 r = rotation_of(f), e = strain_of(r, f);
    mat3 q = c - k.dt * k.push * acting_stress(r * body_stress(e) * transpose(r), c);
    AT(velocity_out, i) = vec4(v.xyz, q[2].z);
    AT(affine_x_out, i) = vec4(q[0], q[2].x);
    AT(affine_y_out, i) = vec4(q[1], q[2].y);
}
