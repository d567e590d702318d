#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle in motion, grid to particles: x += dt v, H += dt (G + G H) for the velocity gradient G, F = I +
// H; rock breaks where the largest principal stress exceeds its strength (Rankine), broken rock yields by
// Drucker-Prager (rock.glsl). Stores Q = G - dt 4 / (rho dx^2) tau for the next step's transfer (Hu et al.
// 2018, eq. 29).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, part)
READ_V(1, velocity)
READ_V(2, place)
READ_V(3, stretch_x)
READ_V(4, stretch_y)
READ_F(5, apart)
READ_F(6, strength)
READ_U(7, full)
READ_U(8, reach)
WRITE_V(9, place_out)
WRITE_V(10, velocity_out)
WRITE_V(11, affine_x_out)
WRITE_V(12, affine_y_out)
WRITE_V(13, stretch_x_out)
WRITE_V(14, stretch_y_out)
WRITE_F(15, apart_out)
PARAMS(mpm_params)
#include "mpm/grid.glsl"
#include "mpm/voxels.glsl"
#include "mpm/collect.glsl"
#include "mpm/rock.glsl"

bool resting_rock(vec3 x)
{
    ivec3 v = ivec3(floor(x / (0.5 * k.dx)));
    return voxel_inside(v) && (LOAD_U(full, voxel_word(v)) & voxel_bit(v)) != 0u;
}

// v after a collision along axis a: 0 along it, reduced by friction across it.
vec3 stopped(vec3 v, int a)
{
    float into = abs(v[a]);
    v[a] = 0.0;
    float speed = length(v);
    return speed > 0.0 ? v * max(1.0 - k.friction * into / speed, 0.0) : v;
}

// Moves x by d as far as ground, walls and resting rock allow, axis by axis, and stops v accordingly.
vec3 go(vec3 x, vec3 d, inout vec3 v)
{
    vec3 to = x + d;
    if (k.rock != 0u && resting_rock(to) && !resting_rock(x)) {
        to = x;
        for (int a = 0; a < 3; a++) {
            vec3 next = to;
            next[a] += d[a];
            if (resting_rock(next))
                v = stopped(v, a);
            else
                to = next;
        }
    }
    for (int a = 0; a < 2; a++) { // walls, without friction
        float end = float(a == 0 ? k.cx : k.cy) * k.dx;
        if ((k.walls & (a == 0 ? WALL_X_MIN : WALL_Y_MIN)) != 0u && to[a] < 0.0) {
            to[a] = 0.0;
            v[a] = max(v[a], 0.0);
        }
        if ((k.walls & (a == 0 ? WALL_X_MAX : WALL_Y_MAX)) != 0u && to[a] >= end) {
            to[a] = end * (1.0 - 1e-6);
            v[a] = min(v[a], 0.0);
        }
    }
    if (to.z < 0.0) {
        to.z = 0.0;
        if (v.z < 0.0)
            v = stopped(v, 2);
    }
    return to;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint own = LOAD_U(part, i), home = LOAD_U(reach, 27u * k.n_parts + own);
    vec4 xh = LOAD_V(place, i), hx = LOAD_V(stretch_x, i), hy = LOAD_V(stretch_y, i);
    float loose = LOAD_F(apart, i);
    mat3 h = mat3(hx.xyz, hy.xyz, vec3(hx.w, hy.w, xh.w)), g;
    vec3 v;
    collect(mpm_offset(xh.xyz, home), own, v, g[0], g[1], g[2]);
    g /= k.dx;

    mat3 next = h + k.dt * (g + g * h), f = next + mat3(1.0);
    float volume = determinant(f);
    if (volume < 0.1 || volume > 8.0) { // outside the range of the elastic law
        loose = max(loose, 0.0);
        f = h + mat3(1.0);
    }
    mat3 r = rotation_of(f), e = strain_of(r, f);
    if (loose < 0.0 && most_tension(body_stress(e)) > LOAD_F(strength, i))
        loose = 0.0;
    if (loose >= 0.0) {
        e = slide(e, loose);
        next = r * e + (r - mat3(1.0));
    }
    mat3 stress = acting_stress(r * body_stress(e) * transpose(r), g);
    mat3 q = g - k.dt * k.push * stress;
    vec3 to = go(xh.xyz, k.dt * v, v);
    AT(place_out, i) = vec4(to, next[2].z);
    AT(velocity_out, i) = vec4(v, q[2].z);
    AT(affine_x_out, i) = vec4(q[0], q[2].x);
    AT(affine_y_out, i) = vec4(q[1], q[2].y);
    AT(stretch_x_out, i) = vec4(next[0], next[2].x);
    AT(stretch_y_out, i) = vec4(next[1], next[2].y);
    AT(apart_out, i) = loose;
}
