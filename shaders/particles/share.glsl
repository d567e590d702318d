// Share of space that is rock around a voxel's centre: weighted mean of the fill of the voxel and its 18 face
// and edge neighbours. Needs fill_at().

float share_at(ivec3 v)
{
    float faces = 0.0, edges = 0.0;
    for (int s = -1; s <= 1; s += 2) {
        faces += fill_at(v + ivec3(s, 0, 0)) + fill_at(v + ivec3(0, s, 0)) + fill_at(v + ivec3(0, 0, s));
        for (int t = -1; t <= 1; t += 2)
            edges += fill_at(v + ivec3(s, t, 0)) + fill_at(v + ivec3(s, 0, t)) + fill_at(v + ivec3(0, s, t));
    }
    return SHARE_SELF * fill_at(v) + SHARE_FACE * faces + SHARE_EDGE * edges;
}
