#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle: writes position, velocity, viability, phase, T and von Mises stress back to the rock. Particles
// faster than k.fastest get the phase of falling rock.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, origin)
READ_V(1, place)
READ_V(2, velocity)
READ_V(3, stretch_x)
READ_V(4, stretch_y)
READ_F(5, share)
READ_F(6, apart)
READ_U(7, joint)
WRITE_V(8, position)
WRITE_V(9, velocity_out)
WRITE_F(10, viability)
WRITE_U(11, phase)
WRITE_F(12, stress)
WRITE_F(13, von_mises)
PARAMS(mpm_params)
#include "mpm/grid.glsl"
#include "mpm/rock.glsl"
#include "mpm/broken.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint j = LOAD_U(origin, i);
    vec4 xh = LOAD_V(place, i), hx = LOAD_V(stretch_x, i), hy = LOAD_V(stretch_y, i);
    vec3 v = LOAD_V(velocity, i).xyz;
    mat3 f = mat3(hx.xyz, hy.xyz, vec3(hx.w, hy.w, xh.w)) + mat3(1.0);
    mat3 r = rotation_of(f), s = body_stress(strain_of(r, f)) / determinant(f);
    float mean = (s[0][0] + s[1][1] + s[2][2]) / 3.0;
    mat3 d = s - mat3(mean);
    AT(position, j) = vec4(xh.xyz, 0.0);
    AT(velocity_out, j) = vec4(k.played * v, 0.0);
    AT(viability, j) = mpm_in_domain(xh.xyz) ? LOAD_F(share, i) : 0.0;
    AT(phase, j) = length(v) > k.fastest ? PHASE_FALLING : is_loose(LOAD_F(apart, i), LOAD_U(joint, i)) ? PHASE_DEPOSIT : PHASE_ROCK;
    AT(stress, j) = -3.0 * mean;
    AT(von_mises, j) = sqrt(1.5 * (dot(d[0], d[0]) + dot(d[1], d[1]) + dot(d[2], d[2])));
}
