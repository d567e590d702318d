#version 460
#extension GL_GOOGLE_include_directive : require
// Per item: if its flag is set, writes its number to the list at the flags' exclusive prefix sum. The last item also writes the length of the
// list.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_U(0, flags)
READ_U(1, place)
WRITE_U(2, list)
WRITE_U(3, length)
PARAMS(count_params)

void main()
{
    uint i = THREAD;
    if (i >= k.n)
        return;
    bool listed = LOAD_U(flags, i) != 0u;
    uint at = LOAD_U(place, i);
    if (listed)
        AT(list, at) = i;
    if (i == k.n - 1u)
        AT(length, 0) = listed ? at + 1u : at;
}
