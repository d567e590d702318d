#include "model/sections.h"

#include <string.h>

#include "base/memory.h"

status section_add(struct checkpoint *c, const char *name, size_t item, size_t n, void **data)
{
    struct checkpoint_section *s = &c->section[c->n_sections];
    size_t length = strlen(name);
    memcpy(s->name, name, length < sizeof s->name ? length + 1 : sizeof s->name - 1);
    s->item = item;
    s->n = n;
    status st = memory_alloc(n, item, name, &s->data);
    if (st == OK)
        c->n_sections++;
    *data = s->data;
    return st;
}

status section_find(const struct checkpoint *c, const char *name, size_t item, size_t n,
                    const struct checkpoint_section **out)
{
    *out = checkpoint_find(c, name, item);
    if (!*out || (n && (*out)->n != n))
        return fail(E_CHECKPOINT, "the checkpoint of frame %d has no usable section '%s'", c->frame, name);
    return OK;
}
