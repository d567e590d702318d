/* The index of a checkpoint, in JSON. Reading it trusts nothing. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "checkpoint/chunk.h"
#include "checkpoint/layout.h"
#include "text/json.h"

enum { FRAME_LIMIT = 10000000 };

size_t section_chunks(const struct checkpoint_section *s)
{
    size_t raw = chunk_raw_size(s->item), total = s->n * s->item;
    return total / raw + (total % raw != 0);
}

size_t section_chunk_raw(const struct checkpoint_section *s, size_t k)
{
    size_t raw = chunk_raw_size(s->item), left = s->n * s->item - k * raw;
    return left < raw ? left : raw;
}

status index_write(const struct checkpoint *c, const struct layout *layout, struct text *out)
{
    char hash[17];
    json_object(out, NULL);
    json_integer(out, "frame", c->frame);
    json_number(out, "years", c->years);
    json_text(out, "job_hash", hash_text(c->job_hash, hash));
    json_text(out, "version", c->maker.version);
    json_text(out, "commit", c->maker.commit);
    json_text(out, "build", c->maker.build);
    json_text(out, "device", c->maker.device);
    json_text(out, "driver", c->maker.driver);
    json_array(out, "sections");
    for (size_t i = 0; i < c->n_sections; i++) {
        const struct checkpoint_section *s = &c->section[i];
        json_object(out, NULL);
        json_text(out, "name", s->name);
        json_integer(out, "item", (int64_t)s->item);
        json_integer(out, "count", (int64_t)s->n);
        json_text(out, "hash", hash_text(layout->hash[i], hash));
        /* Offsets and sizes alternate. */
        json_array(out, "chunks");
        for (size_t k = layout->first[i]; k < layout->first[i + 1]; k++) {
            json_integer(out, NULL, (int64_t)layout->chunk[k].at);
            json_integer(out, NULL, (int64_t)layout->chunk[k].size);
        }
        json_end_array(out);
        json_end_object(out);
    }
    json_end_array(out);
    json_end_object(out);
    return text_status(out);
}

/* ---- reading */

static status get_text(const struct json *object, const char *key, char *out, size_t size)
{
    const char *text = json_to_text(json_member(object, key));
    if (!text || strlen(text) >= size)
        return fail(E_CHECKPOINT, "'%s' is missing, not a text, or longer than %zu bytes", key, size - 1);
    memcpy(out, text, strlen(text) + 1);
    return OK;
}

static status get_size(const struct json *object, const char *key, size_t min, size_t max, size_t *out)
{
    int64_t n;
    int64_t limit = max > INT64_MAX ? INT64_MAX : (int64_t)max;
    if (!json_to_integer(json_member(object, key), (int64_t)min, limit, &n))
        return fail(E_CHECKPOINT, "'%s' is missing, or not a whole number between %zu and %zu", key, min,
                    max);
    *out = (size_t)n;
    return OK;
}

static status get_hash(const struct json *object, const char *key, uint64_t *out)
{
    char digits[17];
    status st = OK;
    TRY(get_text(object, key, digits, sizeof digits));
    if (strspn(digits, "0123456789abcdef") != 16)
        return fail(E_CHECKPOINT, "'%s' is not 16 hex digits", key);
    *out = strtoull(digits, NULL, 16);
done:
    return st;
}

static status read_provenance(const struct json *object, struct checkpoint *c)
{
    status st = OK;
    int64_t frame;
    struct maker *maker = &c->maker;
    const struct json *years = json_member(object, "years");
    if (!json_to_integer(json_member(object, "frame"), -FRAME_LIMIT, FRAME_LIMIT, &frame))
        return fail(E_CHECKPOINT, "'frame' is missing or not a frame number");
    if (!years || years->kind != JSON_NUMBER || !isfinite(years->number))
        return fail(E_CHECKPOINT, "'years' is missing or not a finite number");
    c->frame = (int)frame;
    c->years = years->number;
    TRY(get_hash(object, "job_hash", &c->job_hash));
    TRY(get_text(object, "version", maker->version, sizeof maker->version));
    if (json_member(object, "build"))
        TRY(get_text(object, "build", maker->build, sizeof maker->build));
    TRY(get_text(object, "commit", maker->commit, sizeof maker->commit));
    TRY(get_text(object, "device", maker->device, sizeof maker->device));
    TRY(get_text(object, "driver", maker->driver, sizeof maker->driver));
done:
    return st;
}

/* Reads the list of a section's chunks. Each must begin at *at, where the previous one ends. */
static status read_chunks(const struct json *object, const struct checkpoint_section *s,
                          struct layout *layout, size_t *capacity, uint64_t *at, uint64_t limit)
{
    status st = OK;
    const struct json *list = json_member(object, "chunks");
    size_t n = section_chunks(s);
    if (!list || list->kind != JSON_ARRAY || list->n / 2 != n || list->n % 2)
        return fail(E_CHECKPOINT,
                    "section '%s': %zu items of %zu bytes need %zu chunks, but the list has another number",
                    s->name, s->n, s->item, n);
    TRY(memory_grow(&layout->chunk, capacity, layout->n_chunks + n, sizeof *layout->chunk,
                    "the chunk table"));
    const struct json *v = list->first;
    for (size_t k = 0; k < n; k++, v = v->next->next) {
        int64_t place, size, bound = (int64_t)chunk_bound(section_chunk_raw(s, k));
        if (!json_to_integer(v, (int64_t)*at, (int64_t)*at, &place) ||
            !json_to_integer(v->next, 1, bound, &size) || (uint64_t)size > limit - *at)
            return fail(E_CHECKPOINT,
                        "section '%s': chunk %zu of %zu is not at byte %llu, or has an impossible size",
                        s->name, k + 1, n, (unsigned long long)*at);
        layout->chunk[layout->n_chunks++] = (struct chunk){*at, (uint64_t)size};
        *at += (uint64_t)size;
    }
done:
    return st;
}

static status read_section(const struct json *object, struct checkpoint *c, struct layout *layout,
                           size_t *capacity, uint64_t *at, uint64_t limit)
{
    status st = OK;
    struct checkpoint_section *s = &c->section[c->n_sections];
    TRY(get_text(object, "name", s->name, sizeof s->name));
    for (size_t i = 0; i < c->n_sections; i++)
        if (strcmp(c->section[i].name, s->name) == 0)
            return fail(E_CHECKPOINT, "two sections are named '%s'", s->name);
    TRY(get_size(object, "item", 1, CHUNK_ITEM_MAX, &s->item));
    TRY(get_size(object, "count", 0, SIZE_MAX / 2 / s->item, &s->n));
    TRY(get_hash(object, "hash", &layout->hash[c->n_sections]));
    layout->first[c->n_sections] = layout->n_chunks;
    TRY(read_chunks(object, s, layout, capacity, at, limit));
    layout->first[++c->n_sections] = layout->n_chunks;
done:
    return st;
}

status index_read(const char *text, size_t size, uint64_t index_at, struct checkpoint *c,
                  struct layout *layout)
{
    struct json *json = NULL;
    size_t capacity = 0;
    uint64_t at = sizeof(struct file_head);
    status st = json_read(NULL, text, size, &json);
    if (st != OK)
        return st == E_INPUT ? fail(E_CHECKPOINT, "%s", status_message()) : st;
    TRY(read_provenance(json, c));
    const struct json *sections = json_member(json, "sections");
    if (!sections || sections->kind != JSON_ARRAY || sections->n > CHECKPOINT_SECTIONS_MAX) {
        st = fail(E_CHECKPOINT, "'sections' is missing, not a list, or longer than %d",
                  CHECKPOINT_SECTIONS_MAX);
        goto done;
    }
    for (const struct json *v = sections->first; v; v = v->next)
        TRY(read_section(v, c, layout, &capacity, &at, index_at));
    if (at != index_at)
        st = fail(E_CHECKPOINT, "%llu bytes before the index do not belong to any section",
                  (unsigned long long)(index_at - at));
done:
    json_free(&json);
    return st;
}
