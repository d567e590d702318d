#include "farm/schedule.h"

#include <stdlib.h>

#include "base/memory.h"

/* A binary heap of indices, the one with the least key on top; of equal keys the lower index. */
struct heap {
    size_t *item, n;
    const double *key;
};

static bool before(const struct heap *h, size_t a, size_t b)
{
    return h->key[a] < h->key[b] || (!(h->key[b] < h->key[a]) && a < b);
}

static void push(struct heap *h, size_t item)
{
    size_t at = h->n++;
    for (size_t up; at > 0 && (up = (at - 1) / 2, before(h, item, h->item[up])); at = up)
        h->item[at] = h->item[up];
    h->item[at] = item;
}

static size_t pop(struct heap *h)
{
    const size_t top = h->item[0], item = h->item[--h->n];
    size_t at = 0, down;
    while ((down = 2 * at + 1) < h->n) {
        if (down + 1 < h->n && before(h, h->item[down + 1], h->item[down]))
            down++;
        if (!before(h, h->item[down], item))
            break;
        h->item[at] = h->item[down];
        at = down;
    }
    h->item[at] = item;
    return top;
}

/* ---- the graph, seen from its end */

static double weight(const struct farm_task *t)
{
    return t->kind == FARM_SIM && !(t->seconds > 0) ? (double)range_count(t->frames) : t->seconds;
}

/* Sets behind[i] to minus the seconds of the longest chain that starts with task i: the most urgent is the least. */
static void find_chains(const struct farm_graph *g, double *behind)
{
    for (size_t i = 0; i < g->n; i++)
        behind[i] = -weight(&g->task[i]);
    for (size_t i = g->n; i-- > 0;)
        for (size_t k = 0; k < g->task[i].n_after; k++) {
            const size_t first = g->after[g->task[i].after + k];
            const double chain = behind[i] - weight(&g->task[first]);
            if (chain < behind[first])
                behind[first] = chain;
        }
}

/* Lists of the tasks that wait for each: those of task i are next[from[i + 1] ... from[i + 2] - 1]. */
static void find_next(const struct farm_graph *g, size_t *from, size_t *next)
{
    for (size_t i = 0; i < g->n; i++)
        for (size_t k = 0; k < g->task[i].n_after; k++)
            from[g->after[g->task[i].after + k] + 1]++;
    for (size_t i = 0; i < g->n; i++)
        from[i + 1] += from[i];
    from[g->n + 1] = from[g->n];
    for (size_t i = g->n; i-- > 0;) /* each entry moves from the end of its list to its beginning */
        for (size_t k = 0; k < g->task[i].n_after; k++)
            next[--from[g->after[g->task[i].after + k] + 1]] = i;
}

/* ---- the schedule */

struct work {
    double *behind, *end; /* of tasks; when each node is idle again */
    size_t *waits;        /* how many tasks each task waits for still */
    size_t *from, *next;
    struct heap ready, busy, idle;
    double *place; /* of nodes, the key of `idle` */
};

static status begin(const struct farm_graph *g, size_t nodes, struct work *w)
{
    status st = OK;
    TRY(memory_alloc(g->n, sizeof *w->behind, "a schedule", &w->behind));
    TRY(memory_alloc(nodes, sizeof *w->end, "a schedule", &w->end));
    TRY(memory_alloc(nodes, sizeof *w->place, "a schedule", &w->place));
    TRY(memory_alloc(g->n, sizeof *w->waits, "a schedule", &w->waits));
    TRY(memory_alloc(g->n + 2, sizeof *w->from, "a schedule", &w->from));
    TRY(memory_alloc(g->n_after + 1, sizeof *w->next, "a schedule", &w->next));
    TRY(memory_alloc(g->n, sizeof *w->ready.item, "a schedule", &w->ready.item));
    TRY(memory_alloc(nodes, sizeof *w->busy.item, "a schedule", &w->busy.item));
    TRY(memory_alloc(nodes, sizeof *w->idle.item, "a schedule", &w->idle.item));
    w->ready.key = w->behind;
    w->busy.key = w->end;
    w->idle.key = w->place;
    find_chains(g, w->behind);
    find_next(g, w->from, w->next);
    for (size_t i = 0; i < nodes; i++)
        push(&w->idle, i);
    for (size_t i = 0; i < g->n; i++) {
        w->waits[i] = g->task[i].n_after;
        if (!w->waits[i])
            push(&w->ready, i);
    }
done:
    return st;
}

static void end(struct work *w)
{
    free(w->behind);
    free(w->end);
    free(w->place);
    free(w->waits);
    free(w->from);
    free(w->next);
    free(w->ready.item);
    free(w->busy.item);
    free(w->idle.item);
}

status schedule_make(const struct farm_graph *g, size_t nodes, struct schedule *out)
{
    status st = OK;
    struct work w = {0};
    size_t *runs = NULL; /* the task of each node */
    double now = 0;
    *out = (struct schedule){0};
    if (nodes > g->n) /* more than there are tasks would stay idle */
        nodes = g->n ? g->n : 1;
    TRY(begin(g, nodes, &w));
    TRY(memory_alloc(nodes, sizeof *runs, "a schedule", &runs));
    TRY(memory_alloc(g->n, sizeof *out->start, "a schedule", &out->start));
    TRY(memory_alloc(g->n, sizeof *out->node, "a schedule", &out->node));
    while (w.ready.n || w.busy.n) {
        while (w.ready.n && w.idle.n) {
            const size_t task = pop(&w.ready), node = pop(&w.idle);
            out->start[task] = now;
            out->node[task] = node;
            out->busy_seconds += g->task[task].seconds;
            if (node >= out->nodes_used)
                out->nodes_used = node + 1;
            runs[node] = task;
            w.end[node] = now + g->task[task].seconds;
            push(&w.busy, node);
        }
        /* All that end at the same time, before others start: the most urgent of those that become ready goes first. */
        now = w.end[w.busy.item[0]];
        while (w.busy.n && !(w.end[w.busy.item[0]] > now)) {
            const size_t node = pop(&w.busy), task = runs[node];
            push(&w.idle, node);
            for (size_t k = w.from[task + 1]; k < w.from[task + 2]; k++)
                if (--w.waits[w.next[k]] == 0)
                    push(&w.ready, w.next[k]);
        }
    }
    out->seconds = now;
    for (size_t i = 0; i < out->nodes_used; i++)
        out->node_seconds += w.end[i];
done:
    end(&w);
    free(runs);
    if (st != OK)
        schedule_free(out);
    return st;
}

void schedule_free(struct schedule *s)
{
    free(s->start);
    free(s->node);
    *s = (struct schedule){0};
}

status schedule_critical_path(const struct farm_graph *g, size_t **path, size_t *n, double *seconds)
{
    status st = OK;
    struct work w = {0};
    *path = NULL;
    *n = 0;
    *seconds = 0;
    TRY(begin(g, 1, &w));
    TRY(memory_alloc(g->n, sizeof **path, "the critical path", path));
    size_t at = g->n;
    for (size_t i = 0; i < g->n; i++)
        if (g->task[i].n_after == 0 && (at == g->n || w.behind[i] < w.behind[at]))
            at = i;
    if (at < g->n)
        *seconds = -w.behind[at];
    while (at < g->n) {
        size_t most = g->n;
        (*path)[(*n)++] = at;
        for (size_t k = w.from[at + 1]; k < w.from[at + 2]; k++)
            if (most == g->n || w.behind[w.next[k]] < w.behind[most])
                most = w.next[k];
        at = most;
    }
done:
    end(&w);
    return st;
}

status schedule_order(const struct farm_graph *g, size_t **order)
{
    status st = OK;
    double *behind = NULL;
    struct heap all = {0};
    *order = NULL;
    TRY(memory_alloc(g->n, sizeof *behind, "the order of tasks", &behind));
    TRY(memory_alloc(g->n, sizeof *all.item, "the order of tasks", &all.item));
    TRY(memory_alloc(g->n, sizeof **order, "the order of tasks", order));
    all.key = behind;
    find_chains(g, behind);
    for (size_t i = 0; i < g->n; i++)
        push(&all, i);
    for (size_t i = 0; i < g->n; i++)
        (*order)[i] = pop(&all);
done:
    free(behind);
    free(all.item);
    return st;
}
