/* How much of everything the air takes: for flow.c and flow_box.c. */
#ifndef HOODOO_FLOW_BOX_H
#define HOODOO_FLOW_BOX_H

#include "wind/flow.h"

static inline size_t box_count(const struct flow *f)
{
    return (size_t)f->box[0] * (size_t)f->box[1] * (size_t)f->box[2];
}

static inline size_t cell_count(const struct flow *f)
{
    return (size_t)f->cells[0] * (size_t)f->cells[1] * (size_t)f->cells[2];
}

static inline size_t ground_count(const struct flow *f)
{
    return (size_t)f->box[0] * (size_t)f->box[1];
}

#endif
