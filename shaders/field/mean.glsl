// What kernels share that write the mean of something over the particles of a sample's voxel and its neighbours, weighted as in the
// rock's share; 0 where there are none. Before this: the buffers words, start, list, share and mean, PARAMS(field_params), and
//   COUNTS(j)  whether particle j counts
//   OF(j)      its number
#include "field/lattice.glsl"
#include "particles/voxel.glsl"
#include "particles/bits.glsl"
#include "particles/held.glsl"
#include "particles/within.glsl"
#include "particles/sides.glsl"

vec2 sum = vec2(0.0);

void add(ivec3 v, float weight)
{
    v = side_voxel(v);
    if (!voxel_inside(v))
        return;
    uvec2 in_voxel = voxel_particles(v);
    for (uint j = in_voxel.x; j < in_voxel.y; j++)
        if (COUNTS(j))
            sum += weight * vec2(OF(j), 1.0);
}
#include "field/around.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    if (LOAD_F(share, i) > 0.0)
        add_around(brick_sample(LOAD_U(list, i / BRICK_SAMPLES), i % BRICK_SAMPLES) - int(k.margin));
    AT(mean, i) = sum.y > 0.0 ? sum.x / sum.y : 0.0;
}
