#version 460
#extension GL_GOOGLE_include_directive : require
// Bodies that meet at a node: those that approach each other stop, those that slide rub, those that part are
// free (Bardenhagen et al. 2000). The normal comes from where their mass lies. What they lose and win together
// is made to be nothing, also where more than two meet.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, nodes)
READ_U(2, first)
READ_U(3, meeting)
READ_U(4, entry_body)
READ_F(5, mass)
READ_V(6, wall)
WRITE_V(7, velocity)
PARAMS(mpm_params)
#include "mpm/grid.glsl"
#include "mpm/contact.glsl"

// The mass of `body` at a node next to this one, less the others'.
float balance(ivec3 at, uint body)
{
    if (any(lessThan(at, ivec3(0))) || any(greaterThan(at, ivec3(k.cx, k.cy, k.cz) + 2)))
        return 0.0;
    uint node = mpm_index(at), e = LOAD_U(first, node), end = e + LOAD_U(meeting, node);
    float sum = 0.0;
    for (; e < end; e++)
        sum += LOAD_U(entry_body, e) == body ? LOAD_F(mass, e) : -LOAD_F(mass, e);
    return sum;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(nodes, LOAD_U(list, i)), e0 = LOAD_U(first, node), n = LOAD_U(meeting, node);
    ivec3 at = mpm_at(node);
    float whole = 0.0;
    vec3 together = vec3(0.0);
    for (uint e = e0; e < e0 + n; e++) {
        whole += LOAD_F(mass, e);
        together += LOAD_F(mass, e) * AT(velocity, e).xyz;
    }
    if (whole < k.touching)
        return;
    vec3 middle = together / whole, lost = vec3(0.0);
    for (uint e = e0; e < e0 + n; e++) {
        float m = LOAD_F(mass, e);
        uint body = LOAD_U(entry_body, e);
        vec3 out_of = -vec3(balance(at + ivec3(1, 0, 0), body) - balance(at - ivec3(1, 0, 0), body),
                            balance(at + ivec3(0, 1, 0), body) - balance(at - ivec3(0, 1, 0), body),
                            balance(at + ivec3(0, 0, 1), body) - balance(at - ivec3(0, 0, 1), body));
        float size = length(out_of);
        vec3 v = AT(velocity, e).xyz, rest = v - middle;
        vec3 normal = size > 0.0 ? out_of / size : vec3(0.0);
        float into = dot(rest, normal);
        if (m <= 0.0 || into <= 0.0)
            continue;
        vec3 along = rest - into * normal;
        float speed = length(along);
        vec3 change = -into * normal;
        if (speed > 0.0)
            change -= along * min(1.0, k.friction * into / speed);
        AT(velocity, e) = vec4(v + change, m);
        lost += m * change;
    }
    vec4 n_wall = LOAD_V(wall, node);
    for (uint e = e0; e < e0 + n; e++)
        AT(velocity, e) = vec4(off_walls(AT(velocity, e).xyz - lost / whole, n_wall, node), AT(velocity, e).w);
}
