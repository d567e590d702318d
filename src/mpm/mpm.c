#include "mpm/mpm.h"

#include <math.h>

#include "mpm/internal.h"

const char *const mpm_vector_names[MPM_VECTORS] = {"mpm place",    "mpm velocity",  "mpm affine x",
                                                   "mpm affine y", "mpm stretch x", "mpm stretch y"};
const char *const mpm_word_names[MPM_WORDS] = {"mpm share", "mpm apart", "mpm strength", "mpm id",
                                               "mpm piece", "mpm joint", "mpm origin"};

void mpm_soften(struct mpm_options *o, double speed)
{
    double share = speed * speed / (mpm_wave(o) * mpm_wave(o));
    if (share < 1) {
        o->lambda *= share;
        o->mu *= share;
    }
}

double mpm_wave(const struct mpm_options *o)
{
    return sqrt((o->lambda + 2 * o->mu) / o->density);
}

size_t mpm_nodes(const int voxels[3])
{
    return (size_t)(voxels[0] / 2 + 3) * (size_t)(voxels[1] / 2 + 3) * (size_t)(voxels[2] / 2 + 3);
}

uint64_t mpm_bytes(size_t n_max, const int voxels[3], double h, double block)
{
    /* Parts are about n_max / 8 for full cells; more are cut by the surface. */
    return (uint64_t)n_max * ((MPM_VECTORS + 1) * 16 + (MPM_WORDS + 10) * 4) +
           (uint64_t)mpm_nodes(voxels) * (16 + 9 * 4) + (uint64_t)held_words(voxels) * 4 +
           (uint64_t)n_max / 4 * (27 * 20 + 40) + mpm_pieces_bytes(voxels, h, block);
}

status mpm_create(struct gpu *gpu, const int voxels[3], double h, size_t n_max,
                  const struct mpm_options *options, struct mpm *m)
{
    status st = OK;
    *m = (struct mpm){.cells = {voxels[0] / 2, voxels[1] / 2, voxels[2] / 2},
                      .dx = 2 * h,
                      .options = *options,
                      .n_max = n_max};
    size_t nodes = mpm_nodes(voxels);
    for (int v = 0; v < MPM_VECTORS; v++)
        TRY(gpu_buffer_create(gpu, mpm_vector_names[v], n_max, 16, &m->vector[v]));
    for (int w = 0; w < MPM_WORDS; w++)
        TRY(gpu_buffer_create(gpu, mpm_word_names[w], n_max, 4, &m->word[w]));
    const struct {
        const char *name;
        size_t n, item;
        struct gpu_buffer **out;
    } buffer[] = {
        {"mpm home", n_max, 4, &m->home},
        {"mpm parts", n_max, 4, &m->part},
        {"mpm groups", n_max, 4, &m->group},
        {"mpm speed", n_max, 4, &m->speed},
        {"mpm spare vectors", n_max, 16, &m->spare_vector},
        {"mpm spare words", n_max, 4, &m->spare_word},
        {"mpm order", n_max, 4, &m->order},
        {"mpm unordered", n_max, 4, &m->unordered},
        {"mpm first of part", n_max + 1, 4, &m->part_first},
        {"mpm cell of part", n_max, 4, &m->part_cell},
        {"mpm body of part", n_max, 4, &m->part_body},
        {"mpm cell start", nodes + 2, 4, &m->start},
        {"mpm flags", nodes + 1, 4, &m->flags},
        {"mpm places", nodes + 1, 4, &m->place},
        {"mpm nodes", nodes, 4, &m->node_list},
        {"mpm mixed nodes", nodes, 4, &m->mixed},
        {"mpm cell slot", nodes, 4, &m->slot},
        {"mpm parts of cell", nodes, 4, &m->many},
        {"mpm first entry", nodes, 4, &m->first},
        {"mpm bodies of node", nodes, 4, &m->meeting},
        {"mpm walls", nodes, 16, &m->wall},
        {"mpm products", nodes > n_max ? nodes : n_max, 4, &m->product},
        {"mpm scalars", SCALARS, 4, &m->scalars},
        {"mpm resting rock", held_words(voxels), 4, &m->full},
    };
    for (size_t i = 0; i < sizeof buffer / sizeof *buffer; i++)
        TRY(gpu_buffer_create(gpu, buffer[i].name, buffer[i].n, buffer[i].item, buffer[i].out));
    TRY(mpm_pieces_create(gpu, m));
done:
    if (st != OK)
        mpm_destroy(gpu, m);
    return st;
}

void mpm_destroy(struct gpu *gpu, struct mpm *m)
{
    struct gpu_buffer **all[] = {
        &m->home,       &m->part,        &m->group,      &m->speed,     &m->spare_vector, &m->spare_word,
        &m->order,      &m->unordered,   &m->part_first, &m->part_cell, &m->part_body,    &m->start,
        &m->flags,      &m->place,       &m->node_list,  &m->mixed,     &m->slot,         &m->many,
        &m->first,      &m->meeting,     &m->wall,       &m->partial,   &m->reach,        &m->entry_node,
        &m->entry_body, &m->entry_group, &m->mass,       &m->velocity,  &m->product,      &m->scalars,
        &m->full};
    mpm_pieces_destroy(gpu, m);
    for (int v = 0; v < MPM_VECTORS; v++)
        gpu_buffer_destroy(gpu, &m->vector[v]);
    for (int w = 0; w < MPM_WORDS; w++)
        gpu_buffer_destroy(gpu, &m->word[w]);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(gpu, all[i]);
    *m = (struct mpm){0};
}

struct mpm_params mpm_params_of(const struct mpm *m, size_t n, double dt)
{
    const struct mpm_options *o = &m->options;
    double sine = sin(o->repose_deg * 3.14159265358979323846 / 180);
    return (struct mpm_params){
        .n = (uint)n,
        .cx = (uint)m->cells[0],
        .cy = (uint)m->cells[1],
        .cz = (uint)m->cells[2],
        .n_parts = (uint)m->n_parts,
        .bodies = m->pieces.n[0] > 0,
        .rock = m->resting != NULL,
        .dx = (float)m->dx,
        .dt = (float)dt,
        .lambda = (float)o->lambda,
        .mu = (float)o->mu,
        .viscosity = (float)(o->viscosity * o->density * mpm_wave(o) * m->dx),
        .push = (float)(4 / (o->density * m->dx * m->dx)),
        .mass = (float)(o->density * pow(m->dx / 2, 3)),
        .gravity = (float)o->gravity,
        .friction = (float)o->friction,
        .alpha = (float)(sqrt(2.0 / 3) * 2 * sine / (3 - sine)),
        .fastest = 1e30f,
        .played = o->played > 0 ? (float)o->played : 1,
        .lift = (float)o->lift,
        .rebound = (float)o->rebound,
        .full = (float)(o->density * pow(m->dx, 3)),
        .walls = o->walls,
    };
}

void mpm_load(struct gpu *gpu, struct mpm *m, struct particles *p, struct gpu_buffer *list, size_t n)
{
    struct mpm_load_params k = mpm_load_params_of(m, n);
    m->n = n;
    m->n_left = 0;
    m->fastest = 0;
    for (int v = MPM_VELOCITY; v < MPM_VECTORS; v++)
        gpu_fill(gpu, m->vector[v], 0);
    GPU_RUN(gpu, mpm_load, n, k, list, p->field[ROCK_P], p->field[ROCK_phase], p->field[ROCK_id],
            p->field[ROCK_viability], m->vector[MPM_PLACE], m->word[MPM_SHARE], m->word[MPM_APART],
            m->word[MPM_STRENGTH], m->word[MPM_ID], m->word[MPM_ORIGIN], m->word[MPM_PIECE],
            m->word[MPM_JOINT]);
}

void mpm_obstacle(struct gpu *gpu, struct mpm *m, struct particles *p)
{
    m->resting = p;
    if (!p)
        return;
    struct mpm_params k = mpm_params_of(m, held_words(p->voxels), 0);
    particles_fill(gpu, p);
    GPU_RUN(gpu, mpm_full, k.n, k, p->held.words, p->fill, m->full);
}

void mpm_store(struct gpu *gpu, struct mpm *m, struct particles *p, bool moving)
{
    struct mpm_params k = mpm_params_of(m, m->n, 0);
    if (moving)
        k.fastest = 0.3f;
    GPU_RUN(gpu, mpm_store, m->n, k, m->word[MPM_ORIGIN], m->vector[MPM_PLACE], m->vector[MPM_VELOCITY],
            m->vector[MPM_STRETCH_X], m->vector[MPM_STRETCH_Y], m->word[MPM_SHARE], m->word[MPM_APART],
            m->word[MPM_JOINT], p->field[ROCK_P], p->field[ROCK_v], p->field[ROCK_viability],
            p->field[ROCK_phase], p->field[ROCK_stress], p->field[ROCK_von_mises]);
}

void mpm_follow(struct gpu *gpu, struct mpm *m, struct particles *p, struct gpu_buffer *table)
{
    struct count_params k = {(uint)p->n};
    GPU_RUN(gpu, mpm_place, p->n, k, p->field[ROCK_id], table);
    gpu_gather(gpu, m->word[MPM_ID], table, m->word[MPM_ORIGIN], m->n);
}
