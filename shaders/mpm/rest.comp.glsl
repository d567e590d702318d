#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle at rest: T = -tr(sigma) and von Mises stress, Pa, and elastic energy, by linear elasticity from
// H.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, origin)
READ_V(1, place)
READ_V(2, stretch_x)
READ_V(3, stretch_y)
READ_F(4, share)
WRITE_F(5, stress_out)
WRITE_F(6, von_mises)
WRITE_F(7, energy)
PARAMS(mpm_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint j = LOAD_U(origin, i);
    vec4 hx = LOAD_V(stretch_x, i), hy = LOAD_V(stretch_y, i);
    mat3 h = mat3(hx.xyz, hy.xyz, vec3(hx.w, hy.w, LOAD_V(place, i).w)), e = 0.5 * (h + transpose(h));
    float trace = e[0][0] + e[1][1] + e[2][2];
    mat3 d = e - mat3(trace / 3.0);
    float shear = dot(d[0], d[0]) + dot(d[1], d[1]) + dot(d[2], d[2]);
    float square = dot(e[0], e[0]) + dot(e[1], e[1]) + dot(e[2], e[2]);
    AT(stress_out, j) = -(3.0 * k.lambda + 2.0 * k.mu) * trace;
    AT(von_mises, j) = 2.0 * k.mu * sqrt(1.5 * shear);
    // times the particle's volume
    AT(energy, i) = LOAD_F(share, i) * 0.125 * k.dx * k.dx * k.dx * (0.5 * k.lambda * trace * trace + k.mu * square);
}
