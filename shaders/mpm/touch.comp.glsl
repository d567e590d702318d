#version 460
#extension GL_GOOGLE_include_directive : require
// Per mixed node: contact between bodies (Bardenhagen et al. 2000). Pieces joined by joints that hold move as
// one. Of the others, those that approach stop, those that slide rub, those that separate are free. The normal
// is the gradient of the difference of their masses. The changes are made to sum to zero momentum, also where
// more than two bodies meet.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, nodes)
READ_U(2, first)
READ_U(3, meeting)
READ_U(4, entry_body)
READ_U(5, group)
READ_F(6, mass)
READ_V(7, wall)
WRITE_V(8, velocity)
PARAMS(mpm_params)
#include "mpm/grid.glsl"
#include "mpm/contact.glsl"

// Bodies are in contact where together they fill more than TOUCHING of a node's volume and each of two at least MEETING of it: flat
// faces stop a third of a cell apart, and edges do not stop short of faces.
const float TOUCHING = 0.75, MEETING = 0.04;

// As in mpm/node, for bodies in contact.
const float STILL = 0.3, STILLING = 80.0;

// At a node: mass of group g minus that of other groups, for the bodies of the entries e0 to end. Sets `near` if both fill the
// node enough to be in contact.
float balance(ivec3 at, uint e0, uint end, uint g, inout bool near)
{
    if (any(lessThan(at, ivec3(0))) || any(greaterThan(at, ivec3(k.cx, k.cy, k.cz) + 2)))
        return 0.0;
    uint node = mpm_index(at), there = LOAD_U(first, node), last = there + LOAD_U(meeting, node);
    float own = 0.0, others = 0.0;
    for (; there < last; there++)
        for (uint e = e0; e < end; e++)
            if (LOAD_U(entry_body, e) == LOAD_U(entry_body, there)) {
                float m = LOAD_F(mass, there);
                if (LOAD_U(group, e) == g)
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
    uint node = LOAD_U(nodes, LOAD_U(list, i)), e0 = LOAD_U(first, node), end = e0 + LOAD_U(meeting, node);
    ivec3 at = mpm_at(node);
    float whole = 1e-30;
    vec3 all_of = vec3(0.0);
    // A group's first entry holds its velocity, and its mass in w.
    for (uint g = e0; g < end; g++) {
        float m = 0.0;
        vec3 sum = vec3(0.0);
        for (uint e = g; e < end; e++)
            if (LOAD_U(group, e) == g) {
                m += LOAD_F(mass, e);
                sum += LOAD_F(mass, e) * AT(velocity, e).xyz;
            }
        if (LOAD_U(group, g) == g)
            AT(velocity, g) = vec4(m > 0.0 ? sum / m : vec3(0.0), m);
        whole += m;
        all_of += sum;
    }
    vec3 middle = all_of / whole, lost = vec3(0.0);
    bool touching = false;
    for (uint g = e0; g < end; g++) {
        vec4 own = AT(velocity, g);
        if (LOAD_U(group, g) != g || own.w <= 0.0 || own.w >= 0.9999 * whole)
            continue;
        bool near = false;
        vec3 out_of = vec3(0.0);
        for (int a = 0; a < 3; a++) {
            ivec3 next = ivec3(a == 0, a == 1, a == 2);
            out_of[a] = balance(at - next, e0, end, g, near) - balance(at + next, e0, end, g, near);
        }
        balance(at, e0, end, g, near);
        if (!near)
            continue;
        touching = true;
        float size = length(out_of);
        vec3 normal = size > 0.0 ? out_of / size : vec3(0.0), rest = own.xyz - middle;
        float into = dot(rest, normal);
        if (into <= 0.0)
            continue;
        vec3 along = rest - into * normal, change = -into * normal;
        float speed = length(along);
        if (speed > 0.0)
            change -= along * min(1.0, k.friction * into / speed);
        AT(velocity, g) = vec4(own.xyz + change, own.w);
        lost += own.w * change;
    }
    vec4 n_wall = LOAD_V(wall, node);
    for (uint g = e0; g < end; g++)
        if (LOAD_U(group, g) == g) {
            vec3 v = AT(velocity, g).xyz - lost / whole;
            if (touching && length(v) < STILL)
                v *= max(1.0 - STILLING * k.dt, 0.0);
            AT(velocity, g) = vec4(off_walls(v, n_wall, node), 0.0);
        }
    for (uint e = e0; e < end; e++)
        AT(velocity, e) = AT(velocity, LOAD_U(group, e));
}
