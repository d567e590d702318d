// The wet share of a voxel and its seepage, from what columns.h computes for each bed of its column. Needs
// READ_V(wet), PARAMS(seep_params), particles/voxel.glsl.

// The share of the voxel that is in the wet zone of a face. w: (base, top, seepage of the face, seepage of the top).
float wet_zone(ivec3 v, vec4 w)
{
    float low = float(v.z) * k.h, high = low + k.h;
    float share = (min(high, min(w.x + k.zone, w.y)) - max(low, w.x)) / k.h;
    return w.z > 0.0 && share > 1e-3 ? share : 0.0; // ignore slivers, where a bed's top is just below the voxel's
}

// Whether water comes out at the rock's top in this voxel.
bool wet_top(ivec3 v, vec4 w)
{
    return w.w > 0.0 && int(round(w.y / k.h)) == v.z + 1;
}

vec4 wet_at(ivec3 v, uint bed)
{
    return LOAD_V(wet, 2u * ((bed * k.ny + uint(v.y)) * k.nx + uint(v.x)));
}

// Length of the column's open faces, in column widths.
float wet_front(ivec3 v, uint bed)
{
    return LOAD_V(wet, 2u * ((bed * k.ny + uint(v.y)) * k.nx + uint(v.x)) + 1u).x;
}
