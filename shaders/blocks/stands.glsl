// Support of a particle of a given phase in a voxel. Its voxel, or if that is not solid one across a face, must
// belong to a block on the ground. Deposits are loose: they stay as long as the rock below their column of
// deposits stays, however thin it is; deposition moves those with nothing below. Needs READ_U of solid, root,
// words, start and phase, and particles/within.glsl.

bool stands(ivec3 v)
{
    if (!voxel_inside(v))
        return false;
    uint s = voxel_slot(v), ground = voxel_rank(ivec3(0, 0, 1));
    if (s == NOT_HELD)
        return voxel_deep(v); // unsupported voxels are no longer deep here
    return LOAD_U(solid, s) != 0u && LOAD_U(root, s) < ground;
}

// A solid voxel is supported by its own block alone: its neighbours may be across a joint.
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
