#include "look/history.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "model/sections.h"
#include "render/report_page.h"

static const char section[] = "numbers of looks";

static struct history_item *find(struct history *h, uint64_t hash)
{
    for (size_t k = 0; k < h->n; k++) {
        const size_t i = (h->last + k) % h->n;
        if (h->item[i].hash == hash) {
            h->last = i;
            return &h->item[i];
        }
    }
    return NULL;
}

bool history_has(struct history *h, uint64_t hash)
{
    return find(h, hash);
}

static status add(struct history *h, const struct history_item *item)
{
    status st = OK;
    if (find(h, item->hash))
        return OK;
    TRY(memory_grow(&h->item, &h->capacity, h->n + 1, sizeof *h->item, "numbers of frames"));
    h->item[h->n++] = *item;
done:
    return st;
}

status history_note(struct history *h, uint64_t hash, const struct frame *f)
{
    struct history_item item = {.hash = hash,
                                .years = f->years,
                                .volume_m3 = f->volume_m3,
                                .start_volume_m3 = f->start_volume_m3,
                                .max_stress_Pa = f->max_stress_Pa,
                                .ledger = f->ledger};
    for (size_t c = 0; c < f->n_changes; c++)
        for (int p = 0; p < PROCESSES; p++)
            if (strcmp(f->change[c].process, job_processes[p].name) == 0)
                item.change_m3[p] = f->change[c].m3;
    return add(h, &item);
}

status history_give(struct history *h, const uint64_t *hash, size_t n, struct checkpoint *state)
{
    status st = OK;
    struct history_item *item;
    void *data;
    size_t known = 0;
    for (size_t i = 0; i < n; i++)
        known += history_has(h, hash[i]);
    TRY(section_add(state, section, sizeof *item, known, &data));
    item = data;
    for (size_t i = 0; i < n; i++) {
        const struct history_item *own = find(h, hash[i]);
        if (own)
            *item++ = *own;
    }
done:
    return st;
}

status history_take(struct history *h, const struct checkpoint *state)
{
    status st = OK;
    const struct checkpoint_section *s = checkpoint_find(state, section, sizeof(struct history_item));
    for (size_t i = 0; s && i < s->n; i++)
        TRY(add(h, (const struct history_item *)s->data + i));
done:
    return st;
}

/* As a frame's manifest, which the report reads. */
static void as_manifest(const struct job *job, int frame, const struct history_item *item, struct manifest *m)
{
    const struct job *then = job_at(job, frame);
    *m = (struct manifest){.frame = frame,
                           .years = item->years,
                           .volume_m3 = item->volume_m3,
                           .start_volume_m3 = item->start_volume_m3,
                           .max_stress_Pa = item->max_stress_Pa,
                           .ledger = item->ledger};
    for (int p = 0; p < PROCESSES; p++)
        if (job_has_process(then, (enum process)p)) {
            struct manifest_change *change = &m->change[m->n_changes++];
            snprintf(change->process, sizeof change->process, "%s", job_processes[p].name);
            change->m3 = item->change_m3[p];
        }
}

status history_curves(struct history *h, struct job *job, const uint64_t *hash, int mark, struct text *json)
{
    status st = OK;
    const size_t n = range_count(job->frames);
    struct report r = {.job = job, .frames = job->frames, .mark = &mark};
    TRY(memory_alloc(n, sizeof *r.frame, "numbers of frames", &r.frame));
    for (size_t i = 0; i < n; i++) {
        const struct history_item *item = find(h, hash[i]);
        if (item)
            as_manifest(job, job->frames.first + (int)i, item, &r.frame[r.n_frames++].manifest);
    }
    r.n_sound = r.n_frames;
    if (r.n_frames >= 2)
        page_curves(&r, json);
done:
    free(r.frame);
    return st;
}

void history_free(struct history *h)
{
    free(h->item);
    *h = (struct history){0};
}
