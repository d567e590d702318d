/* Sorting: parts of each cell, nodes that they reach, and the nodes' entries, one per body. */
#include "mpm/internal.h"

static void reorder(struct gpu *gpu, struct mpm *m, struct gpu_buffer **item)
{
    struct gpu_buffer **spare = gpu_buffer_item(*item) == 16 ? &m->spare_vector : &m->spare_word;
    struct gpu_buffer *old = *item;
    gpu_gather(gpu, m->order, old, *spare, m->n);
    *item = *spare;
    *spare = old;
}

/* Grow the buffers by part, and by entry. */
static status reserve_parts(struct gpu *gpu, struct mpm *m)
{
    status st = OK;
    if (m->n_parts <= m->parts_allocated)
        return OK;
    gpu_buffer_destroy(gpu, &m->partial);
    gpu_buffer_destroy(gpu, &m->reach);
    m->parts_allocated = 0;
    size_t most = m->n_parts + m->n_parts / 4;
    TRY(gpu_buffer_create(gpu, "mpm partial sums", 27 * most, 16, &m->partial));
    TRY(gpu_buffer_create(gpu, "mpm reach", 28 * most, 4, &m->reach));
    m->parts_allocated = most;
done:
    return st;
}

static status reserve_entries(struct gpu *gpu, struct mpm *m)
{
    status st = OK;
    if (m->n_entries <= m->entries_allocated)
        return OK;
    gpu_buffer_destroy(gpu, &m->entry_node);
    gpu_buffer_destroy(gpu, &m->entry_body);
    gpu_buffer_destroy(gpu, &m->entry_group);
    gpu_buffer_destroy(gpu, &m->mass);
    gpu_buffer_destroy(gpu, &m->velocity);
    m->entries_allocated = 0;
    size_t most = m->n_entries + m->n_entries / 4;
    TRY(gpu_buffer_create(gpu, "mpm entries", most, 4, &m->entry_node));
    TRY(gpu_buffer_create(gpu, "mpm entries' bodies", most, 4, &m->entry_body));
    TRY(gpu_buffer_create(gpu, "mpm entries' groups", most, 4, &m->entry_group));
    TRY(gpu_buffer_create(gpu, "mpm entries' mass", most, 4, &m->mass));
    TRY(gpu_buffer_create(gpu, "mpm entries' velocity", most, 16, &m->velocity));
    m->entries_allocated = most;
done:
    return st;
}

static status find_parts(struct gpu *gpu, struct gpu_work *work, struct mpm *m)
{
    status st = OK;
    struct count_params all = {(uint)m->n}, each = {0};
    GPU_RUN(gpu, mpm_begins, m->n, all, m->home, m->group, m->order);
    TRY(gpu_compact(gpu, work, m->order, m->unordered, m->part_first, m->n, &m->n_parts));
    GPU_RUN(gpu, mpm_parts, m->n, all, m->home, m->group, m->order, m->unordered, m->part, m->part_first,
            m->part_cell, m->part_body);
    gpu_fill(gpu, m->slot, 0);
    each.n = (uint)m->n_parts;
    GPU_RUN(gpu, mpm_slots, m->n_parts, each, m->part_cell, m->slot, m->many);
    TRY(reserve_parts(gpu, m));
done:
    return st;
}

/* Lists the nodes that parts reach and creates one entry for each body at each of them. */
static status find_entries(struct gpu *gpu, struct gpu_work *work, struct mpm *m)
{
    status st = OK;
    size_t nodes = gpu_buffer_count(m->slot);
    struct mpm_params k = mpm_params_of(m, nodes, 0);
    uint32_t last[2];
    GPU_RUN(gpu, mpm_near, nodes, k, m->slot, m->flags);
    TRY(gpu_compact(gpu, work, m->flags, m->place, m->node_list, nodes, &m->n_nodes));
    m->n_entries = m->n_nodes;
    m->n_mixed = 0;
    k.n = (uint)m->n_nodes;
    if (m->n_nodes == 0)
        return OK;
    if (k.bodies) {
        GPU_RUN(gpu, mpm_meet, m->n_nodes, k, m->node_list, m->slot, m->many, m->part_body, m->start,
                m->flags);
        TRY(gpu_compact(gpu, work, m->flags, m->place, m->mixed, m->n_nodes, &m->n_mixed));
        TRY(gpu_download(gpu, m->start, m->n_nodes - 1, &last[0], 1));
        gpu_scan(gpu, work, m->start, m->n_nodes);
        TRY(gpu_download(gpu, m->start, m->n_nodes - 1, &last[1], 1));
        m->n_entries = (size_t)last[0] + last[1];
    }
    TRY(reserve_entries(gpu, m));
    gpu_fill(gpu, m->meeting, 0);
    GPU_RUN(gpu, mpm_entries, m->n_nodes, k, m->node_list, m->slot, m->many, m->part_body, m->start, m->first,
            m->meeting, m->entry_node, m->entry_body);
    k.n = (uint)(28 * m->n_parts);
    GPU_RUN(gpu, mpm_reach, k.n, k, m->part_cell, m->part_body, m->first, m->meeting, m->entry_body,
            m->reach);
    k.n = (uint)m->n_nodes;
    if (m->n_mixed) {
        struct mpm_load_params seeds = mpm_load_params_of(m, m->n_mixed);
        GPU_RUN(gpu, mpm_bond, m->n_mixed, seeds, m->mixed, m->node_list, m->first, m->meeting, m->entry_body,
                m->pieces.holds, m->entry_group);
    }
    if (m->resting)
        GPU_RUN(gpu, mpm_walls, m->n_nodes, k, m->node_list, m->resting->held.words, m->resting->fill,
                m->wall);
done:
    return st;
}

status mpm_sort(struct gpu *gpu, struct gpu_work *work, struct mpm *m)
{
    status st = OK;
    size_t nodes = gpu_buffer_count(m->slot);
    struct mpm_params k = mpm_params_of(m, m->n, 0);
    uint32_t alive;
    struct count_params all = {(uint)m->n};
    struct sort_params rank = {(uint)m->n, (uint)nodes};
    GPU_RUN(gpu, mpm_key, m->n, k, m->vector[MPM_PLACE], m->word[MPM_SHARE], m->word[MPM_APART],
            m->word[MPM_JOINT], m->word[MPM_PIECE], m->home, m->group);
    gpu_fill(gpu, m->start, 0);
    gpu_fill(gpu, m->flags, 0);
    GPU_RUN(gpu, gpu_sort_count, m->n, all, m->home, m->start);
    gpu_scan(gpu, work, m->start, nodes + 2);
    GPU_RUN(gpu, gpu_sort_scatter, m->n, all, m->home, m->start, m->flags, m->unordered);
    GPU_RUN(gpu, mpm_order, m->n, rank, m->home, m->start, m->unordered, m->group, m->word[MPM_ID], m->order);
    TRY(gpu_download(gpu, m->start, nodes, &alive, 1));
    m->n_left += m->n - alive;
    m->n = alive;
    for (int v = 0; v < MPM_VECTORS; v++)
        reorder(gpu, m, &m->vector[v]);
    for (int w = 0; w < MPM_WORDS; w++)
        reorder(gpu, m, &m->word[w]);
    reorder(gpu, m, &m->home);
    reorder(gpu, m, &m->group);
    TRY(find_parts(gpu, work, m));
    TRY(find_entries(gpu, work, m));
done:
    return st;
}
