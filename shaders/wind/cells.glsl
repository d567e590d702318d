// FLOW_EACH(x, BODY): runs BODY for every particle j in the 27 cells around x. Needs READ_U(start) and
// wind/flow.glsl. Cells adjacent in x are contiguous in memory.

#define FLOW_EACH(middle, BODY)                                                                             \
    {                                                                                                       \
        ivec3 c = flow_cell(middle);                                                                        \
        int low = max(c.x - 1, 0), high = min(c.x + 1, int(k.gx) - 1);                                      \
        for (int cz = max(c.z - 1, 0); cz <= min(c.z + 1, int(k.gz) - 1); cz++)                             \
            for (int cy = max(c.y - 1, 0); cy <= min(c.y + 1, int(k.gy) - 1); cy++) {                       \
                uint end = LOAD_U(start, flow_index(ivec3(high, cy, cz)) + 1u);                             \
                for (uint j = LOAD_U(start, flow_index(ivec3(low, cy, cz))); j < end; j++) {                \
                    BODY                                                                                    \
                }                                                                                           \
            }                                                                                               \
    }
