#version 460
#extension GL_GOOGLE_include_directive : require
// The first air: a lattice over the box, where there is no rock within half a spacing on any axis.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, occupied)
WRITE_V(1, position)
WRITE_V(2, velocity)
WRITE_U(3, id)
PARAMS(flow_params)
#include "wind/flow.glsl"
#include "wind/rock.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    vec3 x = vec3(i % k.bx, i / k.bx % k.by, i / (k.bx * k.by)) + 0.5;
    bool rock = flow_in_rock(x);
    for (int a = 0; a < 3; a++)
        for (int s = -1; s <= 1; s += 2) {
            vec3 d = vec3(0.0);
            d[a] = 0.49 * float(s);
            rock = rock || flow_in_rock(x + d);
        }
    AT(position, i) = vec4(x, 1.0);
    AT(velocity, i) = vec4(k.wind_x, k.wind_y, 0.0, rock ? FLOW_GROUND : flow_kind(x)); /* not kept as air */
    AT(id, i) = i;
}
