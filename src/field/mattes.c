#include "field/mattes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "text/text.h"

/* The ids that a pixel's samples have hit; of more than MATTE_RANKS, the first ones are kept. */
struct ranks {
    uint16_t id[MATTE_RANKS], count[MATTE_RANKS]; /* count 0: free */
};

struct mattes {
    size_t n, n_strata;
    struct ranks *kind[MATTE_KINDS]; /* [n] */
};

static const char *const kind_names[MATTE_KINDS] = {"CryptoStrata", "CryptoPhase"};
static const char *const phase_names[] = {"rock", "deposit", "falling_block"};
enum { PHASES = sizeof phase_names / sizeof *phase_names };

static uint32_t rotate(uint32_t x, int by)
{
    return x << by | x >> (32 - by);
}

static uint32_t scramble(uint32_t k)
{
    return rotate(k * 0xcc9e2d51u, 15) * 0x1b873593u;
}

static uint32_t murmur3(const char *text)
{
    size_t n = strlen(text), whole = n / 4 * 4;
    uint32_t h = 0, k;
    for (size_t i = 0; i < whole; i += 4) {
        memcpy(&k, text + i, 4);
        h = rotate(h ^ scramble(k), 13) * 5 + 0xe6546b64u;
    }
    if (n > whole) {
        k = 0;
        memcpy(&k, text + whole, n - whole);
        h ^= scramble(k);
    }
    h ^= (uint32_t)n;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return h ^ h >> 16;
}

uint32_t matte_id(const char *name)
{
    uint32_t id = murmur3(name), exponent = id >> 23 & 255;
    return exponent == 0 || exponent == 255 ? id ^ 1u << 23 : id;
}

static void name_of(int kind, size_t id, char out[32])
{
    if (kind == 1)
        snprintf(out, 32, "%s", phase_names[id < PHASES ? id : 0]);
    else
        snprintf(out, 32, "stratum_%zu", id);
}

static float float_of(int kind, size_t id)
{
    char name[32];
    float value;
    name_of(kind, id, name);
    uint32_t bits = matte_id(name);
    memcpy(&value, &bits, sizeof value);
    return value;
}

status mattes_create(const struct job *job, size_t n_pixels, struct mattes **out)
{
    status st = OK;
    struct mattes *m = NULL;
    TRY(memory_alloc(1, sizeof *m, "mattes", &m));
    m->n = n_pixels;
    m->n_strata = job->n_strata;
    for (int k = 0; k < MATTE_KINDS; k++)
        TRY(memory_alloc(n_pixels, sizeof *m->kind[k], "mattes", &m->kind[k]));
    *out = m;
    m = NULL;
done:
    mattes_destroy(&m);
    return st;
}

void mattes_destroy(struct mattes **mattes)
{
    if (!*mattes)
        return;
    for (int k = 0; k < MATTE_KINDS; k++)
        free((*mattes)->kind[k]);
    free(*mattes);
    *mattes = NULL;
}

static void count(struct ranks *r, uint32_t id)
{
    for (int i = 0; i < MATTE_RANKS; i++)
        if (r->count[i] == 0 || r->id[i] == id) {
            r->id[i] = (uint16_t)id;
            r->count[i]++;
            return;
        }
}

void mattes_add(struct mattes *m, const uint32_t *ids, const float *hit)
{
    for (size_t i = 0; i < m->n; i++)
        if (hit[4 * i + 3] >= 0)
            for (size_t k = 0; k < MATTE_KINDS; k++)
                count(&m->kind[k][i], ids[3 * i + k]);
}

/* Descending by share, then ascending by id. */
static int by_share(const void *a, const void *b)
{
    const uint16_t *x = a, *y = b; /* count, id */
    return x[0] != y[0] ? (x[0] < y[0]) - (x[0] > y[0]) : (x[1] > y[1]) - (x[1] < y[1]);
}

static void fill(const struct mattes *m, int kind, int samples, float *const plane[2 * MATTE_RANKS])
{
    for (size_t i = 0; i < m->n; i++) {
        const struct ranks *r = &m->kind[kind][i];
        uint16_t pair[MATTE_RANKS][2];
        for (int k = 0; k < MATTE_RANKS; k++) {
            pair[k][0] = r->count[k];
            pair[k][1] = r->id[k];
        }
        qsort(pair, MATTE_RANKS, sizeof *pair, by_share);
        for (int k = 0; k < MATTE_RANKS; k++) {
            plane[2 * k][i] = pair[k][0] ? float_of(kind, pair[k][1]) : 0;
            plane[2 * k + 1][i] = (float)pair[k][0] / (float)samples;
        }
    }
}

void mattes_channels(const struct mattes *m, int samples, float *plane, struct aov_channel *out)
{
    static const char *const names[MATTE_KINDS][2 * MATTE_RANKS] = {
        {"CryptoStrata00.R", "CryptoStrata00.G", "CryptoStrata00.B", "CryptoStrata00.A", "CryptoStrata01.R",
         "CryptoStrata01.G", "CryptoStrata01.B", "CryptoStrata01.A", "CryptoStrata02.R", "CryptoStrata02.G",
         "CryptoStrata02.B", "CryptoStrata02.A"},
        {"CryptoPhase00.R", "CryptoPhase00.G", "CryptoPhase00.B", "CryptoPhase00.A", "CryptoPhase01.R",
         "CryptoPhase01.G", "CryptoPhase01.B", "CryptoPhase01.A", "CryptoPhase02.R", "CryptoPhase02.G",
         "CryptoPhase02.B", "CryptoPhase02.A"},
    };
    for (int k = 0; k < MATTE_KINDS; k++) {
        float *planes[2 * MATTE_RANKS];
        for (int c = 0; c < 2 * MATTE_RANKS; c++, plane += m->n) {
            planes[c] = plane;
            *out++ = (struct aov_channel){.part = kind_names[k], .name = names[k][c], .value = plane};
        }
        fill(m, k, samples, planes);
    }
}

static status add_note(struct aov_image *out, int kind, const char *what, const char *value)
{
    struct aov_note *note = &out->note[out->n_notes++];
    char hash[9]; /* readers tell mattes apart by the first seven digits of their name's */
    snprintf(hash, sizeof hash, "%08x", matte_id(kind_names[kind]));
    snprintf(note->name, sizeof note->name, "cryptomatte/%.7s/%s", hash, what);
    return memory_strdup(value, &note->value);
}

static status manifest(const struct mattes *m, int kind, struct text *out)
{
    char name[32];
    size_t n = kind == 1 ? PHASES : m->n_strata;
    for (size_t i = 0; i < n; i++) {
        name_of(kind, i, name);
        text_add(out, "%s\"%s\":\"%08x\"", i ? "," : "{", name, matte_id(name));
    }
    text_add(out, "}");
    return text_status(out);
}

status mattes_notes(const struct mattes *m, struct aov_image *out)
{
    status st = OK;
    struct text names = {0};
    TRY(memory_alloc(4 * MATTE_KINDS, sizeof *out->note, "mattes' names", &out->note));
    for (int k = 0; k < MATTE_KINDS; k++) {
        TRY(manifest(m, k, &names));
        TRY(add_note(out, k, "name", kind_names[k]));
        TRY(add_note(out, k, "hash", "MurmurHash3_32"));
        TRY(add_note(out, k, "conversion", "uint32_to_float32"));
        TRY(add_note(out, k, "manifest", names.data));
        text_free(&names);
    }
done:
    text_free(&names);
    return st;
}
