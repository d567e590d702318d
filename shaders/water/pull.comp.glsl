#version 460
#extension GL_GOOGLE_include_directive : require
// What runs over each span's floor, and how it pulls on it (Arenite eq. 14): k_f q^0.6 S^0.7, where q is the discharge of a metre's
// width, the sum of what the streams around spread as far as here, and S the slope of the water along it, by a line
// through the levels of the floors within the window. On a divide, from where rain runs both ways, it is the slope of the falls
// around. Springs may be narrower than cells: then they pull on a share of it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, occupied)
READ_U(1, floors)
READ_U(2, first)
READ_U(3, cell)
READ_U(4, altitude)
READ_U(5, level)
READ_U(6, heading)
READ_V(7, stream)
READ_F(8, width)
WRITE_V(9, pull) // Pa in the stream, and beside it; its share; m3/yr, within the water's width
PARAMS(water_stream_params)
#include "water/cell_of.glsl"
#include "water/columns.glsl"
#include "water/around.glsl"

float shear(float q, float slope)
{
    return q > 0.0 && slope > 0.0 ? k.pull * pow(q, 0.6) * pow(slope, 0.7) : 0.0;
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = ivec3(cell_of(LOAD_U(cell, i)));
    uint stands = LOAD_U(level, i);
    int reach = int(k.reach);
    float window = k.window / k.h, sheet = 0.0, springs = 0.0, narrow = 0.0, all = 0.0, wide = 0.0;
    vec2 rain = vec2(0.0), spring = vec2(0.0);
    // sums of the line's: weights, places, heights, and their products
    float w = 0.0, z = 0.0;
    vec2 r1 = vec2(0.0), rz = vec2(0.0);
    vec3 rr = vec3(0.0);
    vec2 falls = vec2(0.0); // squares of falls, and of how far they are
    for (int y = c.y - reach; y <= c.y + reach; y++)
        for (int x = c.x - reach; x <= c.x + reach; x++) {
            vec2 to = vec2(ivec2(x, y) - c.xy), flip;
            float r = length(to);
            uint column = column_seen(ivec2(x, y), flip);
            if (column == NONE)
                continue;
            uint m = r == 0.0 ? i : node_near(column, c.z, r);
            if (m == NONE)
                continue;
            uint there = LOAD_U(level, m);
            float near = 1.0 - r * r / (window * window);
            if (near > 0.0) {
                float up = clamp(float(int(there) - int(stands)) / 65536.0, -k.steepest * r, k.steepest * r);
                if (up < 0.0)
                    falls += near * vec2(up * up, 0.5 * r * r);
                w += near;
                z += near * up;
                r1 += near * to;
                rz += near * up * to;
                rr += near * vec3(to.x * to.x, to.x * to.y, to.y * to.y);
            }
            vec4 s = LOAD_V(stream, m);
            float weight = s.y > 0.0 && r < s.x ? s.y * spread(there, stands, r, s.x) / k.h : 0.0;
            if (weight > 0.0) {
                float own = LOAD_F(width, m), shown = max(own, k.narrowest);
                vec2 runs = unpackSnorm2x16(LOAD_U(heading, 2u * m));
                rain += weight * s.z * flip * runs;
                sheet += weight * s.z * length(runs);
                spring += weight * s.w * flip * unpackSnorm2x16(LOAD_U(heading, 2u * m + 1u));
                springs += weight * s.w;
                narrow += weight * s.w * min(own / shown, 1.0);
                all += weight * (s.z + s.w);
                wide += weight * (s.z + s.w) * shown;
            }
        }
    vec4 result = vec4(0.0, 0.0, 1.0, 0.0);
    vec2 q = rain + spring;
    float flows = length(q);
    if (flows > 0.0) {
        vec2 way = q / flows;
        vec3 a = rr - vec3(r1.x * r1.x, r1.x * r1.y, r1.y * r1.y) / w;
        float across = way.x * way.x * a.x + 2.0 * way.x * way.y * a.y + way.y * way.y * a.z;
        float slope = across > 1e-3 * w ? clamp(-dot(way, rz - r1 * z / w) / across, 0.0, k.steepest) : 0.0;
        float together = sheet > 0.0 ? min(length(rain) / sheet, 1.0) : 1.0, around = falls.y > 0.0 ? sqrt(falls.x / falls.y) : 0.0;
        if (springs == 0.0)
            slope = mix(min(around, k.steepest), slope, together);
        float depth = float(int(stands) - int(LOAD_U(altitude, i))) / 65536.0 * k.h, share = springs > 0.0 ? narrow / springs : 1.0;
        float moving = max(1.0 - depth / k.deep, 0.0), run = length(spring);
        result = vec4(moving * shear(run / share + sheet, slope), moving * shear(sheet, slope), share,
                      (run + sheet) * wide / all);
    }
    AT(pull, i) = result;
}
