#include "voxels/support.h"

static size_t domain_voxels(const struct voxels *v)
{
    return (size_t)v->n[0] * (size_t)v->n[1] * (size_t)v->n[2];
}

void voxels_solid(struct gpu *gpu, const struct voxels *v, struct gpu_buffer *solid)
{
    struct voxels_params k = voxels_params(v, domain_voxels(v));
    GPU_RUN(gpu, voxels_solid, k.n, k, v->left, solid);
}

status voxels_fall(struct gpu *gpu, struct gpu_work *work, struct voxels *v, struct gpu_buffer *solid,
                   struct gpu_buffer *root, struct gpu_buffer *stands)
{
    status st = OK;
    struct voxels_params k = voxels_params(v, domain_voxels(v));
    struct gpu_rounds r = {.what = "goblins: weathered rock still gains support", .most = k.n};
    GPU_RUN(gpu, voxels_stand, k.n, k, solid, root, v->left, stands);
    while (gpu_round(gpu, work, &r)) {
        k.flag = r.flag;
        GPU_RUN(gpu, voxels_cling, k.n, k, v->left, solid, stands, r.flags);
    }
    TRY(r.st);
    GPU_RUN(gpu, voxels_fall, k.n, k, stands, v->left, v->bits);
done:
    return st;
}
