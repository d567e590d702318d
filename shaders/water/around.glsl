// Access to the floors around a span. Needs water/columns.glsl, READ_U(level), and k.
#define HELD_NX k.cx
#define HELD_NY k.cy
#include "particles/sides.glsl"

// The column to read at a place: beyond a wall the mirror image, whose directions are multiplied by `flip`. NONE beyond an open
// side.
uint column_seen(ivec2 at, out vec2 flip)
{
    ivec2 to = side_voxel(ivec3(at, 0)).xy;
    flip = vec2(to.x == at.x ? 1.0 : -1.0, to.y == at.y ? 1.0 : -1.0);
    bool inside = all(greaterThanEqual(to, ivec2(0))) && all(lessThan(to, ivec2(k.cx, k.cy)));
    return inside ? uint(to.y) * k.cx + uint(to.x) : NONE;
}

// The span of a column r cells away that faces level z: the one that contains z, or if z is in rock the first above it whose
// floor is no higher than a bank. NONE if there is none.
uint node_near(uint column, int z, float r)
{
    int high = min(z + int(ceil(k.deep / k.h + r)), int(k.cz) - 1);
    for (int word = z >> 5; word <= high >> 5; word++) {
        uint at = column * k.words + uint(word), own = LOAD_U(floors, at), open = ~LOAD_U(occupied, at) | own;
        if (word == z >> 5)
            open &= 0xffffffffu << (z & 31);
        if (word == high >> 5)
            open &= 0xffffffffu >> (31 - (high & 31));
        if (open != 0u)
            return LOAD_U(first, at) + uint(bitCount(own & 0xffffffffu >> (31 - findLSB(open)))) - 1u;
    }
    return NONE;
}

// Weight with which the discharge of a span of water level `from` is spread to one of level `to`, r cells away: 1 - (r / radius)^2,
// or 0 if the ground between them is steeper than a bank.
float spread(uint from, uint to, float r, float radius)
{
    float off = r / radius;
    bool beside = abs(float(int(to) - int(from))) <= 65536.0 * (k.deep / k.h + r);
    return beside ? max(1.0 - off * off, 0.0) : 0.0;
}
