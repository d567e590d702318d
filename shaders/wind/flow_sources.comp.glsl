#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell of the box: net outflow of the uniform wind, and the faces through which the potential may correct
// it, as bits: two per axis, low side first.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, kinds)
WRITE_F(1, source)
WRITE_U(2, faces)
PARAMS(flow_params)
#include "wind/potential.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = potential_cell(i);
    float sum = 0.0;
    uint bits = 0u;
    if (LOAD_U(kinds, i) == uint(FLOW_AIR))
        for (int a = 0; a < 3; a++) {
            ivec3 before = c;
            before[a]--;
            vec2 low = potential_face(before, a), high = potential_face(c, a);
            sum += high.x - low.x;
            bits |= (uint(low.y) | uint(high.y) << 1) << (2 * a);
        }
    AT(source, i) = sum;
    AT(faces, i) = bits;
}
