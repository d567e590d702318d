// Body of erosion/carry.comp.glsl and carry_exposed.comp.glsl, which declare the buffers. With EXPOSED, a
// particle that is bared takes over the exposure age of those in front of it, with a negative sign until
// skin/reach has looked for a greater age, and their rate of weathering under crust and damp.
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "erosion/budget.glsl"
#include "erosion/parts.glsl"

// Sums over the faces towards particles that vanished: the rest of the step times area, and the processes' shares in it; the
// area, and that covered by plants; and the normals, weighted by the rest of the step.
struct incoming {
    vec3 step;
    float area, cover;
    uint sheets;
    vec3 normal;
#ifdef EXPOSED
    float aged, age, rate; // over faces of rock: area, exposure age, and the factor of crust and damp in the rate
#endif
};

void through(ivec3 v, int axis, inout incoming sum)
{
    if (!voxel_inside(v))
        return;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++) {
        float left = LOAD_F(unspent, j);
        if (left <= 0.0)
            continue;
        vec3 n = AT(normal, j).xyz;
        float face = abs(n[axis]);
        sum.step += left * face * vec3(1.0, shares_in(AT(shares, j)));
        sum.area += face;
        sum.sheets |= AT(shares, j) & PARTS_SHEETS;
        sum.cover += face * AT(vegetation, j);
        sum.normal += left * face * n;
#ifdef EXPOSED
        if (LOAD_U(phase, j) != PHASE_DEPOSIT) {
            sum.aged += face;
            sum.age += face * abs(AT(exposed, j));
            sum.rate += face * AT(crust, j);
        }
#endif
    }
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    float before = AT(viability, i);
    AT(spent, i) = 0u;
    if (before <= 0.0 || (k.round >= NEAR_REACH && LOAD_U(phase, i) != PHASE_DEPOSIT))
        return;
    ivec3 v = voxel_of(LOAD_V(position, i).xyz);
    incoming sum = incoming(vec3(0.0), 0.0, 0.0, 0u, vec3(0.0)
#ifdef EXPOSED
                            , 0.0, 0.0, 0.0
#endif
    );
    for (int axis = 0; axis < 3; axis++) {
        ivec3 side = ivec3(axis == 0, axis == 1, axis == 2);
        through(v + side, axis, sum);
        through(v - side, axis, sum);
    }
    if (sum.area <= 0.0)
        return;
    bool inside = AT(normal, i).xyz == vec3(0.0);
    if (inside)
        AT(vegetation, i) = max(AT(vegetation, i), sum.cover / sum.area);
    float rate = LOAD_F(erodibility, i);
#ifdef EXPOSED
    if (inside && sum.aged > 0.0 && LOAD_U(phase, i) != PHASE_DEPOSIT) {
        AT(exposed, i) = -max(abs(AT(exposed, i)), sum.age / sum.aged);
        AT(crust, i) = sum.rate / sum.aged;
        rate *= AT(crust, i);
    }
#endif
    float taken = rate * sum.step.x;
    if (taken <= 0.0)
        return;
    vec2 share = sum.step.yz / sum.step.x;
    AT(parts, i) = parts_of(share.x, share.y) | sum.sheets;
    if (LOAD_U(phase, i) == PHASE_DEPOSIT) {
        taken *= share.y;
        AT(parts, i) = PARTS_LOOSE;
    }
    float after = before - taken;
    if (after <= 0.0 && taken > 0.0) {
        float left = sum.step.x / sum.area * (-after / taken);
        AT(next, i) = left;
        AT(shares, i) = AT(parts, i);
        if (inside) {
            float size = length(sum.normal);
            AT(normal, i) = vec4(size > 0.0 ? sum.normal / size : vec3(0.0, 0.0, 1.0), 0.0);
        }
        atomicAdd(AT(counts, COUNT_ERODED), 1u);
        after = -rate * left;
    }
    AT(viability, i) = after;
    AT(spent, i) = quanta(before) - quanta(after);
}
