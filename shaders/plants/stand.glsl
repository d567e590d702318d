// Where plants can stand: under open sky, on ground that is not too steep. The slope is measured over metres
// and along each axis to the gentler side, so that neither roughness nor a pit or wall beside counts. Needs
// particles/voxel.glsl and particles/empty.glsl.

const float SEEDLING = 0.02;
const float SLOPE_REACH = 2.0; // m to each side, but no less than three voxels
const int NOWHERE = 1 << 20;

// Distance of a column's ground from height z, above or below, in voxels, at most `most`; NOWHERE outside the domain.
int rise(ivec2 column, int z, int most)
{
    ivec3 v = ivec3(column, z);
    if (!voxel_inside(v))
        return NOWHERE;
    int n = 0;
    if (voxel_empty(v)) {
        while (n < most && voxel_empty(v - ivec3(0, 0, n)))
            n++;
        return n;
    }
    while (n < most && !voxel_empty(v + ivec3(0, 0, n + 1)))
        n++;
    return n;
}

float gentler(ivec3 v, ivec2 side, int reach)
{
    int most = 3 * reach, least = min(rise(v.xy + side, v.z, most), rise(v.xy - side, v.z, most));
    return least == NOWHERE ? 0.0 : float(least) / float(reach);
}

bool stands(vec3 x)
{
    ivec3 v = voxel_of(x);
    for (int z = v.z + 1; z < int(k.nz); z++)
        if (!voxel_empty(ivec3(v.xy, z)))
            return false;
    int reach = max(3, int(SLOPE_REACH / k.h + 0.5));
    float steepest = sqrt(1.0 - k.steepest * k.steepest) / max(k.steepest, 1e-6);
    return length(vec2(gentler(v, ivec2(reach, 0), reach), gentler(v, ivec2(0, reach), reach))) <= steepest;
}
