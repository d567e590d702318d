#version 460
#extension GL_GOOGLE_include_directive : require
// Per entry, rock in motion: grid velocity v = p / m - g dt, with contact with ground and resting rock.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, entry_node)
READ_U(1, slot)
READ_U(2, many)
READ_U(3, reach)
READ_V(4, partial)
READ_V(5, wall)
WRITE_V(6, velocity)
WRITE_F(7, mass)
PARAMS(mpm_params)
#include "mpm/grid.glsl"
#include "mpm/sum.glsl"
#include "mpm/contact.glsl"

// With pieces, velocities below STILL (m/s) decay at the rate STILLING (1/s), so that piles come to rest instead of creeping. The
// deceleration is at most STILL STILLING = 3 m/s2: a third of its weight overcomes it.
const float STILL = 0.06, STILLING = 50.0;

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(entry_node, i);
    vec4 sum = entry_sum(i, node);
    vec3 v = sum.w > 0.0 ? sum.xyz / sum.w - vec3(0.0, 0.0, k.gravity * k.dt) : vec3(0.0);
    float speed = length(v);
    if (speed > k.fastest)
        v *= k.fastest / speed;
    if (k.bodies != 0u && speed < STILL)
        v *= max(1.0 - STILLING * k.dt, 0.0);
    AT(velocity, i) = vec4(off_walls(v, LOAD_V(wall, node), node), sum.w);
    AT(mass, i) = sum.w;
}
