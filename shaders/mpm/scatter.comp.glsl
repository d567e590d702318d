#version 460
#extension GL_GOOGLE_include_directive : require
// Per part, particles to grid, first half: mass and momentum that its particles give each of their 27 nodes, m
// w (v_p + Q_p (x_i - x_p)) with Q the affine velocity minus the impulse of the stress (Hu et al. 2018, eq.
// 29).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, part_cell)
READ_U(1, part_first)
READ_V(2, place)
READ_V(3, velocity)
READ_V(4, affine_x)
READ_V(5, affine_y)
READ_F(6, share)
WRITE_V(7, partial)
PARAMS(mpm_params)
#include "mpm/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint cell = LOAD_U(part_cell, i), end = LOAD_U(part_first, i + 1u);
    vec3 first = vec3(mpm_at(cell) - 1);
    vec4 sum[27];
    for (int a = 0; a < 27; a++)
        sum[a] = vec4(0.0);
    for (uint j = LOAD_U(part_first, i); j < end; j++) {
        vec4 vq = LOAD_V(velocity, j), qx = LOAD_V(affine_x, j), qy = LOAD_V(affine_y, j);
        float m = k.mass * LOAD_F(share, j);
        vec3 f = mpm_cells(LOAD_V(place, j).xyz) - first, w[3];
        mpm_weights(f, w[0], w[1], w[2]);
        vec3 q0 = qx.xyz * k.dx, q1 = qy.xyz * k.dx, q2 = vec3(qx.w, qy.w, vq.w) * k.dx;
        vec3 v = vq.xyz - (f.x * q0 + f.y * q1 + f.z * q2);
        for (int z = 0; z < 3; z++)
            for (int y = 0; y < 3; y++) {
                vec3 row = v + float(y) * q1 + float(z) * q2;
                float wzy = m * w[z].z * w[y].y;
                for (int x = 0; x < 3; x++)
                    sum[z * 9 + y * 3 + x] += wzy * w[x].x * vec4(row + float(x) * q0, 1.0);
            }
    }
    for (uint a = 0u; a < 27u; a++)
        AT(partial, a * k.n_parts + i) = sum[a];
}
