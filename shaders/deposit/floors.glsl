// The voxels in which a fragment can land, by cell. No two cells share one: a cell has its own, those of the
// empty cell above, and those of the cell below if that is not empty. Needs READ_U(tag) and READ_U(bits).

const int NOWHERE = 0x7fffffff;

// The highest voxel in which a fragment of the cell can land.
int ceiling(ivec3 base)
{
    return min(base.z + 3, int(k.nz) - 1);
}

// The free voxel on top of each of the cell's columns; NOWHERE if a fragment cannot land there.
ivec4 floors(ivec3 c, ivec3 base)
{
    bool deep = c.z > 0 && (LOAD_U(tag, cell_index(c - ivec3(0, 0, 1))) & WATER_KIND) != WATER_EMPTY;
    int low = max(deep ? base.z - 2 : base.z, 0), high = ceiling(base);
    ivec4 f;
    for (int q = 0; q < 4; q++) {
        int x = base.x + (q & 1), y = base.y + (q >> 1);
        f[q] = x >= 0 && x < int(k.nx) && y >= 0 && y < int(k.ny) ? floor_in(x, y, base.z) : NOWHERE;
        if (f[q] < low || f[q] > high)
            f[q] = NOWHERE;
    }
    return f;
}

uint free_voxels(ivec3 base, ivec4 f)
{
    ivec4 n = ceiling(base) + 1 - f;
    return uint((f.x == NOWHERE ? 0 : n.x) + (f.y == NOWHERE ? 0 : n.y) + (f.z == NOWHERE ? 0 : n.z) +
                (f.w == NOWHERE ? 0 : n.w));
}
