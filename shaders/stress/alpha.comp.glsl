#version 460
#extension GL_GOOGLE_include_directive : require
// Conjugate gradients, one group of 64: alpha = r.z / p.q from the partial sums of p.q. Records alpha r.z, the
// energy that this step removes from the error (Hestenes and Stiefel 1952, theorem 6:1), for the stopping rule.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, partial)
WRITE_F(1, scalars)
PARAMS(cg_params)
#include "stress/total.glsl"

void main()
{
    float pq = total();
    if (gl_LocalInvocationID.x != 0u)
        return;
    float rz = AT(scalars, CG_RZ);
    float alpha = pq > 0.0 ? rz / pq : 0.0;
    AT(scalars, CG_ALPHA) = alpha;
    AT(scalars, CG_ENERGY + k.iteration) = alpha * rz;
}
