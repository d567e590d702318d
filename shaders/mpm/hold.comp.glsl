#version 460
#extension GL_GOOGLE_include_directive : require
// Per entry, rock at rest: grid velocity v = p / m - g dt, 0 on the ground's nodes and tangential at walls; and
// its kinetic energy.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, entry_node)
READ_U(1, slot)
READ_U(2, many)
READ_U(3, reach)
READ_V(4, partial)
WRITE_V(5, velocity)
WRITE_F(6, product)
PARAMS(mpm_params)
#include "mpm/grid.glsl"
#include "mpm/sum.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(entry_node, i);
    vec4 sum = entry_sum(i, node);
    vec3 v = vec3(0.0);
    if (sum.w > 0.0 && mpm_at(node).z > 1)
        v = sum.xyz / sum.w - vec3(0.0, 0.0, k.gravity * k.dt);
    ivec3 a = mpm_at(node);
    if (((k.walls & WALL_X_MIN) != 0u && a.x <= 1) || ((k.walls & WALL_X_MAX) != 0u && a.x > int(k.cx)))
        v.x = 0.0;
    if (((k.walls & WALL_Y_MIN) != 0u && a.y <= 1) || ((k.walls & WALL_Y_MAX) != 0u && a.y > int(k.cy)))
        v.y = 0.0;
    AT(velocity, i) = vec4(v, sum.w);
    AT(product, i) = 0.5 * sum.w * dot(v, v);
}
