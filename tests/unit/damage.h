/* Damaged copies of a file: every reader has to refuse them and stay alive. */
#ifndef HOODOO_DAMAGE_H
#define HOODOO_DAMAGE_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "effort.h"
#include "system/atomic_file.h"

typedef status damage_check(const char *path);

/* Writes without fsync: there are many of these. */
static inline void damage_put(const char *path, const char *bytes, size_t n)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, n, f), n);
    assert_int_equal(fclose(f), 0);
}

static inline uint32_t damage_random(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static inline char *damage_read(const char *path, size_t *n)
{
    char *bytes = NULL;
    assert_int_equal(file_read(path, 1 << 30, &bytes, n), OK);
    return bytes;
}

/* The file cut to `cuts` lengths, from nothing to all but its last byte. Of these, as of what follows, there are as many
 * as is worth the effort (effort.h). */
static inline void damage_truncate(const char *path, damage_check *check, size_t cuts)
{
    size_t n;
    char *bytes = damage_read(path, &n);
    cuts = effort_of(cuts);
    for (size_t k = 0; k <= cuts; k++) {
        const size_t length = k == cuts ? n - 1 : (n - 1) / cuts * k;
        damage_put("truncated", bytes, length);
        if (check("truncated") != E_INPUT) {
            print_error("%s cut to %zu of %zu bytes passed\n", path, length, n);
            assert_true(false);
        }
    }
    free(bytes);
}

/* One flipped bit a try, spread over the file, and in each of its first bytes. */
static inline void damage_flip(const char *path, damage_check *check, size_t tries)
{
    size_t n;
    uint32_t state = 1;
    char *bytes = damage_read(path, &n);
    tries = effort_of(tries);
    for (size_t k = 0; k < tries; k++) {
        const size_t at = k < tries / 2 ? k % n : (size_t)damage_random(&state) % n;
        const char bit = (char)(1 << damage_random(&state) % 8);
        bytes[at] ^= bit;
        damage_put("flipped", bytes, n);
        if (check("flipped") != E_INPUT) {
            print_error("%s with bit 0x%02x of byte %zu flipped passed\n", path, (unsigned char)bit, at);
            assert_true(false);
        }
        bytes[at] ^= bit;
    }
    free(bytes);
}

/* Many bytes changed at once, without what hoodoo signs its files with, so that the library sees them. Any
 * answer will do. */
static inline void damage_fuzz(const char *path, damage_check *check, size_t tries)
{
    static const unsigned char nasty[] = {0x00, 0xff, 0x7f, 0x80, 0x01, 0xfe};
    size_t n, refused = 0;
    uint32_t state = 7;
    char *bytes = damage_read(path, &n), *copy = malloc(n);
    assert_non_null(copy);
    tries = effort_of(tries);
    for (char *c = bytes; (c = memmem(c, n - (size_t)(c - bytes), "hoodoo", 6)); c += 6)
        memcpy(c, "xxdoxx", 6);
    for (size_t k = 0; k < tries; k++) {
        memcpy(copy, bytes, n);
        const size_t range = k % 3 == 0 ? n : k % 3 == 1 ? 4096 : 512;
        for (uint32_t i = 0; i <= damage_random(&state) % 8; i++) {
            const size_t at = damage_random(&state) % (range < n ? range : n);
            copy[at] = (char)(i % 2 ? damage_random(&state) : nasty[damage_random(&state) % sizeof nasty]);
        }
        damage_put("fuzzed", copy, n);
        const status st = check("fuzzed");
        assert_true(st == OK || st == E_INPUT);
        refused += st == E_INPUT;
    }
    print_message("# %s: %zu of %zu mutations refused\n", path, refused, tries);
    free(copy);
    free(bytes);
}

#endif
