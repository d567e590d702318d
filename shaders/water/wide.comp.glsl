#version 460
#extension GL_GOOGLE_include_directive : require
// Per span: width of its stream, W = width_m Q^width_power (at least least_width_m), offset of its centre line,
// and the normalisation 1 / sum of weights of the floors over which its discharge is spread.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, occupied)
READ_U(1, floors)
READ_U(2, first)
READ_U(3, cell)
READ_U(4, level)
READ_U(5, rain)
READ_U(6, spring)
WRITE_V(7, stream) // radius in cells; 1 / sum of weights; m3/yr of rain and of springs
WRITE_F(8, width)  // m
READ_U(9, receiver)
WRITE_U(10, middle) // cells: offset of the stream's centre line from the span, packSnorm2x16
PARAMS(water_stream_params)
#include "water/cell_of.glsl"
#include "water/columns.glsl"
#include "water/around.glsl"

// Radius over width: a line of discs of radius R with weights 1 - r^2 / R^2 has the total weight of a strip 3 pi R / 8 wide with
// the weight at its centre line.
const float RADIUS = 0.84882636; // 8 / 3 pi

// A spring's receivers zigzag on the grid about the line of its stream: offset, in cells, from a span to that line, fitted to the
// next eight receivers.
vec2 beside_line(uint i, ivec2 c)
{
    const int HALF = 4;
    vec2 sum[2] = vec2[2](vec2(0.0), vec2(0.0));
    for (int step = 0; step < 2 * HALF; step++) {
        if (i >= k.n)
            return vec2(0.0);
        sum[step / HALF] += vec2(ivec2(cell_of(LOAD_U(cell, i)).xy) - c) / float(HALF);
        i = LOAD_U(receiver, i);
    }
    vec2 ahead = sum[1] - sum[0], middle = 0.5 * (sum[0] + sum[1]);
    float far = dot(ahead, ahead);
    vec2 off = far > 0.0 ? middle - ahead * dot(ahead, middle) / far : vec2(0.0);
    return off / max(length(off), 1.0);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    float rains = float(LOAD_U(rain, i)) * k.rain_unit, springs = float(LOAD_U(spring, i)) * k.spring_unit;
    float q = rains + springs, own = max(k.least, q > 0.0 ? k.width * pow(q, k.power) : 0.0);
    float radius = RADIUS * clamp(own, k.narrowest, k.widest) / k.h, sum = 0.0;
    AT(width, i) = own;
    uint where = 0u;
    if (q > 0.0) {
        ivec3 c = ivec3(cell_of(LOAD_U(cell, i)));
        uint stands = LOAD_U(level, i);
        int reach = int(radius + 1.0);
        if (springs > 0.0)
            where = packSnorm2x16(beside_line(i, c.xy));
        vec2 line = unpackSnorm2x16(where);
        for (int y = c.y - reach; y <= c.y + reach; y++)
            for (int x = c.x - reach; x <= c.x + reach; x++) {
                vec2 to = vec2(ivec2(x, y) - c.xy);
                float r = length(to - line);
                vec2 flip;
                uint column = column_seen(ivec2(x, y), flip);
                if (r >= radius || column == NONE)
                    continue;
                uint m = to == vec2(0.0) ? i : node_near(column, c.z, length(to));
                if (m != NONE)
                    sum += spread(stands, LOAD_U(level, m), r, radius);
            }
    }
    AT(middle, i) = where;
    AT(stream, i) = vec4(radius, sum > 0.0 ? 1.0 / sum : 0.0, rains, springs);
}
