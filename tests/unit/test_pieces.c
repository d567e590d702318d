/* A frame's rock in pieces: the same ones whether its particles are there or are made of deep voxels. */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "particles/pieces.h"

enum { NX = 130, NY = 200, NZ = 180, WORDS_ACROSS = (NX + 31) / 32, ALL = NX * NY * NZ };

static void place(size_t id, float P[4])
{
    P[0] = (float)(id % NX) + 0.5F;
    P[1] = (float)(id / NX % NY) + 0.5F;
    P[2] = (float)(id / NX / NY) + 0.5F;
}

static size_t word_of(size_t id)
{
    return id / NX * WORDS_ACROSS + id % NX / 32;
}

static status make(const void *source, const uint32_t *bits, struct rock *out)
{
    status st = OK;
    size_t n = 0;
    (void)source;
    for (size_t w = 0; w < WORDS_ACROSS * NY * NZ; w++)
        n += (size_t)__builtin_popcount(bits[w]);
    TRY(rock_alloc(out, n, STATE));
    n = 0;
    for (size_t id = 0; id < ALL; id++)
        if (bits[word_of(id)] >> id % NX % 32 & 1) {
            place(id, out->P + 4 * n);
            out->id[n++] = (uint32_t)id;
        }
done:
    return st;
}

/* Every `each`-th voxel has a particle, the others are deep. Positions, ids, and stress, which is the id. */
static void rock_of(size_t each, struct rock *rock, struct frame_deep *deep)
{
    *rock = (struct rock){0};
    *deep = (struct frame_deep){.voxels = {NX, NY, NZ}, .h = 1, .make = make};
    rock->P = calloc(4 * ALL, sizeof(float));
    rock->id = calloc(ALL, sizeof *rock->id);
    rock->stress = calloc(ALL, sizeof(float));
    deep->bits = calloc(WORDS_ACROSS * NY * NZ, sizeof *deep->bits);
    for (size_t v = 0; v < DEEP_VALUES; v++)
        deep->value[v] = calloc(ALL, sizeof(float));
    for (size_t id = 0; id < ALL; id++)
        if (id % each == 0) {
            place(id, rock->P + 4 * rock->n);
            rock->id[rock->n] = (uint32_t)id;
            rock->stress[rock->n++] = (float)id;
        } else {
            deep->bits[word_of(id)] |= 1U << id % NX % 32;
            deep->value[0][deep->n++] = (float)id;
        }
}

static void free_both(struct rock *rock, struct frame_deep *deep)
{
    rock_free(rock);
    free(deep->bits);
    for (size_t v = 0; v < DEEP_VALUES; v++)
        free(deep->value[v]);
}

/* Whole layers, each particle once, with its own values. */
static void check_pieces(const struct rock_pieces *pieces, size_t *sizes)
{
    uint8_t *seen = calloc(ALL, 1);
    size_t first = 0;
    for (size_t i = 0; i < pieces->n; i++) {
        struct rock piece;
        assert_ok(rock_piece(pieces, i, &piece));
        assert_true(piece.n <= PIECE_MAX && piece.n % (NX * NY) == 0);
        assert_null(piece.viability);
        for (size_t k = 0; k < piece.n; k++) {
            const size_t id = piece.id[k];
            float P[4];
            place(id, P);
            assert_true(id >= first && id < first + piece.n && !seen[id]);
            seen[id] = 1;
            assert_true(memcmp(P, piece.P + 4 * k, 3 * sizeof *P) == 0 && piece.stress[k] == (float)id);
        }
        sizes[i] = piece.n;
        first += piece.n;
        rock_piece_free(pieces, &piece);
    }
    assert_int_equal(first, ALL);
    free(seen);
}

static void pieces_do_not_depend_on_what_is_there(void **state)
{
    size_t expected[8] = {0};
    (void)state;
    for (size_t each = 1; each <= 3; each++) {
        struct rock rock;
        struct frame_deep deep;
        struct rock_pieces pieces;
        size_t sizes[8] = {0};
        rock_of(each, &rock, &deep);
        assert_ok(rock_pieces_begin(&rock, &deep, &pieces));
        assert_int_equal(pieces.n, 3);
        check_pieces(&pieces, each == 1 ? expected : sizes);
        if (each > 1)
            assert_memory_equal(sizes, expected, sizeof sizes);
        rock_pieces_end(&pieces);
        free_both(&rock, &deep);
    }
}

/* Rock in any order, of which nothing is deep, is cut by number; what fits into one piece is not copied. */
static void other_rock_is_cut_by_number(void **state)
{
    struct rock rock, piece;
    struct frame_deep deep;
    struct rock_pieces pieces;
    size_t sum = 0;
    (void)state;
    rock_of(1, &rock, &deep);
    rock.P[2] = NZ - 0.5F;
    assert_ok(rock_pieces_begin(&rock, &deep, &pieces));
    for (size_t i = 0; i < pieces.n; i++) {
        assert_ok(rock_piece(&pieces, i, &piece));
        assert_int_equal(piece.id[0], sum);
        sum += piece.n;
        rock_piece_free(&pieces, &piece);
    }
    assert_int_equal(sum, ALL);
    assert_int_equal(pieces.n, (ALL + PIECE_MAX - 1) / PIECE_MAX);
    rock_pieces_end(&pieces);

    rock.n = 1000;
    assert_ok(rock_pieces_begin(&rock, NULL, &pieces));
    assert_int_equal(pieces.n, 1);
    assert_ok(rock_piece(&pieces, 0, &piece));
    assert_ptr_equal(piece.P, rock.P);
    rock_piece_free(&pieces, &piece);
    rock_pieces_end(&pieces);
    rock.n = 0;
    assert_ok(rock_pieces_begin(&rock, NULL, &pieces));
    assert_int_equal(pieces.n, 1);
    rock_pieces_end(&pieces);
    free_both(&rock, &deep);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_do_not_depend_on_what_is_there),
        cmocka_unit_test(other_rock_is_cut_by_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
