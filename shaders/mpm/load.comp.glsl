#version 460
#extension GL_GOOGLE_include_directive : require
// Per listed particle of rock: becomes a material point at rest and unstrained, and its viability in the rock
// is 0 until it is stored again. Deposits are broken from the start. Pieces are Voronoi cells of hashed points;
// joints are the faces between them and have a lower strength.
#include "shared/buffers.glsl"
#include "shared/params.h"
#include "shared/random.glsl"

READ_U(0, list)
READ_V(1, position)
READ_U(2, phase)
READ_U(3, ids)
WRITE_F(4, viability)
WRITE_V(5, place)
WRITE_F(6, share)
WRITE_F(7, apart)
WRITE_F(8, strength)
WRITE_U(9, id)
WRITE_U(10, origin)
WRITE_U(11, piece)
WRITE_U(12, joint)
PARAMS(mpm_load_params)

uint piece_at(ivec3 cell)
{
    return (uint(cell.z + 1) * k.ny + uint(cell.y + 1)) * k.nx + uint(cell.x + 1);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint j = LOAD_U(list, i), own = 0u, joint_of = MPM_NO_JOINT;
    vec3 p = LOAD_V(position, j).xyz;
    if (k.block > 0.0) {
        vec3 x = p / k.block, near = vec3(0.0), second = vec3(0.0);
        ivec3 near_cell = ivec3(0), second_cell = ivec3(0);
        float best = 1e30, next = 1e30;
        for (int c = 0; c < 27; c++) {
            ivec3 cell = ivec3(floor(x)) + ivec3(c % 3, (c / 3) % 3, c / 9) - 1;
            uvec3 u = uvec3(cell + 4096);
            vec3 seed = vec3(cell) + 0.15 + 0.7 * vec3(random_float(random_hash(u.x, u.y, u.z, 3u * k.seed)),
                                                      random_float(random_hash(u.x, u.y, u.z, 3u * k.seed + 1u)),
                                                      random_float(random_hash(u.x, u.y, u.z, 3u * k.seed + 2u)));
            float d = distance(x, seed);
            if (d < best) {
                next = best;
                second = near;
                second_cell = near_cell;
                best = d;
                near = seed;
                near_cell = cell;
            } else if (d < next) {
                next = d;
                second = seed;
                second_cell = cell;
            }
        }
        own = piece_at(near_cell);
        if (dot(0.5 * (near + second) - x, normalize(second - near)) < k.width) {
            ivec3 way = second_cell - near_cell;
            uint other = piece_at(second_cell);
            if (other < own)
                way = -way;
            joint_of = min(own, other) * MPM_JOINTS + uint((way.z * 5 + way.y) * 5 + way.x - 1);
        }
    }
    AT(place, i) = vec4(p, 0.0);
    AT(share, i) = AT(viability, j);
    AT(viability, j) = 0.0;
    bool loose = LOAD_U(phase, j) == PHASE_DEPOSIT;
    AT(apart, i) = loose ? 0.0 : MPM_WHOLE;
    // Rubble has no weak joints left.
    AT(strength, i) = joint_of != MPM_NO_JOINT && LOAD_U(phase, j) == PHASE_ROCK ? k.joint : k.strength;
    AT(id, i) = LOAD_U(ids, j);
    AT(origin, i) = j;
    AT(piece, i) = own + 1u;
    AT(joint, i) = loose ? MPM_NO_JOINT : joint_of;
}
