// The wet share of a voxel and its seepage, from what columns.h computes for each bed of its column. Needs
// READ_V(wet), PARAMS(seep_params), particles/voxel.glsl.

// The share of the voxel that is in the wet zone of a face. w: (base, top, seepage of the face, seepage of the top).
float wet_zone(ivec3 v, vec4 w)
{
    float low = float(v.z) * k.h, high = low + k.h;
    float share = (min(high, min(w.x + k.zone, w.y)) - max(low, w.x)) / k.h;
    return w.z > 0.0 && share > 1e-3 ? share : 0.0; // no more than a bed's top that is a hair below the voxel's
}

// Does water come out at the rock's top here?
bool wet_top(ivec3 v, vec4 w)
{
    return w.w > 0.0 && int(round(w.y / k.h)) == v.z + 1;
}

vec4 wet_at(ivec3 v, uint bed)
{
    return LOAD_V(wet, 2u * ((bed * k.ny + uint(v.y)) * k.nx + uint(v.x)));
}

// How long the column's open faces are, in widths of a column.
float wet_front(ivec3 v, uint bed)
{
    return LOAD_V(wet, 2u * ((bed * k.ny + uint(v.y)) * k.nx + uint(v.x)) + 1u).x;
}
