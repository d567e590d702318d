/* A good job that uses every kind of key, and files made of text, for the tests of src/job. */
#ifndef HOODOO_TESTS_JOB_FILES_H
#define HOODOO_TESTS_JOB_FILES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Before cmocka, which makes a macro of fail(). */
#include "job/job.h"

#include <cmocka.h>

static const char good_job[] =
    "hoodoo: 1\n"
    "name: arch\n"
    "model: arenite\n"
    "frames: 1001-1110x2\n"
    "fps: 25\n"
    "seed: 7\n"
    "clock: {years_per_frame: 1000}\n"
    "domain: {size_m: [60, 24, 48], spacing_m: 0.5}\n"
    "rock: {density_kg_m3: 2.3e3, shear_GPa: 15}   # sandstone\n"
    "scene:\n"
    "  union:\n"
    "    - box: {min_m: [4, 4, 6], max_m: [56, 20, 46]}\n"
    "    - difference:\n"
    "        - sphere: {center_m: [9, 9, 9], radius_m: 4}\n"
    "        - cylinder: {from_m: [0, 0, 0], to_m: [0, 0, 9], radius_m: 1}\n"
    "      rotate_deg: [0, 0, 30]\n"
    "    - intersection:\n"
    "        - plane: {point_m: [0, 0, 9], normal: [0, 0, 1]}\n"
    "        - box: {min_m: [4, 4, 0], max_m: [16, 20, 6], inert: true}\n"
    "strata:\n"
    "  - {to_m: 36, weak_m_per_kyr: 0.20, strong_m_per_kyr: 0.002}\n"
    "  - to_m: 48\n"
    "    interlock_MPa: {1050: 0.5, 1001: 0.9, ease: step}\n"
    "noise: {amplitude: 0.15, scale_m: 14}\n"
    "paint:\n"
    "  - {shape: {sphere: {center_m: [1, 2, 3], radius_m: 2}}, erodibility: 2}\n"
    "wind: {direction: [0.8, 0.6, 0], speed_m_s: {1001: 10, 1060: 14, ease: smooth}}\n"
    "cameras:\n"
    "  main: {orbit: {target_m: [30, 12, 20], distance_m: 90}, resolution: [960, 540]}\n"
    "  top-2: {position_m: [0, 0, 99]}\n"
    "output:\n"
    "  {up: z, vdb: {codec: zip}, aov: {cameras: [main, top-2]}, owner: \"Zo\\u00eb\"}\n"
    "checkpoint: {every: 5, mark: [1040, 1051-1061x2]}\n"
    "sources:\n"
    "  - {path_m: [[5, 5, 40], [30, 12, 20]], bed_m: 2, m3_per_yr: {1001: 0, 1050: 10}}\n"
    "edits:\n"
    "  - frame: 1011\n"
    "    carve: {stroke: {path_m: [[1, 2, 3], [4, 5, 6]], radius_m: 2}}\n"
    "    add:\n"
    "      - {shape: {sphere: {center_m: [9, 9, 9], radius_m: 4}}, layer: 1}\n"
    "    paint:\n"
    "      - {noise: {scale_m: 3}, vegetation: 0.5}\n"
    "  - frame: 1041\n"
    "    set: {wind.speed_m_s: 14, 'strata[0].interlock_MPa': {1001: 2, 1050: 3}}\n";

static inline void write_bytes(const char *path, const char *bytes, size_t n)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, n, f), n);
    assert_int_equal(fclose(f), 0);
}

static inline status load_text(const char *text, struct job **job)
{
    write_bytes("job.yaml", text, strlen(text));
    return job_load("job.yaml", NULL, 0, job);
}

/* Loads what must load. */
static inline struct job *load_good(const char *text)
{
    struct job *job = NULL;
    status st = load_text(text, &job);
    if (st != OK)
        print_message("# %s\n", status_message());
    assert_int_equal(st, OK);
    return job;
}

static inline uint64_t hash_of(const struct job *job)
{
    uint64_t hash = 0;
    status st = job_hash(job, &hash);
    if (st != OK)
        print_message("# %s\n", status_message());
    assert_int_equal(st, OK);
    return hash;
}

static inline uint64_t hash_of_text(const char *text)
{
    struct job *job = load_good(text);
    uint64_t hash = hash_of(job);
    job_destroy(&job);
    return hash;
}

static inline uint64_t files_hash_of_text(const char *text)
{
    struct job *job = load_good(text);
    uint64_t hash = 0;
    assert_int_equal(job_files_hash(job, &hash), OK);
    job_destroy(&job);
    return hash;
}

/* `text` with its first `from` replaced by `to`; freed with free(). */
static inline char *swapped(const char *text, const char *from, const char *to)
{
    const char *at = strstr(text, from);
    assert_non_null(at);
    size_t n = strlen(text) + strlen(to) + 1;
    char *out = malloc(n);
    assert_non_null(out);
    snprintf(out, n, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    return out;
}

#endif
