// The displayed surface of heaps. Particles store deposits by whole voxels, so each column of deposits gets a
// height, and where the slope between two columns exceeds repose, material slides from one to the other. A
// column is identified by its head, the voxel on top of its deposits or above bare rock. `height` holds its
// height in that voxel in HEAP_UNITs, and HEAP_NONE elsewhere. Needs field/lattice.glsl, particles/voxel.glsl,
// particles/bits.glsl and particles/sides.glsl.
//
// A heap at rest must look the same in every frame, so its surface depends on little but its own columns.
// Heights are integers, so that slides end instead of fading out over the whole heap, where each grain that
// lands would stir all of it. Bare rock counts as full voxels until these are gone, so that a heap does not
// creep as the rock beside it weathers.

const float HEAP_NONE = -1e9;
const float HEAP_UNIT = 64.0; // units per voxel
const int HEAP_REACH = 3; // voxels: largest height difference of neighbouring heads, and of a surface from its particles

// Index of a voxel's sample; SAMPLE_NONE if it is not kept or outside the domain.
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

// Offset of the i-th place to search for a head: 0, 1, -1, 2, -2, 3, -3.
int heap_look(int i)
{
    return (i & 1) == 0 ? -(i >> 1) : (i >> 1) + 1;
}
