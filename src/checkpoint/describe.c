#include <stdlib.h>

#include "base/hash.h"
#include "checkpoint/layout.h"

status checkpoint_describe(const char *path, struct text *out)
{
    status st = OK;
    struct layout layout;
    struct checkpoint c;
    char hash[17];
    TRY(layout_open(path, &c, &layout, NULL));
    json_integer(out, "frame", c.frame);
    json_number(out, "years", c.years);
    json_text(out, "job_hash", hash_text(c.job_hash, hash));
    json_text(out, "version", c.maker.version);
    json_text(out, "commit", c.maker.commit);
    json_text(out, "build", c.maker.build);
    json_text(out, "device", c.maker.device);
    json_text(out, "driver", c.maker.driver);
    json_array(out, "sections");
    for (size_t i = 0; i < c.n_sections; i++) {
        const struct checkpoint_section *s = &c.section[i];
        uint64_t stored = 0;
        for (size_t k = layout.first[i]; k < layout.first[i + 1]; k++)
            stored += layout.chunk[k].size;
        json_object(out, NULL);
        json_text(out, "name", s->name);
        json_integer(out, "items", (int64_t)s->n);
        json_integer(out, "item_bytes", (int64_t)s->item);
        json_integer(out, "raw_bytes", (int64_t)(s->n * s->item));
        json_integer(out, "stored_bytes", (int64_t)stored);
        json_text(out, "hash", hash_text(layout.hash[i], hash));
        json_end_object(out);
    }
    json_end_array(out);
    free(layout.chunk);
    TRY(text_status(out));
done:
    return st;
}
