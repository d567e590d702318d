#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell of the box: the initial air, one particle at each centre outside rock, in potential flow v = wind -
// grad(potential).
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, kinds)
READ_F(1, potential)
WRITE_V(2, position)
WRITE_V(3, velocity)
WRITE_U(4, id)
PARAMS(flow_params)
#include "wind/potential.glsl"

float through(ivec3 c, int axis)
{
    ivec3 next = c;
    next[axis]++;
    vec2 face = potential_face(c, axis);
    if (face.y > 0.0)
        face.x -= LOAD_F(potential, potential_index(next)) - LOAD_F(potential, potential_index(c));
    return face.x;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = potential_cell(i);
    vec4 v = vec4(k.wind_x, k.wind_y, 0.0, float(LOAD_U(kinds, i)));
    if (v.w == FLOW_AIR)
        for (int a = 0; a < 3; a++) {
            ivec3 before = c;
            before[a]--;
            v[a] = 0.5 * (through(before, a) + through(c, a));
        }
    AT(position, i) = vec4(vec3(c) + 0.5, 1.0);
    AT(velocity, i) = v; /* cells of rock get a particle, too; flow_begin removes it */
    AT(id, i) = i;
}
