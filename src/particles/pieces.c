#include "particles/pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static const enum rock_field of_values[DEEP_VALUES] = {ROCK_stress, ROCK_von_mises, ROCK_erodibility};

/* Counts the rock's particles in each slab of voxels; false if they are not sorted by slab. */
static bool count_rock(const struct rock *rock, const struct frame_deep *deep, size_t *count)
{
    int last = 0;
    for (size_t i = 0; i < rock->n; i++) {
        const float z = floorf(rock->P[4 * i + 2] / (float)deep->h);
        const int k = (int)fminf(fmaxf(z, 0), (float)(deep->voxels[2] - 1));
        if (!(z == z) || k < last)
            return false;
        last = k;
        count[k]++;
    }
    return true;
}

static size_t count_deep(const struct frame_deep *deep, size_t slab, size_t k)
{
    size_t n = 0;
    for (size_t w = k * slab; deep->n && w < (k + 1) * slab; w++)
        n += (size_t)__builtin_popcount(deep->bits[w]);
    return n;
}

/* Adds slabs to a piece as long as they fit. */
static status cut_by_layer(struct rock_pieces *p, const size_t *count)
{
    const struct frame_deep *deep = p->deep;
    const size_t nz = (size_t)deep->voxels[2];
    const size_t slab = ((size_t)deep->voxels[0] + 31) / 32 * (size_t)deep->voxels[1];
    struct piece_start at = {0};
    size_t in_piece = 0;
    p->n = 0;
    for (size_t k = 0; k < nz; k++) {
        const size_t made = count_deep(deep, slab, k);
        if (in_piece > 0 && in_piece + count[k] + made > PIECE_MAX) {
            p->start[++p->n] = at;
            in_piece = 0;
        }
        in_piece += count[k] + made;
        at = (struct piece_start){at.rock + count[k], (k + 1) * slab, at.deep + made};
    }
    p->start[++p->n] = at;
    return OK;
}

static void cut_by_number(struct rock_pieces *p)
{
    for (p->n = 0; p->n == 0 || p->start[p->n].rock < p->rock->n; p->n++) {
        const size_t left = p->rock->n - p->start[p->n].rock;
        p->start[p->n + 1].rock = p->start[p->n].rock + (left < PIECE_MAX ? left : PIECE_MAX);
    }
}

status rock_pieces_begin(const struct rock *rock, const struct frame_deep *deep, struct rock_pieces *p)
{
    status st = OK;
    size_t *count = NULL;
    const size_t layers = deep ? (size_t)deep->voxels[2] : 0;
    *p = (struct rock_pieces){.rock = rock, .deep = deep};
    TRY(memory_alloc((layers > rock->n / PIECE_MAX ? layers : rock->n / PIECE_MAX) + 2, sizeof *p->start,
                     "pieces of rock", &p->start));
    TRY(memory_alloc(layers, sizeof *count, "layers of rock", &count));
    if (layers && count_rock(rock, deep, count))
        TRY(cut_by_layer(p, count));
    else if (!layers || deep->n == 0)
        cut_by_number(p);
    else
        st = fail(E_NUMERIC, "particles are not in the order of their voxels, or are nowhere");
done:
    free(count);
    if (st != OK)
        rock_pieces_end(p);
    return st;
}

void rock_pieces_end(struct rock_pieces *p)
{
    free(p->start);
    *p = (struct rock_pieces){0};
}

/* n items of a field, from item `from` on. */
static void copy_items(const struct rock *in, size_t from, size_t n, struct rock *out, size_t to, int f)
{
    const size_t size = rock_field_size((enum rock_field)f);
    if (in->field[f] && out->field[f] && n)
        memcpy((char *)out->field[f] + to * size, (const char *)in->field[f] + from * size, n * size);
}

/* Makes the particles of deep voxels, after n others in *out. */
static status add_deep(const struct rock_pieces *p, size_t i, struct rock *out, size_t n)
{
    status st = OK;
    const struct frame_deep *deep = p->deep;
    const struct piece_start *s = &p->start[i], *end = &p->start[i + 1];
    const size_t words = p->start[p->n].word;
    struct rock made = {0};
    uint32_t *bits = NULL;
    TRY(memory_alloc(words, sizeof *bits, "bits of voxels", &bits));
    memcpy(bits + s->word, deep->bits + s->word, (end->word - s->word) * sizeof *bits);
    TRY(deep->make(deep->source, bits, &made));
    for (int f = 0; f < ROCK_FIELDS; f++)
        copy_items(&made, 0, made.n, out, n, f);
    for (size_t v = 0; v < DEEP_VALUES; v++)
        if (out->field[of_values[v]])
            memcpy((float *)out->field[of_values[v]] + n, deep->value[v] + s->deep, made.n * sizeof(float));
done:
    free(bits);
    rock_free(&made);
    return st;
}

status rock_piece(const struct rock_pieces *p, size_t i, struct rock *out)
{
    status st = OK;
    const struct piece_start *s = &p->start[i], *end = &p->start[i + 1];
    const size_t n = end->rock - s->rock, made = end->deep - s->deep;
    if (n == p->rock->n && made == 0) {
        *out = *p->rock;
        return OK;
    }
    *out = (struct rock){.n = n + made};
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (p->rock->field[f]) {
            TRY(memory_alloc(out->n, rock_field_size((enum rock_field)f), rock_field_table[f].name,
                             &out->field[f]));
            copy_items(p->rock, s->rock, n, out, 0, f);
        }
    if (made)
        TRY(add_deep(p, i, out, n));
done:
    if (st != OK)
        rock_free(out);
    return st;
}

void rock_piece_free(const struct rock_pieces *p, struct rock *piece)
{
    if (piece->P == p->rock->P)
        *piece = (struct rock){0};
    else
        rock_free(piece);
}
