// Body of kernels that compute the mean of a value over the particles of a sample's voxel and its neighbours,
// with the weights of particles/share.glsl; 0 where there are none. Before including it, declare the buffers
// words, start, list, share and mean and PARAMS(field_params), and define
//   COUNTS(j)  whether particle j counts
//   OF(j)      its value
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
