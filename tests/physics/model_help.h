/* A model driven without a folder: a job from text, its frames, its rock. */
#ifndef HOODOO_TESTS_MODEL_HELP_H
#define HOODOO_TESTS_MODEL_HELP_H

#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "model/model.h"

struct sim {
    struct gpu *gpu;
    struct job *job;
    struct model *model;
};

/* The job of a file, with `sets` as --set gives them. All of its rock has particles, so that frames have them by id. */
static inline struct sim sim_open(const char *path, const char *const *sets, size_t n_sets)
{
    struct sim s = {0};
    const char *all[16] = {"domain.particles=all"};
    assert_true(n_sets < 16);
    for (size_t i = 0; i < n_sets; i++)
        all[i + 1] = sets[i];
    assert_ok(job_load(path, all, n_sets + 1, &s.job));
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &s.gpu));
    assert_ok(model_create(s.gpu, s.job, NULL, &s.model));
    return s;
}

/* The job in a text. */
static inline struct sim sim_begin(const char *text)
{
    char path[] = "/tmp/hoodoo-job.XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    FILE *f = fdopen(file, "w");
    assert_non_null(f);
    assert_true(fputs(text, f) >= 0);
    assert_int_equal(fclose(f), 0);
    struct sim s = sim_open(path, NULL, 0);
    unlink(path);
    return s;
}

static inline void sim_end(struct sim *s)
{
    model_destroy(&s->model);
    gpu_destroy(&s->gpu);
    job_destroy(&s->job);
}

static inline struct frame sim_output(struct sim *s)
{
    struct frame frame;
    assert_ok(model_output(s->model, &frame));
    return frame;
}

/* Two states are the same, bit for bit. */
static inline void assert_same_state(const struct checkpoint *a, const struct checkpoint *b)
{
    assert_int_equal(a->n_sections, b->n_sections);
    for (size_t i = 0; i < a->n_sections; i++) {
        assert_string_equal(a->section[i].name, b->section[i].name);
        assert_int_equal(a->section[i].n, b->section[i].n);
        assert_memory_equal(a->section[i].data, b->section[i].data, a->section[i].n * a->section[i].item);
    }
}

/* Viability by id, before the first particle was lost: 0 for those that are gone. */
static inline float *viability_by_id(const struct rock *rock, size_t n_ids)
{
    float *by_id = calloc(n_ids, sizeof *by_id);
    assert_non_null(by_id);
    for (size_t i = 0; i < rock->n; i++) {
        assert_true(rock->id[i] < n_ids);
        by_id[rock->id[i]] = rock->viability[i];
    }
    return by_id;
}

#endif
