#version 460
#extension GL_GOOGLE_include_directive : require
// Per new particle: places it in the plane of the wind-borne lattice that has just entered the box. Counts
// particles that find no slot.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
WRITE_V(1, position)
WRITE_V(2, velocity)
WRITE_F(3, density_pressure)
WRITE_F(4, divergence_pressure)
WRITE_U(5, id)
WRITE_U(6, key)
WRITE_U(7, lost)
PARAMS(flow_params)
#include "wind/flow.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint across = k.enter_x < k.bx ? k.by * k.bz : 0u, column = i < across ? k.enter_x : (i - across) % k.bx;
    uint row = i < across ? i % k.by : k.enter_y, layer = i < across ? i / k.by : (i - across) / k.bx;
    if (i >= across && column == k.enter_x)
        return;
    uint slot = LOAD_U(start, flow_dead()) + i;
    if (slot >= k.slots) {
        atomicAdd(AT(lost, 0u), 1u);
        return;
    }
    vec3 x = vec3(float(column) + k.column_x, float(row) + k.column_y, float(layer) + 0.5);
    AT(position, slot) = vec4(x, 1.0);
    AT(velocity, slot) = vec4(k.wind_x, k.wind_y, 0.0, FLOW_SKIN);
    AT(density_pressure, slot) = 0.0;
    AT(divergence_pressure, slot) = 0.0;
    AT(id, slot) = k.first + i;
    AT(key, slot) = flow_index(flow_cell(x));
}
