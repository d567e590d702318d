#version 460
#extension GL_GOOGLE_include_directive : require
// Per cell of the box: its kind for the initial air. It is rock if there is rock within half a spacing of its
// centre along any axis.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
WRITE_U(1, kinds)
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
    AT(kinds, i) = uint(rock ? FLOW_ROCK : flow_kind(x));
}
