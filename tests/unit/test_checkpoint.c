/* Checkpoints: what goes in comes out; anything else is refused, with a reason, and without a crash. */
#include <errno.h>
#include <omp.h>
#include <sched.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/memory.h"
#include "checkpoint/checkpoint.h"
#include "checkpoint/chunk.h"
#include "checkpoint/layout.h"
#include "effort.h"
#include "system/atomic_file.h"
#include "text/json.h"

#include <cmocka.h> /* after ours: it has a macro fail() */

static char scratch[64];

static uint32_t next_random(uint32_t *x)
{
    *x ^= *x << 13;
    *x ^= *x >> 17;
    *x ^= *x << 5;
    return *x;
}

static void add(struct checkpoint *c, const char *name, size_t item, size_t n)
{
    struct checkpoint_section *s = &c->section[c->n_sections++];
    snprintf(s->name, sizeof s->name, "%s", name);
    s->item = item;
    s->n = n;
    assert_int_equal(memory_alloc(n, item, name, &s->data), OK);
}

/* A state of `n` particles: smooth floats, noise, an empty section, odd item sizes. Freed with
 * checkpoint_free(). */
static void make(struct checkpoint *c, int frame, size_t n)
{
    uint32_t x = 12345;
    *c = (struct checkpoint){.frame = frame, .years = 1e4 / 3, .job_hash = 0xfedcba9876543210u};
    strcpy(c->maker.version, "0.1.0");
    strcpy(c->maker.commit, "abc");
    strcpy(c->maker.device, "a \"device\" with \\ and \t and \xc3\xa9");
    strcpy(c->maker.driver, "driver 1.2");
    strcpy(c->maker.build, "00112233445566aa");
    add(c, "viability", 4, n);
    for (size_t i = 0; i < n; i++)
        ((float *)c->section[0].data)[i] = (float)i / 7.0f;
    add(c, "noise", 1, n);
    for (size_t i = 0; i < n; i++)
        ((unsigned char *)c->section[1].data)[i] = (unsigned char)next_random(&x);
    add(c, "empty", 8, 0);
    add(c, "matrix", 36, n / 9 + 1);
    memset(c->section[3].data, 0x3f, c->section[3].n * 36);
}

static void assert_same(const struct checkpoint *a, const struct checkpoint *b)
{
    assert_int_equal(a->frame, b->frame);
    assert_true(a->years == b->years);
    assert_true(a->job_hash == b->job_hash);
    assert_string_equal(a->maker.version, b->maker.version);
    assert_string_equal(a->maker.commit, b->maker.commit);
    assert_string_equal(a->maker.device, b->maker.device);
    assert_string_equal(a->maker.driver, b->maker.driver);
    assert_string_equal(a->maker.build, b->maker.build);
    assert_int_equal(a->n_sections, b->n_sections);
    for (size_t i = 0; i < a->n_sections; i++) {
        assert_string_equal(a->section[i].name, b->section[i].name);
        assert_int_equal(a->section[i].item, b->section[i].item);
        assert_int_equal(a->section[i].n, b->section[i].n);
        assert_memory_equal(a->section[i].data, b->section[i].data, a->section[i].n * a->section[i].item);
    }
}

static const char *in_scratch(const char *name)
{
    static char path[2][256];
    static int turn;
    turn = !turn;
    snprintf(path[turn], sizeof path[turn], "%s/%s", scratch, name);
    return path[turn];
}

static void put(const char *path, const void *bytes, size_t n)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, n, f), n);
    assert_int_equal(fclose(f), 0);
}

static status read_bytes(const void *bytes, size_t n)
{
    struct checkpoint c;
    const char *path = in_scratch("bytes");
    put(path, bytes, n);
    status st = checkpoint_read(path, &c);
    if (st == OK)
        checkpoint_free(&c);
    return st;
}

static unsigned char *encoded(size_t particles, size_t *size)
{
    struct checkpoint c;
    unsigned char *bytes;
    make(&c, 1010, particles);
    assert_int_equal(checkpoint_encode(&c, &bytes, size), OK);
    checkpoint_free(&c);
    return bytes;
}

/* ---- */

static void round_trip(void **state)
{
    (void)state;
    /* Below one chunk, exactly one, and several with a short last one. */
    static const size_t sizes[] = {1, 1000, CHUNK_RAW / 4, 3 * CHUNK_RAW / 4 + 5};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct checkpoint c, back;
        void *bytes;
        size_t size;
        make(&c, 1010, sizes[i]);
        assert_int_equal(checkpoint_encode(&c, &bytes, &size), OK);
        put(in_scratch("trip"), bytes, size);
        free(bytes);
        assert_int_equal(checkpoint_read(in_scratch("trip"), &back), OK);
        assert_same(&c, &back);
        assert_non_null(checkpoint_find(&back, "matrix", 36));
        assert_null(checkpoint_find(&back, "matrix", 4));
        assert_null(checkpoint_find(&back, "matri", 36));
        checkpoint_free(&back);

        assert_int_equal(checkpoint_read_index(in_scratch("trip"), &back), OK);
        assert_int_equal(back.n_sections, 4);
        assert_int_equal(back.section[0].n, sizes[i]);
        assert_null(back.section[0].data);
        checkpoint_free(&back);
        checkpoint_free(&c);
    }
}

static void same_bytes_for_any_number_of_threads(void **state)
{
    (void)state;
    size_t size[2];
    unsigned char *bytes[2];
    for (int i = 0; i < 2; i++) {
        omp_set_num_threads(i + 1);
        bytes[i] = encoded(3 * CHUNK_RAW, &size[i]);
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], size[0]);
    free(bytes[0]);
    free(bytes[1]);
}

static void refuses_every_truncation(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = encoded(200, &size);
    for (size_t n = 0; n < size; n++) {
        assert_int_equal(read_bytes(bytes, n), E_CHECKPOINT);
        assert_non_null(strstr(status_message(), "bytes"));
    }
    bytes = realloc(bytes, size + 1);
    bytes[size] = 0;
    assert_int_equal(read_bytes(bytes, size + 1), E_CHECKPOINT);
    assert_non_null(strstr(status_message(), "truncated or overwritten"));
    free(bytes);
}

static void refuses_every_flipped_byte(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = encoded(200, &size);
    assert_int_equal(read_bytes(bytes, size), OK);
    for (size_t i = 0; i < size; i++) {
        bytes[i] ^= (unsigned char)(1 << i % 8);
        assert_int_equal(read_bytes(bytes, size), E_CHECKPOINT);
        assert_non_null(strstr(status_message(), scratch));
        bytes[i] ^= (unsigned char)(1 << i % 8);
    }
    free(bytes);
}

/* ---- hostile: the hash is right */

static void seal(unsigned char *bytes, size_t size)
{
    struct file_end end;
    memcpy(&end, bytes + size - sizeof end, sizeof end);
    end.hash = hash_bytes(bytes, size - sizeof end);
    memcpy(bytes + size - sizeof end, &end, sizeof end);
}

/* A file of `body` (head and sections) with this index. */
static unsigned char *with_index(const unsigned char *body, size_t index_at, const char *index, size_t *size)
{
    size_t n = strlen(index);
    struct file_end end = {.index_at = index_at, .index_size = n};
    *size = index_at + n + sizeof end;
    unsigned char *bytes = malloc(*size);
    assert_non_null(bytes);
    memcpy(end.magic, end_magic, sizeof end.magic);
    memcpy(bytes, body, index_at);
    memcpy(bytes + index_at, index, n);
    memcpy(bytes + index_at + n, &end, sizeof end);
    seal(bytes, *size);
    return bytes;
}

static void refuses_a_lying_index(void **state)
{
    (void)state;
    static const struct {
        const char *find, *put, *says;
    } lies[] = {
        {"\"frame\": 1010", "\"frame\": 1e3", "'frame'"},
        {"\"frame\": 1010", "\"frame\": 99999999999999999999", "'frame'"},
        {"\"frame\": 1010,", "", "'frame'"},
        {"\"years\": ", "\"years\": 9e999, \"old\": ", "'years'"},
        {"fedcba9876543210", "fedcba987654321", "'job_hash'"},
        {"fedcba9876543210", "fedcba987654321X", "'job_hash'"},
        {"\"0.1.0\"", "\"0.1.0 0.1.0 0.1.0 0.1.0 0.1.0 0.1.0 0.1.0\"", "'version'"},
        {"\"driver 1.2\"", "12", "'driver'"},
        {"\"driver 1.2\"", "\"\\ud800\"", "unpaired surrogate"},
        {"\"driver 1.2\"", "\"\\u0000\"", "or NUL in a text"},
        {"\"name\": \"noise\"", "\"name\": \"viability\"", "two sections"},
        {"\"name\": \"noise\"", "\"name\": null", "'name'"},
        {"\"item\": 36", "\"item\": 0", "'item'"},
        {"\"item\": 36", "\"item\": 35", "cannot be unpacked"},
        {"\"item\": 36", "\"item\": 65537", "'item'"},
        {"\"item\": 36", "\"item\": -1", "'item'"},
        {"\"count\": 200", "\"count\": 0", "need 0 chunks"},
        {"\"count\": 200", "\"count\": 199", "cannot be unpacked"},
        {"\"count\": 200", "\"count\": 9223372036854775807", "'count'"},
        {"\"count\": 200", "\"count\": 2305843009213693951", "chunks"},
        {"\"chunks\": [\n        16", "\"chunks\": [\n        17", "not at byte 16"},
        {"\"chunks\": [\n        16", "\"chunks\": [\n        -16", "not at byte 16"},
        {"\"chunks\": [\n        16,\n", "\"chunks\": [\n        16, 9000000000, \n", "chunks"},
        {"\"chunks\": []", "\"chunks\": [16, 20]", "need 0 chunks"},
        {"\"chunks\": []", "\"chunks\": {}", "need 0 chunks"},
        {"\"sections\": [", "\"sections\": {\"a\": 1}, \"old\": [", "'sections'"},
        {"\"sections\": [", "\"sections\": [], \"old\": [", "do not belong to any section"},
        {"\"sections\": [", "\"sections\": [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
         "nested too deeply"},
        {"\"sections\": [", "\"sections\": [1,", "'name'"},
        {"{", "", "line 2, column 10"},
        {"{", "{{", "expected a key in quotes"},
    };
    size_t size;
    unsigned char *bytes = encoded(200, &size);
    struct file_end end;
    memcpy(&end, bytes + size - sizeof end, sizeof end);
    char *index = strndup((const char *)bytes + end.index_at, end.index_size);
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        const char *place = strstr(index, lies[i].find);
        assert_non_null(place);
        char *lie = NULL;
        assert_true(asprintf(&lie, "%.*s%s%s", (int)(place - index), index, lies[i].put,
                             place + strlen(lies[i].find)) > 0);
        size_t lying_size;
        unsigned char *lying = with_index(bytes, end.index_at, lie, &lying_size);
        status st = read_bytes(lying, lying_size);
        if (st != E_CHECKPOINT || !strstr(status_message(), lies[i].says))
            fail_msg("%s -> %s: %d, %s", lies[i].find, lies[i].put, (int)st, status_message());
        free(lying);
        free(lie);
    }
    free(index);
    free(bytes);
}

static void refuses_a_wrong_end(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = encoded(200, &size);
    struct file_end end, good;
    memcpy(&good, bytes + size - sizeof good, sizeof good);
    const uint64_t ends[][2] = {{good.index_at, UINT64_MAX},
                                {UINT64_MAX, good.index_size},
                                {UINT64_MAX - 100, 101 + size - sizeof good},
                                {0, size - sizeof good},
                                {good.index_at + 1, good.index_size - 1},
                                {size - sizeof good, 0},
                                {good.index_at - 1, good.index_size + 1}};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        end = good;
        end.index_at = ends[i][0];
        end.index_size = ends[i][1];
        memcpy(bytes + size - sizeof end, &end, sizeof end);
        assert_int_equal(read_bytes(bytes, size), E_CHECKPOINT);
    }
    memcpy(bytes + size - sizeof good, &good, sizeof good);
    bytes[12] = 2;
    seal(bytes, size);
    assert_int_equal(read_bytes(bytes, size), E_CHECKPOINT);
    assert_non_null(strstr(status_message(), "format 2; this version of hoodoo reads format 1"));
    free(bytes);

    struct checkpoint c;
    assert_int_equal(checkpoint_read(in_scratch("nothing here"), &c), E_CHECKPOINT);
    assert_int_equal(checkpoint_read(scratch, &c), E_CHECKPOINT);
    assert_int_equal(mkfifo(in_scratch("fifo"), 0600), 0);
    assert_int_equal(checkpoint_read(in_scratch("fifo"), &c), E_CHECKPOINT);
}

/* Many chunks of zeros: a small file that unpacks to more than there is memory. */
static void refuses_a_bomb_before_allocating(void **state)
{
    (void)state;
    /* More than the machine has at all: what is free changes under us. */
    size_t n = (size_t)sysconf(_SC_PHYS_PAGES) * (size_t)sysconf(_SC_PAGESIZE) / CHUNK_RAW * 2, size,
           at = sizeof(struct file_head);
    if (n > 60000)
        skip();
    void *zeros = calloc(2, CHUNK_RAW), *packed = malloc(chunk_bound(CHUNK_RAW));
    size_t k = chunk_pack(zeros, CHUNK_RAW, 1, (char *)zeros + CHUNK_RAW, packed);
    unsigned char *body = malloc(at + n * k), *seed = encoded(1, &size);
    struct text index = {0};
    text_add(&index,
             "{\"frame\":1,\"years\":0,\"job_hash\":\"0000000000000000\",\"version\":\"\",\"commit\":\"\","
             "\"device\":"
             "\"\",\"driver\":\"\",\"shaders\":\"\",\"sections\":[{\"name\":\"b\",\"item\":1,\"count\":%zu,"
             "\"hash\":\"0000000000000000\",\"chunks\":[",
             n * CHUNK_RAW);
    memcpy(body, seed, at);
    for (size_t i = 0; i < n; i++, at += k) {
        memcpy(body + at, packed, k);
        text_add(&index, "%s%zu,%zu", i ? "," : "", at, k);
    }
    text_add(&index, "]}]}");
    unsigned char *bomb = with_index(body, at, index.data, &size);
    assert_int_equal(read_bytes(bomb, size), E_MEMORY);
    free(bomb);
    text_free(&index);
    free(seed);
    free(body);
    free(packed);
    free(zeros);
}

/* Thousands of random edits behind a right hash: read or refused, but never a crash (run it under the
 * sanitizers). */
static void survives_mutation(void **state)
{
    (void)state;
    size_t size, read = 0;
    uint32_t x = 2463534242u;
    unsigned char *bytes = encoded(60, &size), *mutant = malloc(size);
    const size_t rounds = effort_of(3000);
    for (size_t round = 0; round < rounds; round++) {
        memcpy(mutant, bytes, size);
        size_t n = size;
        for (uint32_t edits = 1 + next_random(&x) % 4; edits > 0; edits--) {
            size_t at = next_random(&x) % (n - sizeof(struct file_end));
            size_t length = next_random(&x) % 16, from = next_random(&x) % (n - 16);
            if (edits % 2)
                mutant[at] = (unsigned char)next_random(&x);
            else if (at + length < n)
                memmove(mutant + at, mutant + from, length);
        }
        seal(mutant, n);
        status st = read_bytes(mutant, n);
        assert_true(st == OK || st == E_CHECKPOINT || st == E_MEMORY);
        read += st == OK;
    }
    /* Edits that change nothing, or only a name, are read. */
    assert_true(read < rounds / 2);
    free(mutant);
    free(bytes);
}

/* ---- the folder */

static void save(const char *root, int frame, int keep)
{
    struct checkpoint c;
    make(&c, frame, 50);
    assert_int_equal(checkpoint_save(root, "arch", &c, keep), OK);
    checkpoint_free(&c);
}

static void assert_frames(const char *root, const char *expected)
{
    int *frames;
    size_t n;
    struct text t = {0};
    assert_int_equal(checkpoint_list(root, "arch", &frames, &n), OK);
    for (size_t i = 0; i < n; i++)
        text_add(&t, "%s%d", i ? " " : "", frames[i]);
    assert_string_equal(t.data ? t.data : "", expected);
    text_free(&t);
    free(frames);
}

static void keeps_the_newest_and_the_marked(void **state)
{
    (void)state;
    const char *root = "folder";
    assert_frames(root, "");
    for (int frame = 10; frame <= 30; frame += 10)
        save(root, frame, 2);
    assert_frames(root, "30 20");
    put("folder/checkpoint/arch.0020.keep", "", 0);
    put("folder/checkpoint/arch.0025.ckpt.tmp-1-2-3", "", 0);
    put("folder/checkpoint/arch.25.ckpt", "", 0);
    put("folder/checkpoint/arch.0025.ckpt2", "", 0);
    put("folder/checkpoint/arch.x.ckpt", "", 0);
    put("folder/checkpoint/arch2.0025.ckpt", "", 0);
    for (int frame = 40; frame <= 60; frame += 10)
        save(root, frame, 2);
    assert_frames(root, "60 50 20");
    /* Started over: the new ones are not pruned in favour of those of the run before. */
    save(root, 10, 2);
    assert_frames(root, "60 50 20 10");
    save(root, 12, 2);
    save(root, 14, 2);
    assert_frames(root, "60 50 20 14 12");
    save(root, 123456, 1);
    assert_frames(root, "123456 20");
    save(root, -5, 1);
    assert_frames(root, "123456 20 -5");
    assert_int_equal(access("folder/checkpoint/arch2.0025.ckpt", F_OK), 0);
}

static void a_full_disk_leaves_the_older_ones(void **state)
{
    (void)state;
    assert_int_equal(mkdir("full", 0700), 0);
    if (geteuid() != 0 || unshare(CLONE_NEWNS) != 0 ||
        mount(NULL, "/", NULL, MS_REC | MS_PRIVATE, NULL) != 0 ||
        mount("none", "full", "tmpfs", 0, "size=256k") != 0)
        skip();
    save("full", 10, 2);
    save("full", 20, 2);
    struct checkpoint c;
    make(&c, 30, 400000);
    assert_int_equal(checkpoint_save("full", "arch", &c, 1), E_OUTPUT);
    assert_non_null(strstr(status_message(), strerror(ENOSPC)));
    checkpoint_free(&c);
    assert_frames("full", "20 10");
    assert_int_equal(checkpoint_read("full/checkpoint/arch.0020.ckpt", &c), OK);
    checkpoint_free(&c);
    save("full", 30, 2);
    assert_frames("full", "30 20");
    umount2("full", MNT_DETACH);
}

static void described_in_words(void **state)
{
    (void)state;
    struct text t = {0};
    struct json *json;
    save("words", 1010, 1);
    json_object(&t, NULL);
    assert_int_equal(checkpoint_describe("words/checkpoint/arch.1010.ckpt", &t), OK);
    json_end_object(&t);
    assert_int_equal(json_read(NULL, t.data, t.size, &json), OK);
    assert_int_equal(json_member(json, "sections")->n, 4);
    assert_string_equal(json_to_text(json_member(json, "device")),
                        "a \"device\" with \\ and \t and \xc3\xa9");
    json_free(&json);
    text_free(&t);
}

static int enter_scratch(void **state)
{
    (void)state;
    snprintf(scratch, sizeof scratch, "/tmp/hoodoo-checkpoint.XXXXXX");
    return mkdtemp(scratch) && chdir(scratch) == 0 ? 0 : -1;
}

static int leave_scratch(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", scratch);
    return chdir("/") == 0 && system(command) == 0 ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip),
        cmocka_unit_test(same_bytes_for_any_number_of_threads),
        cmocka_unit_test(refuses_every_truncation),
        cmocka_unit_test(refuses_every_flipped_byte),
        cmocka_unit_test(refuses_a_lying_index),
        cmocka_unit_test(refuses_a_wrong_end),
        cmocka_unit_test(refuses_a_bomb_before_allocating),
        cmocka_unit_test(survives_mutation),
        cmocka_unit_test(keeps_the_newest_and_the_marked),
        cmocka_unit_test(a_full_disk_leaves_the_older_ones),
        cmocka_unit_test(described_in_words),
    };
    return cmocka_run_group_tests(tests, enter_scratch, leave_scratch);
}
