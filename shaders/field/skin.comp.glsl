#version 460
#extension GL_GOOGLE_include_directive : require
// Per sample: mean of a value over the surface particles (those with a normal) of its voxel and the neighbours,
// with the weights of particles/share.glsl; 0 where there are none.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, words)
READ_U(1, start)
READ_V(2, normal)
READ_F(3, value)
READ_U(4, list)
READ_F(5, share)
WRITE_F(6, mean)
PARAMS(field_params)
#define COUNTS(j) (LOAD_V(normal, j).xyz != vec3(0.0))
#define OF(j) LOAD_F(value, j)
#include "field/mean.glsl"
