// A voxel's stratum: by its slab where beds are level, else by voxel, two to a word. Needs READ_U(layer_of) and
// voxels/grid.glsl.

uint layer_at(uint voxel)
{
    return k.tilted == 0u ? LOAD_U(layer_of, slab_of(voxel))
                          : LOAD_U(layer_of, voxel >> 1) >> (16u * (voxel & 1u)) & 0xffffu;
}
