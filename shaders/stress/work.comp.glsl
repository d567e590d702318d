#version 460
#extension GL_GOOGLE_include_directive : require
// The work of the weight along u, node by node: twice the elastic energy once u is at rest.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_V(1, u)
READ_F(2, fill)
WRITE_F(3, product)
PARAMS(stress_params)
#include "stress/grid.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    ivec3 a = node_of(node);
    float fills = 0.0;
    for (int e = 0; e < 8; e++)
        fills += LOAD_F(fill, cell_index(a - ivec3(e & 1, (e >> 1) & 1, e >> 2)));
    AT(product, i) = -fills * k.weight / 8.0 * LOAD_V(u, node).z;
}
