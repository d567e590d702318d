#version 460
#extension GL_GOOGLE_include_directive : require
// Per pixel: one field of the particle under it, copied as a word; 0 where there is no rock.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, hit)
READ_U(1, ids)
READ_U(2, value)
WRITE_U(3, pixel)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    AT(pixel, i) = LOAD_V(hit, i).w >= 0.0 ? LOAD_U(value, LOAD_U(ids, 3u * i + 2u)) : 0u;
}
