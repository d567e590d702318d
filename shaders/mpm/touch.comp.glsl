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

// Bodies touch where they fill this share of a node's room, and each that of it: flat faces stop a third of a cell
// apart, edges do not stop short of faces.
const float TOUCHING = 0.75, MEETING = 0.04;

// What touches and is slower than this, m/s, loses this share of its speed in a second: piles come to rest instead
// of creeping. A body that more than a tenth of its weight pulls on gets away.
const float STILL = 0.5, STILLING = 20.0;

// The mass of `body` at a node, less the others'. Where both have some and fill the node's room, they are near.
float balance(ivec3 at, uint body, inout bool near)
{
    if (any(lessThan(at, ivec3(0))) || any(greaterThan(at, ivec3(k.cx, k.cy, k.cz) + 2)))
        return 0.0;
    uint node = mpm_index(at), e = LOAD_U(first, node), end = e + LOAD_U(meeting, node);
    float own = 0.0, others = 0.0;
    for (; e < end; e++) {
        float m = LOAD_F(mass, e);
        if (LOAD_U(entry_body, e) == body)
            own += m;
        else
            others += m;
    }
    near = near || (own + others > TOUCHING * k.full && min(own, others) > MEETING * k.full);
    return own - others;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(nodes, LOAD_U(list, i)), e0 = LOAD_U(first, node), n = LOAD_U(meeting, node);
    ivec3 at = mpm_at(node);
    float whole = 1e-30;
    vec3 together = vec3(0.0);
    for (uint e = e0; e < e0 + n; e++) {
        whole += LOAD_F(mass, e);
        together += LOAD_F(mass, e) * AT(velocity, e).xyz;
    }
    vec3 middle = together / whole, lost = vec3(0.0);
    bool touching = false;
    for (uint e = e0; e < e0 + n; e++) {
        float m = LOAD_F(mass, e);
        uint body = LOAD_U(entry_body, e);
        bool near = false;
        vec3 out_of = vec3(0.0);
        for (int a = 0; a < 3; a++) {
            ivec3 next = ivec3(a == 0, a == 1, a == 2);
            out_of[a] = balance(at - next, body, near) - balance(at + next, body, near);
        }
        balance(at, body, near);
        float size = length(out_of);
        vec3 v = AT(velocity, e).xyz, rest = v - middle;
        vec3 normal = size > 0.0 ? out_of / size : vec3(0.0);
        float into = dot(rest, normal);
        if (!near || m <= 0.0)
            continue;
        touching = true;
        if (into <= 0.0)
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
    for (uint e = e0; e < e0 + n; e++) {
        vec3 v = AT(velocity, e).xyz - lost / whole;
        if (touching && length(v) < STILL)
            v *= max(1.0 - STILLING * k.dt, 0.0);
        AT(velocity, e) = vec4(off_walls(v, n_wall, node), LOAD_F(mass, e));
    }
}
