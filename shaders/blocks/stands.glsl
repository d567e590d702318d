// Does what stands on the ground hold a particle of this phase in this voxel? The voxel, or one across a face of
// it, where it is not solid itself, must belong to a block that does. Deposits lie loose, grain by grain: they stay if the rock that the column
// of deposits below them lies on stays, however thin it is; what lies on nothing is deposition's to move. Needs
// READ_U of solid, root, words, start and phase, and particles/within.glsl.

bool stands(ivec3 v)
{
    if (!voxel_inside(v))
        return false;
    uint s = voxel_slot(v), ground = voxel_rank(ivec3(0, 0, 1));
    if (s == NOT_HELD)
        return voxel_deep(v); // what does not stand is not left deep
    return LOAD_U(solid, s) != 0u && LOAD_U(root, s) < ground;
}

// Solid, and beside a joint perhaps: its own block is what counts.
bool has_block(ivec3 v)
{
    uint s = voxel_slot(v);
    return s != NOT_HELD && LOAD_U(solid, s) != 0u;
}

bool holds(ivec3 v)
{
    if (stands(v) || has_block(v))
        return stands(v);
    return stands(v - ivec3(0, 0, 1)) || stands(v + ivec3(0, 0, 1)) || stands(v - ivec3(1, 0, 0)) ||
           stands(v + ivec3(1, 0, 0)) || stands(v - ivec3(0, 1, 0)) || stands(v + ivec3(0, 1, 0));
}

bool held(ivec3 v, uint own_phase)
{
    bool stays = holds(v), loose = own_phase == PHASE_DEPOSIT;
    for (v.z--; !stays && loose; v.z--) {
        uvec2 below = v.z < 0 ? uvec2(0u) : voxel_particles(v);
        if (below.x == below.y)
            stays = true;
        else {
            loose = LOAD_U(phase, below.x) == PHASE_DEPOSIT;
            stays = holds(v);
        }
    }
    return stays;
}
