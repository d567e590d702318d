#version 460
#extension GL_GOOGLE_include_directive : require
// Per thread and array, over every NUMBERS_THREADS-th vector: the smallest number of a vector with a component that
// is not finite or exceeds its limit.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, array_0)
READ_V(1, array_1)
READ_V(2, array_2)
READ_V(3, array_3)
READ_V(4, array_4)
READ_V(5, array_5)
READ_V(6, array_6)
READ_V(7, array_7)
WRITE_U(8, found)
PARAMS(numbers_params)

#define LOAD_ITEM LOAD_V
#define FITS(item) all(lessThanEqual(abs(item), vec4(k.most)))
#include "numbers/arrays.glsl"
