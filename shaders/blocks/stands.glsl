// Does what stands on the ground hold a particle of this phase in this voxel? The voxel, or one across a face of
// it, must belong to a block that does. Deposits lie loose, grain by grain: they stay if the rock that the column
// of deposits below them lies on stays, however thin it is; what lies on nothing is deposition's to move. Needs
// READ_U of solid, root, start and phase, and particles/voxel.glsl.

bool stands(ivec3 v)
{
    if (!voxel_inside(v))
        return false;
    uint i = voxel_index(v);
    return LOAD_U(solid, i) != 0u && LOAD_U(root, i) < k.nx * k.ny;
}

bool holds(ivec3 v)
{
    return stands(v) || stands(v - ivec3(0, 0, 1)) || stands(v + ivec3(0, 0, 1)) || stands(v - ivec3(1, 0, 0)) ||
           stands(v + ivec3(1, 0, 0)) || stands(v - ivec3(0, 1, 0)) || stands(v + ivec3(0, 1, 0));
}

bool held(ivec3 v, uint own_phase)
{
    bool stays = holds(v), loose = own_phase == PHASE_DEPOSIT;
    for (v.z--; !stays && loose; v.z--) {
        uint c = v.z < 0 ? 0u : voxel_index(v), first = LOAD_U(start, c);
        if (v.z < 0 || first == LOAD_U(start, c + 1u))
            stays = true;
        else {
            loose = LOAD_U(phase, first) == PHASE_DEPOSIT;
            stays = holds(v);
        }
    }
    return stays;
}
