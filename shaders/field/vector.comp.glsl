#version 460
#extension GL_GOOGLE_include_directive : require
// One component of a vector that particles carry, at each sample of the field: its mean over the particles of the sample's voxel
// and its neighbours, weighted as in the rock's share; 0 where there are none.
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
