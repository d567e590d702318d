#version 460
#extension GL_GOOGLE_include_directive : require
// Per span: discharge and shear stress on its floor, tau = k_f q^0.6 S^0.7 (Arenite eq. 14). q is the discharge
// per metre of width, summed over all streams that spread to this floor. S is the slope of the water along the
// flow, from the water level abreast to the levels of the floors below within the window. On a divide, from
// which rain runs in opposite directions, S is the root mean square of the falls around. A spring's stream may
// be narrower than the cells: then it acts on a share of the floor.
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
WRITE_V(9, pull) // Pa in the stream, Pa beside it, its share of the floor, m3/yr within its width
WRITE_F(10, drop) // m: drop to the floors downstream
READ_U(11, middle)
PARAMS(water_stream_params)
#include "water/cell_of.glsl"
#include "water/columns.glsl"
#include "water/around.glsl"

float shear(float q, float slope)
{
    return q > 0.0 && slope > 0.0 ? k.pull * pow(q, 0.6) * pow(slope, 0.7) : 0.0;
}

// Weight in slopes of a place r cells away: 1 - r^2 / window^2 averaged over a cell's width, so that coarse cells see as far.
float weight_in(float r)
{
    float window = k.window / k.h;
    vec3 to = vec3(r - 0.5, r, r + 0.5) / window;
    return dot(max(1.0 - to * to, vec3(0.0)), vec3(1.0, 4.0, 1.0) / 6.0);
}

// Height of the level `there` over `stands`, r cells away, in cells, limited by the steepest slope.
float rise(uint there, uint stands, float r)
{
    return clamp(float(int(there) - int(stands)) / 65536.0, -k.steepest * r, k.steepest * r);
}

// x: slope along the direction `way`, from the water level abreast to that downstream; y: the distance between, in cells. Places
// weigh by their discharge, since banks fall to all sides. Nothing upstream is used: knickpoints migrate upstream, and a floor
// that depended on its upstream neighbours would oscillate. Beyond an open side the upstream slope is continued; bare ground,
// where discharge ends, weighs as much as the floor itself.
vec2 downstream(uint i, ivec3 c, uint stands, vec2 way)
{
    vec3 abreast = vec3(0.0), below = vec3(0.0); // weight, and weighted distance and height
    vec2 flip;
    vec2 here = LOAD_V(stream, i).zw;
    int reach = int(k.window / k.h + 0.5);
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            float along = dot(vec2(x, y), way), r = length(vec2(x, y)), near = weight_in(r);
            float level_with = max(1.0 - abs(along), 0.0);
            bool ends = along < 0.0 && column_seen(c.xy - ivec2(x, y), flip) == NONE;
            uint column = column_seen(c.xy + ivec2(x, y), flip);
            if (near <= 0.0 || column == NONE || (along <= 0.0 && level_with == 0.0 && !ends))
                continue;
            uint m = r == 0.0 ? i : node_near(column, c.z, r);
            if (m == NONE)
                continue;
            vec2 s = LOAD_V(stream, m).zw;
            bool ground = LOAD_U(cell, m) < k.cx * k.cy && !is_occupied(column, 0u);
            vec3 at = near * (ground ? max(s.x + s.y, here.x + here.y) : s.x + s.y) * vec3(1.0, along, rise(LOAD_U(level, m), stands, r));
            abreast += level_with * at;
            if (along > 0.0)
                below += along * at;
            else if (ends)
                below += along * vec3(-at.x, at.yz);
        }
    if (abreast.x <= 0.0 || below.x <= 0.0)
        return vec2(0.0, 1.0);
    float far = max(below.y / below.x - abreast.y / abreast.x, 0.5);
    return vec2(clamp((abreast.z / abreast.x - below.z / below.x) / far, 0.0, k.steepest), far);
}

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    ivec3 c = ivec3(cell_of(LOAD_U(cell, i)));
    uint stands = LOAD_U(level, i);
    int reach = int(k.reach);
    float sheet = 0.0, springs = 0.0, narrow = 0.0, all = 0.0, wide = 0.0;
    vec2 rain = vec2(0.0), spring = vec2(0.0);
    vec2 falls = vec2(0.0); // weighted squares of falls and of distances
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
            float near = weight_in(r), up = rise(there, stands, r);
            if (near > 0.0 && up < 0.0)
                falls += near * vec2(up * up, 0.5 * r * r);
            vec4 s = LOAD_V(stream, m);
            float off = length(to + flip * unpackSnorm2x16(LOAD_U(middle, m)));
            float weight = s.y > 0.0 && off < s.x ? s.y * spread(there, stands, off, s.x) / k.h : 0.0;
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
        vec2 fall = downstream(i, c, stands, way);
        float slope = fall.x;
        float together = sheet > 0.0 ? min(length(rain) / sheet, 1.0) : 1.0, around = falls.y > 0.0 ? sqrt(falls.x / falls.y) : 0.0;
        if (springs == 0.0)
            slope = mix(min(around, k.steepest), slope, together);
        AT(drop, i) = slope * fall.y * k.h;
        float depth = float(int(stands) - int(LOAD_U(altitude, i))) / 65536.0 * k.h, share = springs > 0.0 ? narrow / springs : 1.0;
        float moving = max(1.0 - depth / k.deep, 0.0), run = length(spring);
        result = vec4(moving * shear(run / share + sheet, slope), moving * shear(sheet, slope), share,
                      (run + sheet) * wide / all);
    }
    AT(pull, i) = result;
}
