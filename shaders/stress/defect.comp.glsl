#version 460
#extension GL_GOOGLE_include_directive : require
// Per moving node: defect d = r - K u, for the correction u of this level.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, list)
READ_U(1, run)
READ_U(2, table)
READ_V(3, u)
READ_F(4, fill)
READ_V(5, r)
WRITE_V(6, defect)
PARAMS(stress_params)
#include "stress/grid.glsl"
#include "stress/rows.glsl"
#include "stress/apply.glsl"

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    uint node = LOAD_U(list, i);
    AT(defect, node) = vec4(LOAD_V(r, i).xyz - apply_stiffness(node).xyz, 0.0);
}
