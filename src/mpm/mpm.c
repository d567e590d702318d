#include "mpm/mpm.h"

#include <math.h>

#include "mpm/internal.h"

const char *const mpm_vector_names[MPM_VECTORS] = {"mpm place",    "mpm velocity",  "mpm affine x",
                                                   "mpm affine y", "mpm stretch x", "mpm stretch y"};
const char *const mpm_word_names[MPM_WORDS] = {"mpm share", "mpm apart", "mpm strength", "mpm id",
                                               "mpm origin"};

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

uint64_t mpm_bytes(size_t n_max, const int voxels[3])
{
    /* An eighth of the particles is cells; a third more for those cut by the surface. */
    return (uint64_t)n_max * ((MPM_VECTORS + 1) * 16 + (MPM_WORDS + 5) * 4) +
           (uint64_t)mpm_nodes(voxels) * (2 * 16 + 7 * 4) + (uint64_t)n_max / 6 * 27 * 16;
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
    TRY(gpu_buffer_create(gpu, "mpm home", n_max, 4, &m->home));
    TRY(gpu_buffer_create(gpu, "mpm speed", n_max, 4, &m->speed));
    TRY(gpu_buffer_create(gpu, "mpm spare vectors", n_max, 16, &m->spare_vector));
    TRY(gpu_buffer_create(gpu, "mpm spare words", n_max, 4, &m->spare_word));
    TRY(gpu_buffer_create(gpu, "mpm order", n_max, 4, &m->order));
    TRY(gpu_buffer_create(gpu, "mpm unordered", n_max, 4, &m->unordered));
    TRY(gpu_buffer_create(gpu, "mpm cell start", nodes + 2, 4, &m->start));
    TRY(gpu_buffer_create(gpu, "mpm cell slot", nodes, 4, &m->slot));
    TRY(gpu_buffer_create(gpu, "mpm flags", nodes + 1, 4, &m->flags));
    TRY(gpu_buffer_create(gpu, "mpm places", nodes + 1, 4, &m->place));
    TRY(gpu_buffer_create(gpu, "mpm cells", nodes, 4, &m->cell_list));
    TRY(gpu_buffer_create(gpu, "mpm nodes", nodes, 4, &m->node_list));
    TRY(gpu_buffer_create(gpu, "mpm grid velocity", nodes, 16, &m->node_velocity));
    TRY(gpu_buffer_create(gpu, "mpm walls", nodes, 16, &m->wall));
    TRY(gpu_buffer_create(gpu, "mpm products", nodes > n_max ? nodes : n_max, 4, &m->product));
    TRY(gpu_buffer_create(gpu, "mpm scalars", SCALARS, 4, &m->scalars));
    TRY(gpu_buffer_create(gpu, "mpm no rock", 1, 4, &m->nothing));
done:
    if (st != OK)
        mpm_destroy(gpu, m);
    return st;
}

void mpm_destroy(struct gpu *gpu, struct mpm *m)
{
    struct gpu_buffer **all[] = {
        &m->home,  &m->speed,         &m->spare_vector, &m->spare_word, &m->order,     &m->unordered,
        &m->start, &m->slot,          &m->flags,        &m->place,      &m->cell_list, &m->node_list,
        &m->wall,  &m->node_velocity, &m->product,      &m->partial,    &m->scalars,   &m->nothing};
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
        .n_cells = (uint)m->n_cells,
        .rock = m->fill != NULL,
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
        .lift = (float)o->lift,
        .rebound = (float)o->rebound,
    };
}

void mpm_load(struct gpu *gpu, struct mpm *m, struct particles *p, struct gpu_buffer *list, size_t n)
{
    struct mpm_load_params k = {.n = (uint)n,
                                .seed = m->options.seed,
                                .strength = (float)m->options.strength,
                                .joint = (float)(m->options.strength * m->options.joint),
                                .block = (float)m->options.block};
    m->n = n;
    m->n_left = 0;
    m->fastest = 0;
    for (int v = MPM_VELOCITY; v < MPM_VECTORS; v++)
        gpu_fill(gpu, m->vector[v], 0);
    GPU_RUN(gpu, mpm_load, n, k, list, p->field[ROCK_P], p->field[ROCK_phase], p->field[ROCK_id],
            p->field[ROCK_viability], m->vector[MPM_PLACE], m->word[MPM_SHARE], m->word[MPM_APART],
            m->word[MPM_STRENGTH], m->word[MPM_ID], m->word[MPM_ORIGIN]);
}

void mpm_store(struct gpu *gpu, struct mpm *m, struct particles *p, bool moving)
{
    struct mpm_params k = mpm_params_of(m, m->n, 0);
    if (moving)
        k.fastest = 0.3f;
    GPU_RUN(gpu, mpm_store, m->n, k, m->word[MPM_ORIGIN], m->vector[MPM_PLACE], m->vector[MPM_VELOCITY],
            m->vector[MPM_STRETCH_X], m->vector[MPM_STRETCH_Y], m->word[MPM_SHARE], m->word[MPM_APART],
            p->field[ROCK_P], p->field[ROCK_v], p->field[ROCK_viability], p->field[ROCK_phase],
            p->field[ROCK_stress], p->field[ROCK_von_mises]);
}

void mpm_follow(struct gpu *gpu, struct mpm *m, struct particles *p, struct gpu_buffer *table)
{
    struct count_params k = {(uint)p->n};
    GPU_RUN(gpu, mpm_place, p->n, k, p->field[ROCK_id], table);
    gpu_gather(gpu, m->word[MPM_ID], table, m->word[MPM_ORIGIN], m->n);
}

/* ---- order */

static void reorder(struct gpu *gpu, struct mpm *m, struct gpu_buffer **item)
{
    struct gpu_buffer **spare = gpu_buffer_item(*item) == 16 ? &m->spare_vector : &m->spare_word;
    struct gpu_buffer *old = *item;
    gpu_gather(gpu, m->order, old, *spare, m->n);
    *item = *spare;
    *spare = old;
}

/* Room for the occupied cells' partial sums. */
static status make_room(struct gpu *gpu, struct mpm *m)
{
    if (m->n_cells <= m->n_partial)
        return OK;
    gpu_buffer_destroy(gpu, &m->partial);
    m->n_partial = m->n_cells + m->n_cells / 4;
    return gpu_buffer_create(gpu, "mpm partial sums", 27 * m->n_partial, 16, &m->partial);
}

status mpm_sort(struct gpu *gpu, struct gpu_work *work, struct mpm *m)
{
    status st = OK;
    size_t nodes = gpu_buffer_count(m->slot);
    struct mpm_params k = mpm_params_of(m, m->n, 0);
    struct count_params each = {(uint)nodes};
    uint32_t alive;
    struct gpu_sort sort = {.keys = m->home,
                            .ids = m->word[MPM_ID],
                            .start = m->start,
                            .order = m->order,
                            .taken = m->flags,
                            .unordered = m->unordered,
                            .n = m->n,
                            .n_keys = nodes + 1,
                            .n_ordered = nodes};
    GPU_RUN(gpu, mpm_key, m->n, k, m->vector[MPM_PLACE], m->word[MPM_SHARE], m->home);
    gpu_sort(gpu, work, &sort);
    TRY(gpu_download(gpu, m->start, nodes, &alive, 1));
    m->n_left += m->n - alive;
    m->n = alive;
    for (int v = 0; v < MPM_VECTORS; v++)
        reorder(gpu, m, &m->vector[v]);
    for (int w = 0; w < MPM_WORDS; w++)
        reorder(gpu, m, &m->word[w]);
    reorder(gpu, m, &m->home);
    GPU_RUN(gpu, mpm_occupied, nodes, each, m->start, m->flags);
    TRY(gpu_compact(gpu, work, m->flags, m->place, m->cell_list, nodes, &m->n_cells));
    gpu_fill(gpu, m->slot, 0);
    each.n = (uint)m->n_cells;
    GPU_RUN(gpu, mpm_slots, m->n_cells, each, m->cell_list, m->slot);
    k.n = (uint)nodes;
    GPU_RUN(gpu, mpm_near, nodes, k, m->slot, m->flags);
    TRY(gpu_compact(gpu, work, m->flags, m->place, m->node_list, nodes, &m->n_nodes));
    TRY(make_room(gpu, m));
    k.n = (uint)m->n_nodes;
    if (m->fill)
        GPU_RUN(gpu, mpm_walls, m->n_nodes, k, m->node_list, m->fill, m->wall);
done:
    return st;
}
