/* Files while they are made: on disk they have the bytes that they have in memory, and what is given up leaves nothing. */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/random.h"
#include "system/atomic_file.h"

#include <cmocka.h> /* after ours: it has a macro fail() */

enum { LARGEST = 3 << 20, PARTS = 400 };

static uint32_t chance(uint32_t i, uint32_t what, uint32_t below)
{
    return random_hash(i, what, 7, 0) % below;
}

/* Appends and replaces at random, by pieces of a byte to 3 MB, the same in every draft. */
static void make(struct draft *d, const char *source)
{
    for (uint32_t i = 0; i < PARTS; i++) {
        const size_t n = i % 50 == 49 ? chance(i, 0, LARGEST) : chance(i, 0, 20000);
        assert_int_equal(draft_append(d, source + chance(i, 1, LARGEST), n), OK);
        const size_t old = d->size < 5000 ? (size_t)d->size : chance(i, 2, 5000);
        const uint64_t at =
            chance(i, 3, (uint32_t)(d->size - old + 1)); /* near the end as well as long before */
        assert_int_equal(draft_replace(d, i % 2 ? at : d->size - old, source + chance(i, 4, LARGEST), old),
                         OK);
    }
}

static void on_disk_as_in_memory(void **state)
{
    (void)state;
    char *source = malloc(2 * LARGEST);
    struct draft memory = {0}, disk;
    uint64_t hash, same, size;
    assert_non_null(source);
    for (uint32_t i = 0; i < 2 * LARGEST; i++)
        source[i] = (char)random_hash(i, 1, 2, 3);
    make(&memory, source);
    assert_int_equal(atomic_file_begin("draft", &disk), OK);
    make(&disk, source);
    assert_int_equal(disk.size, memory.size);
    assert_true(disk.room < LARGEST);
    for (uint32_t i = 0; i < 50; i++) {
        const uint64_t from = chance(i, 5, (uint32_t)disk.size),
                       to = from + chance(i, 6, (uint32_t)(disk.size - from));
        assert_int_equal(draft_hash(&disk, from, to, &hash), OK);
        assert_int_equal(draft_hash(&memory, from, to, &same), OK);
        assert_true(hash == same && hash == hash_bytes(memory.bytes + from, (size_t)(to - from)));
    }
    assert_int_not_equal(access("draft", F_OK), 0); /* not before it is finished */
    assert_int_equal(atomic_file_finish(&disk), OK);
    assert_int_equal(hash_file("draft", &hash, &size), OK);
    assert_true(size == memory.size && hash == hash_bytes(memory.bytes, (size_t)memory.size));
    draft_drop(&memory);
    draft_drop(&disk);
    free(source);
}

static int files_here(void)
{
    int n = 0;
    DIR *d = opendir(".");
    assert_non_null(d);
    while (readdir(d))
        n++;
    closedir(d);
    return n;
}

static void what_is_dropped_leaves_nothing(void **state)
{
    (void)state;
    struct draft d;
    const int before = files_here();
    assert_int_equal(atomic_file_begin("dropped", &d), OK);
    assert_int_equal(files_here(), before + 1);
    assert_int_equal(draft_append(&d, "some", 4), OK);
    draft_drop(&d);
    draft_drop(&d);
    assert_int_equal(files_here(), before);
    assert_int_equal(atomic_file_begin("no/such/folder", &d), E_OUTPUT);
    draft_drop(&d);
}

/* A file that is gone while it is made cannot be put into place. */
static void a_lost_file_is_an_error(void **state)
{
    (void)state;
    struct draft d;
    assert_int_equal(atomic_file_begin("lost", &d), OK);
    assert_int_equal(draft_append(&d, "some", 4), OK);
    unlink(d.temporary.text);
    assert_int_equal(atomic_file_finish(&d), E_OUTPUT);
    assert_non_null(strstr(status_message(), "lost"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_disk_as_in_memory),
        cmocka_unit_test(what_is_dropped_leaves_nothing),
        cmocka_unit_test(a_lost_file_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
