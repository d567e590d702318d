#version 460
#extension GL_GOOGLE_include_directive : require
// Per thread and array, over every NUMBERS_THREADS-th value: the smallest number of a value that
// is not finite or exceeds its limit.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_F(0, array_0)
READ_F(1, array_1)
READ_F(2, array_2)
READ_F(3, array_3)
READ_F(4, array_4)
READ_F(5, array_5)
READ_F(6, array_6)
READ_F(7, array_7)
WRITE_U(8, found)
PARAMS(numbers_params)

#define LOAD_ITEM LOAD_F
#define FITS(item) (abs(item) <= k.most)
#include "numbers/arrays.glsl"
