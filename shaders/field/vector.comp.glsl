#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample: mean of one component of a particles' vector over its voxel and the neighbours, with the weights
// of particles/share.glsl; 0 where there are none.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, start)
READ_V(2, vector)
READ_U(3, list)
READ_F(4, share)
WRITE_F(5, mean)
PARAMS(field_params)
#define COUNTS(j) (true)
#define OF(j) LOAD_V(vector, j)[k.component]
#include "field/mean.glsl"
