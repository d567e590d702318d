// Trilinear interpolation of the distance field. Needs READ_U(slot), READ_F(distance_field) and k.voxel,
// k.origin_*, k.fx, k.fy, k.fz.
#include "field/lattice.glsl"

// x in samples from the first.
vec3 lattice_position(vec3 x)
{
    return (x - vec3(k.origin_x, k.origin_y, k.origin_z)) / k.voxel;
}

float sample_at(ivec3 c)
{
    uint s = LOAD_U(slot, brick_of(c));
    return slot_kept(s) ? LOAD_F(distance_field, slot_sample(s, c)) : slot_distance(s, k.voxel);
}

float distance_at(vec3 x)
{
    vec3 at = clamp(lattice_position(x), vec3(0.0), vec3(k.fx, k.fy, k.fz) - 1.001);
    ivec3 c = ivec3(at);
    vec3 f = at - vec3(c);
    vec4 low, high;
    if (all(lessThan(c & 7, ivec3(7)))) { // all eight samples are in one brick
        uint s = LOAD_U(slot, brick_of(c));
        if (!slot_kept(s))
            return slot_distance(s, k.voxel);
        uint i = slot_sample(s, c);
        low = vec4(LOAD_F(distance_field, i), LOAD_F(distance_field, i + 8u), LOAD_F(distance_field, i + 64u),
                   LOAD_F(distance_field, i + 72u));
        high = vec4(LOAD_F(distance_field, i + 1u), LOAD_F(distance_field, i + 9u), LOAD_F(distance_field, i + 65u),
                    LOAD_F(distance_field, i + 73u));
    } else {
        low = vec4(sample_at(c), sample_at(c + ivec3(0, 1, 0)), sample_at(c + ivec3(0, 0, 1)), sample_at(c + ivec3(0, 1, 1)));
        high = vec4(sample_at(c + ivec3(1, 0, 0)), sample_at(c + ivec3(1, 1, 0)), sample_at(c + ivec3(1, 0, 1)),
                    sample_at(c + ivec3(1, 1, 1)));
    }
    vec4 along_x = mix(low, high, f.x);
    vec2 along_y = mix(along_x.xz, along_x.yw, f.y);
    return mix(along_y.x, along_y.y, f.z);
}

vec3 gradient_at(vec3 x)
{
    float e = k.voxel;
    return vec3(distance_at(x + vec3(e, 0, 0)) - distance_at(x - vec3(e, 0, 0)),
                distance_at(x + vec3(0, e, 0)) - distance_at(x - vec3(0, e, 0)),
                distance_at(x + vec3(0, 0, e)) - distance_at(x - vec3(0, 0, e)));
}

// Distances at which the ray enters and leaves the field's box; enter > leave if it misses.
vec2 box_span(vec3 from, vec3 along)
{
    vec3 low = vec3(k.origin_x, k.origin_y, k.origin_z), high = low + (vec3(k.fx, k.fy, k.fz) - 1.0) * k.voxel;
    vec3 inverse = 1.0 / mix(along, vec3(1e-20), lessThan(abs(along), vec3(1e-20)));
    vec3 a = (low - from) * inverse, b = (high - from) * inverse;
    vec3 first = min(a, b), second = max(a, b);
    return vec2(max(max(first.x, first.y), max(first.z, 0.0)), min(second.x, min(second.y, second.z)));
}

// Root of the distance between two points of the ray, one outside and one inside, by the Illinois method: accurate to a millionth of
// a sample on this smooth field. Bisection would quantise surfaces, and pixels of a slowly moving surface would jump between frames.
float crossing(vec3 from, vec3 along, float outside, float d_outside, float inside, float d_inside)
{
    float at = inside, side = 0.0;
    for (int step = 0; step < 8 && d_inside < 0.0; step++) {
        at = outside + (inside - outside) * d_outside / (d_outside - d_inside);
        float d = distance_at(from + at * along);
        if (d <= 0.0) {
            inside = at;
            d_inside = d;
            d_outside *= side < 0.0 ? 0.5 : 1.0;
            side = -1.0;
        } else {
            outside = at;
            d_outside = d;
            d_inside *= side > 0.0 ? 0.5 : 1.0;
            side = 1.0;
        }
    }
    return at;
}

// Distance along the ray to the surface, or -1 if it misses.
float march(vec3 from, vec3 along, vec2 span)
{
    float t = span.x, before = span.x, d_before = 0.0;
    for (int step = 0; step < 1024 && t <= span.y; step++) {
        float d = distance_at(from + t * along);
        if (d <= 0.0)
            return step == 0 ? t : crossing(from, along, before, d_before, t, d);
        before = t;
        d_before = d;
        t += max(0.85 * d, 0.2 * k.voxel);
    }
    return -1.0;
}
