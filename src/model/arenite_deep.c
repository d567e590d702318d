/* Deep rock without particles: creating them when they are due, showing it in frames, and saving it in checkpoints. */
#include "model/arenite_deep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geology/joints.h"
#include "model/edits.h"
#include "model/sections.h"
#include "particles/voxel_set.h"
#include "stress/places.h"

bool arenite_may_be_deep(const struct job *job)
{
    const bool material_points = job->stress.solver == STRESS_MPM;
    bool all =
        joints_part(job) || job->domain.particles == PARTICLES_ALL || collapse_shot(job) || material_points;
    for (size_t i = 0; i < job->n_edits && !all; i++) {
        const struct job *then = job->edits[i].set.job;
        all = then && (collapse_shot(then) || then->stress.solver == STRESS_MPM);
    }
    return !all;
}

/* Allocates one bit per voxel of the domain. */
static status alloc_bits(const struct arenite *a, uint32_t **bits)
{
    return memory_alloc(held_words(a->m.voxels), sizeof **bits, "bits of voxels", bits);
}

/* ---- creating particles */

/* Ensures capacity for `more` particles. If it must grow, the parts that depend on it are recreated; none of them holds state. */
static status reserve_particles(struct arenite *a, size_t more)
{
    status st = OK;
    const size_t n = a->particles.n + more;
    const bool rubble = a->blocks.rubble;
    if (n <= a->particles.n_max)
        return OK;
    TRY(particles_reserve(a->m.gpu, &a->particles, particles_capacity_for(n)));
    arenite_destroy_parts(a, LASTS_ROCK);
    TRY(arenite_create_parts(a, LASTS_ROCK));
    a->blocks.rubble = rubble;
done:
    return st;
}

/* Sets the stress of new particles to what they would have had since the last solution, because between solutions stress moves with
 * particles. */
static status find_stress(struct arenite *a, struct rock *rock)
{
    status st = OK;
    struct stress_places places = {0};
    if (a->elastic.lattice.n_active == 0)
        return OK;
    TRY(memory_alloc(rock->n, sizeof *rock->stress, "stress", &rock->stress));
    TRY(stress_places_begin(a->m.gpu, &a->elastic, &places));
    for (size_t first = 0, n; first < rock->n; first += n) {
        n = rock->n - first < PLACES_MOST ? rock->n - first : PLACES_MOST;
        TRY(stress_places_find(a->m.gpu, &places, rock->P + 4 * first, n));
        TRY(gpu_download(a->m.gpu, places.at.field[ROCK_stress], 0, rock->stress + first, n));
    }
done:
    stress_places_end(a->m.gpu, &places);
    return st;
}

status arenite_add_due(struct arenite *a, enum particles_due what, size_t n)
{
    status st = OK;
    struct particles *p = &a->particles;
    struct rock rock = {0};
    uint32_t *bits = NULL;
    if (p->n_deep == 0)
        return OK;
    TRY(alloc_bits(a, &bits));
    TRY(particles_due(a->m.gpu, a->m.work, p, what, bits, &n));
    if (n == 0)
        goto done;
    TRY(scene_source_particles(a->source, bits, NULL, &rock));
    TRY(find_stress(a, &rock));
    TRY(reserve_particles(a, rock.n));
    TRY(particles_add(a->m.gpu, a->m.work, p, &rock));
done:
    free(bits);
    rock_free(&rock);
    return st;
}

status arenite_add_at_cut(struct arenite *a, const struct field_cut *cut)
{
    status st = OK;
    struct particles *p = &a->particles;
    uint32_t *bits = NULL;
    const int across = (p->voxels[0] + 31) / 32;
    size_t n = 0;
    if (p->n_deep == 0)
        return OK;
    TRY(alloc_bits(a, &bits));
    TRY(particles_deep_bits(a->m.gpu, a->m.work, p, bits));
    for (size_t w = 0; w < held_words(p->voxels); w++) {
        const int row = (int)(w / (size_t)across);
        int v[3] = {0, row % p->voxels[1], row / p->voxels[1]};
        uint32_t near = 0;
        for (int b = 0; b < 32; b++) {
            v[0] = 32 * (int)(w % (size_t)across) + b;
            if (field_cut_near(cut, cut->axis, 0.5 * p->h, p->h, v[cut->axis], v[cut->axis]))
                near |= 1U << b;
        }
        bits[w] &= near;
        n += (size_t)__builtin_popcount(bits[w]);
    }
    if (n == 0)
        goto done;
    TRY(gpu_upload(a->m.gpu, p->flags, 0, bits, held_words(p->voxels)));
    TRY(arenite_add_due(a, DUE_CHOSEN, n));
    TRY(arenite_update_derived(a, true));
done:
    free(bits);
    return st;
}

/* ---- the start */

status arenite_first_rock(struct arenite *a, struct rock *rock, uint32_t **deep, size_t *n_deep)
{
    status st = OK;
    struct scene_source *source = NULL;
    *deep = NULL;
    *n_deep = 0;
    TRY(scene_source_create(a->m.whole, &source));
    if (arenite_may_be_deep(a->m.whole) && edits_of(a->m.whole, a->m.frame) != EDITS_ROCK) {
        TRY(alloc_bits(a, deep));
        scene_source_uniform(source, *deep, n_deep);
    }
    TRY(scene_source_particles(source, NULL, *deep, rock));
    if (*n_deep) {
        a->source = source;
        source = NULL;
    }
done:
    scene_source_destroy(&source);
    return st;
}

/* ---- frames that show all rock */

/* The fields from which erodibility is computed, besides stress; and the derived fields. */
static const enum rock_field given[] = {ROCK_layer, ROCK_phase, ROCK_rate_factor, ROCK_interlock_factor},
                             derived[DEEP_VALUES] = {ROCK_stress, ROCK_von_mises, ROCK_erodibility};
enum { GIVEN = sizeof given / sizeof *given };

/* Deep particles as they are shown: without plants, which live on the surface. */
static status make_deep(const void *source, const uint32_t *bits, struct rock *out)
{
    const status st = scene_source_particles(source, bits, NULL, out);
    for (size_t i = 0; st == OK && out->vegetation && i < out->n; i++)
        out->vegetation[i] = 0;
    return st;
}

/* Computes the derived values of the particles `from` and stores them for the deep voxels from number `first` on. */
static status derive(struct arenite *a, struct stress_places *places, const struct rock *from, size_t first,
                     struct frame_deep *deep)
{
    status st = OK;
    struct particles *some = &places->at;
    TRY(stress_places_find(a->m.gpu, places, from->P, from->n));
    for (size_t i = 0; i < GIVEN; i++)
        TRY(gpu_upload(a->m.gpu, some->field[given[i]], 0, from->field[given[i]], from->n));
    TRY(erosion_interlock(a->m.gpu, &a->erosion, a->m.job, a->m.frame, some));
    for (size_t v = 0; v < DEEP_VALUES; v++)
        TRY(gpu_download(a->m.gpu, some->field[derived[v]], 0, deep->value[v] + first, from->n));
done:
    return st;
}

/* Copies the next words of bits that have at most PLACES_MOST voxels together, at least one word, to `some`. *word is the first word, and
 * is advanced behind the last. */
static void take_words(const uint32_t *bits, size_t words, size_t *word, uint32_t *some)
{
    size_t n = 0;
    memset(some, 0, words * sizeof *some);
    for (; *word < words && n + 32 <= PLACES_MOST; ++*word) {
        some[*word] = bits[*word];
        n += (size_t)bits_in(bits[*word]);
    }
}

/* Creates the fields of `given`, and erodibility. */
static status add_fields(struct gpu *gpu, struct particles *some)
{
    status st = OK;
    for (size_t i = 0; i <= GIVEN; i++) {
        const enum rock_field f = i < GIVEN ? given[i] : ROCK_erodibility;
        TRY(gpu_buffer_create(gpu, rock_field_table[f].name, PLACES_MOST, rock_field_size(f),
                              &some->field[f]));
    }
done:
    return st;
}

static void remove_fields(struct gpu *gpu, struct particles *some)
{
    for (size_t i = 0; i <= GIVEN; i++)
        gpu_buffer_destroy(gpu, &some->field[i < GIVEN ? given[i] : ROCK_erodibility]);
}

static status derive_all(struct arenite *a, struct frame_deep *deep)
{
    status st = OK;
    const size_t words = held_words(a->m.voxels);
    struct stress_places places = {0};
    struct rock made = {0};
    uint32_t *next = NULL;
    size_t first = 0;
    TRY(alloc_bits(a, &next));
    TRY(stress_places_begin(a->m.gpu, &a->elastic, &places));
    TRY(add_fields(a->m.gpu, &places.at));
    for (size_t word = 0; word < words;) {
        take_words(deep->bits, words, &word, next);
        rock_free(&made);
        TRY(scene_source_particles(a->source, next, NULL, &made));
        if (made.n)
            TRY(derive(a, &places, &made, first, deep));
        first += made.n;
    }
done:
    free(next);
    rock_free(&made);
    remove_fields(a->m.gpu, &places.at);
    stress_places_end(a->m.gpu, &places);
    return st;
}

status arenite_show_deep(struct arenite *a, struct frame_deep *out)
{
    status st = OK;
    *out = (struct frame_deep){.h = a->m.h, .n = a->particles.n_deep, .source = a->source, .make = make_deep};
    memcpy(out->voxels, a->m.voxels, sizeof out->voxels);
    if (out->n == 0)
        return OK;
    TRY(alloc_bits(a, &out->bits));
    TRY(particles_deep_bits(a->m.gpu, a->m.work, &a->particles, out->bits));
    for (size_t v = 0; v < DEEP_VALUES; v++)
        TRY(memory_alloc(out->n, sizeof *out->value[v], "values deep inside", &out->value[v]));
    TRY(derive_all(a, out));
done:
    return st;
}

/* ---- checkpoints */

/* The bits of the deep voxels, and a fingerprint of their scene: its hash, and three numbers of each of a few particles. */
static const char deep_bits[] = "deep", deep_voxels[] = "deep voxels", deep_scene[] = "deep scene";
enum { FEW_NUMBERS = 3 };

static void few_numbers(const struct rock *few, size_t i, float out[FEW_NUMBERS])
{
    out[0] = (float)few->layer[i];
    out[1] = few->rate_factor[i];
    out[2] = few->interlock_factor[i];
}

status arenite_add_deep(const struct scene_source *source, const int voxels[3], struct checkpoint *out,
                        uint32_t **bits)
{
    status st = OK;
    struct rock few = {0};
    void *data;
    TRY(section_add(out, deep_bits, 4, held_words(voxels), &data));
    *bits = data;
    const uint64_t hash = scene_source_hash(source);
    TRY(section_add(out, deep_voxels, 8, 1, &data));
    memcpy(data, &hash, sizeof hash);
    TRY(scene_source_sample(source, &few));
    TRY(section_add(out, deep_scene, 4, FEW_NUMBERS * few.n, &data));
    for (size_t i = 0; i < few.n; i++)
        few_numbers(&few, i, (float *)data + FEW_NUMBERS * i);
done:
    rock_free(&few);
    return st;
}

status arenite_save_deep(struct arenite *a, struct checkpoint *out)
{
    status st = OK;
    uint32_t *bits;
    if (a->particles.n_deep == 0)
        return OK;
    TRY(arenite_add_deep(a->source, a->m.voxels, out, &bits));
    TRY(particles_deep_bits(a->m.gpu, a->m.work, &a->particles, bits));
done:
    return st;
}

/* Checks that the job's scene has the deep rock of the checkpoint. */
static status check_scene(const struct scene_source *source, const struct checkpoint *c)
{
    status st = OK;
    struct rock few = {0};
    const void *data;
    const char *differs = NULL;
    TRY(section_get(c, &(struct section_rule){deep_voxels, SECTION_INTEGER, 1, 1, {SECTION_ALL}}, &data,
                    NULL));
    if (*(const uint64_t *)data != scene_source_hash(source))
        differs = "shape";
    TRY(scene_source_sample(source, &few));
    const struct section_rule rule = {
        deep_scene, SECTION_FLOAT, SECTION_ANY, FEW_NUMBERS, {SECTION_ALL, SECTION_ALL, SECTION_ALL}};
    size_t n;
    TRY(section_get(c, &rule, &data, &n));
    for (size_t i = 0; i < few.n && !differs && n == FEW_NUMBERS * few.n; i++) {
        float own[FEW_NUMBERS];
        static const char *const names[FEW_NUMBERS] = {"strata", "noise, structure or painted rates",
                                                       "painted interlocking"};
        few_numbers(&few, i, own);
        for (size_t k = 0; k < FEW_NUMBERS && !differs; k++)
            if (fabs((double)(own[k] - ((const float *)data)[FEW_NUMBERS * i + k])) >
                1e-4 * fabs((double)own[k]))
                differs = names[k];
    }
    if (n != FEW_NUMBERS * few.n && !differs)
        differs = "shape";
    if (differs)
        st = fail(
            E_CHECKPOINT,
            "the checkpoint of frame %d has rock deep inside that is still to be made from its job's scene, and this job's scene differs in its %s; branch from a run with domain.particles: all",
            c->frame, differs);
done:
    rock_free(&few);
    return st;
}

/* Checks that the deep voxels are full rock of the scene and that no particle exists with one of their ids. */
static status check_bits(const struct scene_source *source, const struct checkpoint *c, const uint32_t *bits,
                         size_t n, struct idset *ids)
{
    status st = OK;
    uint32_t *id = NULL;
    TRY(memory_alloc(n, sizeof *id, "ids", &id));
    if (!scene_source_ids(source, bits, id)) {
        st = fail(
            E_CHECKPOINT,
            "the checkpoint of frame %d is damaged: section '%s' has voxels that are not full of rock in its scene",
            c->frame, deep_bits);
        goto done;
    }
    for (size_t i = 0; i < n; i++) {
        bool added;
        TRY(idset_add(ids, id[i], &added));
        if (!added) {
            st = fail(
                E_CHECKPOINT,
                "the checkpoint of frame %d is damaged: particle %u is in section 'id', and its voxel in section '%s'",
                c->frame, (unsigned)id[i], deep_bits);
            goto done;
        }
    }
done:
    free(id);
    return st;
}

size_t arenite_deep_count(const int voxels[3], const struct checkpoint *c)
{
    const struct checkpoint_section *s = checkpoint_find(c, deep_bits, 4);
    size_t n = 0;
    if (s && s->n == held_words(voxels))
        for (size_t i = 0; i < s->n; i++)
            n += (size_t)bits_in(((const uint32_t *)s->data)[i]);
    return n;
}

status arenite_read_deep(const struct scene_source *source, const int voxels[3], const struct checkpoint *c,
                         struct idset *ids, const uint32_t **bits)
{
    status st = OK;
    const struct section_rule rule = {deep_bits, SECTION_WORD, held_words(voxels), 1, {SECTION_ALL}};
    const void *data;
    TRY(section_get(c, &rule, &data, NULL));
    TRY(check_scene(source, c));
    TRY(check_bits(source, c, data, arenite_deep_count(voxels, c), ids));
    *bits = data;
done:
    return st;
}

status arenite_restore_deep(struct arenite *a, const struct checkpoint *c, struct idset *ids)
{
    status st = OK;
    const uint32_t *bits;
    if (!checkpoint_find(c, deep_bits, 4))
        return OK;
    TRY(scene_source_create(a->m.whole, &a->source));
    TRY(arenite_read_deep(a->source, a->m.voxels, c, ids, &bits));
    TRY(particles_set_deep(a->m.gpu, a->m.work, &a->particles, bits, arenite_deep_count(a->m.voxels, c)));
    if (!arenite_may_be_deep(a->m.whole))
        TRY(arenite_add_due(a, DUE_ALL, 0));
done:
    return st;
}
