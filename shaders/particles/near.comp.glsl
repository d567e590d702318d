#version 460
#extension GL_GOOGLE_include_directive : require
// Per word of bits, one axis: voxels within k.reach of an empty one; outside the domain all are empty. The x
// pass reads which voxels are occupied (particles/held.glsl), the y and z passes the result of the pass before.
// Words whose voxels are all near already, as in air, are skipped.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, before)
WRITE_U(1, near)
PARAMS(near_params)

// Bits of the empty voxels of word x of a row of `across` words.
uint empty_of(int x, int across, uint row)
{
    if (x < 0 || x >= across)
        return 0xffffffffu;
    uint left = k.nx - 32u * uint(x), beyond = left < 32u ? ~((1u << left) - 1u) : 0u;
    return ~LOAD_U(before, HELD_STRIDE * (row + uint(x)) + 2u) | beyond;
}

uint along_x(uint i, int across)
{
    int x = int(i) % across;
    uint row = i - uint(x), own = empty_of(x, across, row), sum = own;
    uint last = empty_of(x - 1, across, row), next = empty_of(x + 1, across, row);
    for (uint s = 1u; sum != 0xffffffffu && s <= k.reach; s++)
        sum |= own << s | own >> s | last >> (32u - s) | next << (32u - s);
    return sum;
}

// Search along y or z: among `most` words `step` apart, of which this is number `at`.
uint along(uint i, uint step, int at, int most)
{
    uint sum = LOAD_U(before, i);
    int reach = int(k.reach);
    if (at < reach || at + reach >= most)
        return 0xffffffffu;
    for (int s = -reach; sum != 0xffffffffu && s <= reach; s++)
        sum |= LOAD_U(before, uint(int(i) + s * int(step)));
    return sum;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint across = (k.nx + 31u) >> 5;
    AT(near, i) = k.axis == 0u   ? along_x(i, int(across))
                  : k.axis == 1u ? along(i, across, int(i / across % k.ny), int(k.ny))
                                 : along(i, across * k.ny, int(i / (across * k.ny)), int(k.nz));
}
