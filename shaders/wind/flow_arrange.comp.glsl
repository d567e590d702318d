#version 460
#extension GL_GOOGLE_include_directive : require
// Per slot: copies all fields of a particle to its place in the order of cells.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, start)
READ_U(1, order)
READ_V(2, position)
READ_V(3, velocity)
READ_F(4, density_pressure)
READ_F(5, divergence_pressure)
READ_U(6, id)
WRITE_V(7, to_position)
WRITE_V(8, to_velocity)
WRITE_F(9, to_density_pressure)
WRITE_F(10, to_divergence_pressure)
WRITE_U(11, to_id)
PARAMS(flow_params)
#include "wind/flow.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n || i >= LOAD_U(start, flow_dead()))
        return;
    uint from = LOAD_U(order, i);
    AT(to_position, i) = LOAD_V(position, from);
    AT(to_velocity, i) = LOAD_V(velocity, from);
    AT(to_density_pressure, i) = LOAD_F(density_pressure, from);
    AT(to_divergence_pressure, i) = LOAD_F(divergence_pressure, from);
    AT(to_id, i) = LOAD_U(id, from);
}
