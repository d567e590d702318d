#version 460
#extension GL_GOOGLE_include_directive : require
// Step length alpha = r.z / p.q, from the partial sums of p.q. alpha r.z is the energy this step takes out of
// the error (Hestenes and Stiefel 1952), which tells when to stop.
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
