// The surface of heaps as it is shown: particles hold it by whole voxels, so each column of deposits is given a height, and what is
// steeper than repose between two columns slides from one to the other, as in a heap of sand. A column is known by the voxel on top
// of its deposits, or over bare rock, its head: `height` has its height there in HEAP_UNITs of a voxel, and HEAP_NONE elsewhere. Needs
// field/lattice.glsl, particles/voxel.glsl, particles/bits.glsl and particles/sides.glsl.
//
// A heap at rest must look the same in every frame, so what shows of it depends on little else than its own columns. Heights are whole
// numbers of a unit, so that slides end instead of fading out over the whole heap, where each grain that lands would stir all of it.
// And bare rock counts as full voxels until they are gone, so that a heap does not creep after the rock that weathers beside it.

const float HEAP_NONE = -1e9;
const float HEAP_UNIT = 64.0; // to a voxel
const int HEAP_REACH = 3; // voxels between the heads of neighbours, and that a surface may move

// Where a voxel's sample is, SAMPLE_NONE if it is not kept or not of the domain.
const uint SAMPLE_NONE = 0xffffffffu;

uint voxel_sample(ivec3 v)
{
    v = side_voxel(v);
    if (!voxel_inside(v))
        return SAMPLE_NONE;
    ivec3 c = v + int(k.margin);
    uint s = LOAD_U(slot, brick_of(c));
    return slot_kept(s) ? slot_sample(s, c) : SAMPLE_NONE;
}

// How far from here the i-th place to look for a head lies: 0, 1, -1, 2, -2, 3, -3.
int heap_look(int i)
{
    return (i & 1) == 0 ? -(i >> 1) : (i >> 1) + 1;
}
