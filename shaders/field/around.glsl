// Calls add(voxel, weight) for a voxel and its 18 face and edge neighbours with the weights of
// particles/share.glsl. Needs void add(ivec3 v, float weight).

void add_around(ivec3 v)
{
    add(v, SHARE_SELF);
    for (int s = -1; s <= 1; s += 2) {
        add(v + ivec3(s, 0, 0), SHARE_FACE);
        add(v + ivec3(0, s, 0), SHARE_FACE);
        add(v + ivec3(0, 0, s), SHARE_FACE);
        for (int t = -1; t <= 1; t += 2) {
            add(v + ivec3(s, t, 0), SHARE_EDGE);
            add(v + ivec3(s, 0, t), SHARE_EDGE);
            add(v + ivec3(0, s, t), SHARE_EDGE);
        }
    }
}
