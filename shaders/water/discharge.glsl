// The discharge at a point of the surface, m3/yr: bilinear between the four nearest columns' floors, of those
// within a cell and a half of its height. So a stream is as wide as two cells and fades out to its sides, and
// the grid does not show; where there are fewer floors (at a cliff, in a gully) they count alone. Needs
// water/columns.glsl and READ_U of altitude, rain and spring.

float discharge_at(vec3 x)
{
    vec3 c = x / k.cell + 0.5 * vec3(k.sx, k.sy, k.sz);
    vec2 at = c.xy - 0.5, low = floor(at), share = at - low;
    int level = clamp(int(c.z), 0, int(k.cz) - 1);
    float sum = 0.0, weights = 0.0;
    for (int s = 0; s < 4; s++) {
        ivec2 o = ivec2(s & 1, s >> 1), to = clamp(ivec2(low) + o, ivec2(0), ivec2(k.cx, k.cy) - 1);
        uint column = uint(to.y) * k.cx + uint(to.x), node = NONE;
        for (int z = min(level + 1, int(k.cz) - 1); z >= max(level - 1, 0); z--)
            if (node == NONE)
                node = node_at(column, uint(z));
        if (node == NONE || abs(float(LOAD_U(altitude, node)) * (1.0 / 65536.0) - c.z) > 1.5)
            continue;
        float weight = (o.x == 1 ? share.x : 1.0 - share.x) * (o.y == 1 ? share.y : 1.0 - share.y);
        sum += weight * (float(LOAD_U(rain, node)) * k.rain_unit + float(LOAD_U(spring, node)) * k.spring_unit);
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : 0.0;
}
