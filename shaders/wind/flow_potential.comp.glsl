#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell of one colour of a chessboard: half a sweep of successive over-relaxation (factor `gain`) for the
// potential of the initial air.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, source)
READ_U(1, faces)
WRITE_F(2, potential)
PARAMS(flow_params)

void main()
{
    uint i = THREAD, half_row = (k.bx + 1u) / 2u, y = i / half_row % k.by, z = i / (half_row * k.by);
    uint x = 2u * (i % half_row) + ((y + z + k.first) & 1u);
    if (i >= k.n || x >= k.bx)
        return;
    uint c = (z * k.by + y) * k.bx + x, bits = LOAD_U(faces, c);
    if (bits == 0u)
        return;
    float sum = -LOAD_F(source, c);
    sum += (bits & 1u) != 0u ? AT(potential, c - 1u) : 0.0;
    sum += (bits & 2u) != 0u ? AT(potential, c + 1u) : 0.0;
    sum += (bits & 4u) != 0u ? AT(potential, c - k.bx) : 0.0;
    sum += (bits & 8u) != 0u ? AT(potential, c + k.bx) : 0.0;
    sum += (bits & 16u) != 0u ? AT(potential, c - k.bx * k.by) : 0.0;
    sum += (bits & 32u) != 0u ? AT(potential, c + k.bx * k.by) : 0.0;
    float own = AT(potential, c);
    AT(potential, c) = own + k.gain * (sum / float(bitCount(bits)) - own);
}
