#include "model/collapse.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/log.h"
#include "base/memory.h"
#include "model/sections.h"

/* Particles in two grid cells. Material points cannot represent the shape of a smaller body. */
static const double BODY = 16;

bool collapse_shot(const struct job *job)
{
    return job->clock.seconds_per_frame > 0;
}

bool collapse_wanted(const struct job *job)
{
    return collapse_shot(job) || job->collapse.blocks == COLLAPSE_FALL;
}

uint64_t collapse_checkpoint_bytes(const struct job *job, size_t n)
{
    /* About half is saved by compression: the unused fourth components, and points at rest. */
    return collapse_shot(job) ? (uint64_t)n * (MPM_VECTORS * 16 + MPM_ORIGIN * 4) / 2 : 0;
}

uint64_t collapse_bytes(const struct job *job, size_t n, const int voxels[3])
{
    return collapse_wanted(job)
               ? mpm_bytes(n, voxels, job->domain.spacing_m, job->collapse.joints_m) + (4 + 16) * (uint64_t)n
               : 0;
}

/* *n: the largest id plus 1. */
static status count_ids(struct gpu *gpu, const struct particles *p, size_t *n)
{
    status st = OK;
    uint32_t *ids = NULL;
    *n = 1;
    TRY(memory_alloc(p->n, sizeof *ids, "ids", &ids));
    TRY(gpu_download(gpu, p->field[ROCK_id], 0, ids, p->n));
    for (size_t i = 0; i < p->n; i++)
        if (ids[i] >= *n)
            *n = (size_t)ids[i] + 1;
done:
    free(ids);
    return st;
}

status collapse_create(struct gpu *gpu, const struct job *job, struct particles *p, struct collapse *c)
{
    status st = OK;
    size_t n_ids;
    const struct job_collapse *j = &job->collapse;
    struct mpm_options options = {
        .lambda = 1e9 * job->rock.lame_GPa,
        .mu = 1e9 * job->rock.shear_GPa,
        .density = job->rock.density_kg_m3,
        .gravity = job->rock.gravity_m_s2,
        .cfl = j->cfl,
        .viscosity = j->viscosity,
        .rebound = j->rebound,
        .friction = j->friction,
        .repose_deg = j->repose_deg,
        .strength = 1e6 * j->strength_MPa,
        .block = j->joints_m,
        .joint = j->joint_strength,
        .seed = (uint32_t)job->seed,
        .lift = 0.75,
        .played = job->clock.seconds_per_frame * job->fps,
        .walls = job_walls(job),
    };
    *c = (struct collapse){.shot = collapse_shot(job),
                           .falls = j->blocks == COLLAPSE_FALL,
                           .longest = j->longest_s,
                           .rubble = j->rubble_m,
                           .least = (size_t)fmax(BODY, ceil(pow(j->rubble_m / p->h, 3)))};
    if (!collapse_wanted(job))
        return OK;
    mpm_soften(&options, j->wave_m_s);
    TRY(particles_allow_motion(gpu, p));
    TRY(mpm_create(gpu, p->voxels, p->h, p->n_max, &options, &c->mpm));
    if (c->shot) {
        TRY(count_ids(gpu, p, &n_ids));
        TRY(gpu_buffer_create(gpu, "particles by id", n_ids, 4, &c->table));
    }
done:
    if (st != OK)
        collapse_destroy(gpu, c);
    return st;
}

void collapse_destroy(struct gpu *gpu, struct collapse *c)
{
    mpm_destroy(gpu, &c->mpm);
    gpu_buffer_destroy(gpu, &c->table);
}

status collapse_count(struct gpu *gpu, const struct particles *p, struct ledger *ledger)
{
    status st = OK;
    uint32_t *phase = NULL;
    uint64_t n[3] = {0}, gone = ledger->start - ledger->left - p->n - p->n_deep;
    TRY(memory_alloc(p->n, sizeof *phase, "phases", &phase));
    TRY(gpu_download(gpu, p->field[ROCK_phase], 0, phase, p->n));
    for (size_t i = 0; i < p->n; i++)
        n[phase[i] <= PHASE_FALLING ? phase[i] : PHASE_ROCK]++;
    ledger->rock = n[PHASE_ROCK] + p->n_deep;
    ledger->deposit = n[PHASE_DEPOSIT];
    ledger->fallen = gone + n[PHASE_FALLING];
done:
    free(phase);
    return st;
}

/* ---- shots */

status collapse_load(struct gpu *gpu, struct collapse *c, struct particles *p)
{
    struct count_params all = {(uint)p->n};
    /* Loading removes viability from p, so a copy is kept in scratch memory. */
    GPU_RUN(gpu, gpu_iota, p->n, all, p->flags);
    gpu_copy(gpu, c->mpm.speed, p->field[ROCK_viability], p->n);
    mpm_load(gpu, &c->mpm, p, p->flags, p->n);
    gpu_copy(gpu, p->field[ROCK_viability], c->mpm.speed, p->n);
    p->moving = true;
    return gpu_wait(gpu);
}

status collapse_frame(struct gpu *gpu, struct gpu_work *work, struct collapse *c, double seconds,
                      struct particles *p, struct ledger *ledger)
{
    status st = OK;
    size_t before = p->n;
    gpu_fill(gpu, p->field[ROCK_viability], 0);
    TRY(mpm_run(gpu, work, &c->mpm, seconds));
    mpm_store(gpu, &c->mpm, p, true);
    TRY(particles_index(gpu, work, p));
    mpm_follow(gpu, &c->mpm, p, c->table);
    mpm_store(gpu, &c->mpm, p, true); /* velocity and stress, which indexing does not move along */
    ledger->left += before - p->n;
    TRY(collapse_count(gpu, p, ledger));
done:
    return st;
}

status collapse_save(struct gpu *gpu, const struct collapse *c, struct checkpoint *out)
{
    status st = OK;
    const struct mpm *m = &c->mpm;
    void *data;
    for (int v = 0; v < MPM_VECTORS; v++) {
        TRY(section_add(out, mpm_vector_names[v], 4, 4 * m->n, &data));
        TRY(gpu_download(gpu, m->vector[v], 0, data, m->n));
    }
    for (int w = 0; w < MPM_ORIGIN; w++) {
        TRY(section_add(out, mpm_word_names[w], 4, m->n, &data));
        TRY(gpu_download(gpu, m->word[w], 0, data, m->n));
    }
    TRY(section_add(out, "mpm fastest", 8, 1, &data));
    *(double *)data = m->fastest;
done:
    return st;
}

/* The largest speed, spin, strain and strength; larger numbers are damage. */
static const double SPEED = 1e4, SPIN = 1e9, STRAIN = 1e4, STRENGTH = 1e15;

/* Sets the four ranges of a vector whose last component belongs to another quantity. */
static void set_ranges(struct section_rule *rule, double most, double last)
{
    for (int a = 0; a < 4; a++) {
        rule->range[a][1] = a < 3 ? most : last;
        rule->range[a][0] = -rule->range[a][1];
    }
}

static status take_vector(const struct checkpoint *from, const struct particles *p, int v, const void **data)
{
    struct section_rule rule = {mpm_vector_names[v], SECTION_FLOAT, 4 * p->n, 4, {{0}}};
    bool strain = v == MPM_STRETCH_X || v == MPM_STRETCH_Y;
    set_ranges(&rule, strain ? STRAIN : v == MPM_VELOCITY ? SPEED : SPIN, strain ? STRAIN : SPIN);
    if (v == MPM_PLACE) {
        section_place(rule.range, p->voxels, p->h);
        rule.range[3][1] = STRAIN;
        rule.range[3][0] = -STRAIN;
    }
    return section_get(from, &rule, data, NULL);
}

static status take_word(const struct checkpoint *from, const struct particles *p, int w, const void **data)
{
    static const struct {
        enum section_kind kind;
        double range[2];
    } known[MPM_ORIGIN] = {
        [MPM_SHARE] = {SECTION_FLOAT, {FLT_TRUE_MIN, 1}}, /* empty points were removed before saving */
        [MPM_APART] = {SECTION_FLOAT, {(double)MPM_WHOLE, SPIN}},
        [MPM_STRENGTH] = {SECTION_FLOAT, {0, STRENGTH}},
        [MPM_ID] = {SECTION_WORD, SECTION_ALL},
        [MPM_PIECE] = {SECTION_WORD, SECTION_ALL},
        [MPM_JOINT] = {SECTION_WORD, SECTION_ALL},
    };
    struct section_rule rule = {
        mpm_word_names[w], known[w].kind, p->n, 1, {{known[w].range[0], known[w].range[1]}}};
    return section_get(from, &rule, data, NULL);
}

/* Checks that points and particles correspond by id, and that this job has their pieces and joints. */
static status check_points(const struct checkpoint *from, const struct mpm *m, struct idset *ids,
                           const void *const word[MPM_ORIGIN])
{
    const uint32_t *id = word[MPM_ID], *piece = word[MPM_PIECE], *joint = word[MPM_JOINT];
    for (size_t i = 0; i < m->n; i++) {
        if (!idset_remove(ids, id[i]))
            return section_refuse(from, mpm_word_names[MPM_ID], i,
                                  "is %u, which is not the id of a particle, or another point has it",
                                  (unsigned)id[i]);
        if (!mpm_piece_fits(m, piece[i]))
            return section_refuse(from, mpm_word_names[MPM_PIECE], i,
                                  "is %u, but this job's collapse.joints_m does not make such a piece",
                                  (unsigned)piece[i]);
        if (!mpm_joint_fits(m, piece[i], joint[i]))
            return section_refuse(
                from, mpm_word_names[MPM_JOINT], i,
                "is %u, but with this job's collapse.joints_m, piece %u does not have such a joint",
                (unsigned)joint[i], (unsigned)piece[i]);
    }
    return OK;
}

status collapse_restore(struct gpu *gpu, struct collapse *c, struct particles *p,
                        const struct checkpoint *from, struct idset *ids)
{
    status st = OK;
    struct mpm *m = &c->mpm;
    const void *data, *word[MPM_ORIGIN];
    m->n = p->n;
    p->moving = true;
    for (int v = 0; v < MPM_VECTORS; v++) {
        TRY(take_vector(from, p, v, &data));
        TRY(gpu_upload(gpu, m->vector[v], 0, data, m->n));
    }
    for (int w = 0; w < MPM_ORIGIN; w++)
        TRY(take_word(from, p, w, &word[w]));
    TRY(check_points(from, m, ids, word));
    for (int w = 0; w < MPM_ORIGIN; w++)
        TRY(gpu_upload(gpu, m->word[w], 0, word[w], m->n));
    TRY(section_get(from, &(struct section_rule){"mpm fastest", SECTION_DOUBLE, 1, 1, {{0, 2 * SPEED}}},
                    &data, NULL));
    m->fastest = *(const double *)data;
    mpm_follow(gpu, m, p, c->table);
    mpm_store(gpu, m, p, true);
done:
    return st;
}

/* ---- blocks within a frame */

/* Simulates until almost nothing has moved in REST consecutive checks, which are a tenth of a second apart. A released body is faster than
 * `still` at the first check. Grains may creep for long; what still moves when everything else rests continues in the next frame. */
static status fall_to_rest(struct gpu *gpu, struct gpu_work *work, struct collapse *c, double *seconds)
{
    enum { REST = 3 };
    const double look = 0.1, still = 0.05 * sqrt(c->mpm.options.gravity * c->mpm.dx);
    status st = OK;
    int at_rest = 0;
    for (*seconds = 0; at_rest < REST && *seconds < c->longest && c->mpm.n > 0; *seconds += look) {
        TRY(mpm_run(gpu, work, &c->mpm, look));
        bool rests = c->mpm.fastest < still || c->mpm.mean_speed < still / 4;
        at_rest = rests ? at_rest + 1 : 0;
    }
done:
    return st;
}

status collapse_crumble(struct gpu *gpu, struct gpu_work *work, const struct collapse *c, struct blocks *b,
                        struct particles *p, uint32_t *n_fragments, size_t *n_loose)
{
    return blocks_loose(gpu, work, b, p, c->least, n_fragments, n_loose);
}

status collapse_blocks(struct gpu *gpu, struct gpu_work *work, struct collapse *c, struct blocks *b,
                       struct particles *p, struct ledger *ledger)
{
    status st = OK;
    size_t n, n_cut, before = p->n;
    uint32_t crumbled = 0, more = 0;
    double seconds = 0;
    TRY(collapse_crumble(gpu, work, c, b, p, &crumbled, &n));
    if (n == 0 && crumbled == 0)
        return OK;
    if (n > 0) {
        mpm_load(gpu, &c->mpm, p, p->surface, n);
        mpm_obstacle(gpu, &c->mpm, p);
        TRY(fall_to_rest(gpu, work, c, &seconds));
        mpm_store(gpu, &c->mpm, p, false);
        TRY(mpm_classify(gpu, &c->mpm, p, c->rubble));
        mpm_obstacle(gpu, &c->mpm, NULL);
        gpu_fill(gpu, p->field[ROCK_v], 0);
        TRY(particles_index(gpu, work, p));
        TRY(blocks_find(gpu, work, b, p, &n_cut));
        TRY(blocks_fall(gpu, work, b, p, &more));
    }
    if (crumbled + more > 0)
        TRY(particles_index(gpu, work, p));
    ledger->left += before - p->n;
    TRY(collapse_count(gpu, p, ledger));
    if (n > 0)
        log_note("a fall of %zu particles took %.1f s; %zu were removed, %u of them as small fragments", n,
                 seconds, before - p->n, (unsigned)(crumbled + more));
done:
    return st;
}
