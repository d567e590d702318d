#include "stacks/stabilise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/params.h"

/* A queued space: number k of stack (i, j). */
struct entry {
    uint32_t height; /* quanta: surface of the moving material when it was queued; the highest move first */
    int32_t i, j, k;
};

struct list {
    struct entry *at;
    size_t n, capacity;
};

struct slide {
    const struct stabilise *options;
    struct stabilised *out;
    struct spaces spaces;
    struct list now, next;
    int slot;              /* the moving material's */
    double stable_rise[2]; /* quanta: to an edge and to a diagonal neighbour */
    double tolerance;      /* quanta by which the stable rise may be exceeded */
};

enum { TARGETS = 64, ROUNDS = 64 };

/* A space that material may move to. */
struct target {
    struct space *space; /* NULL: across the side of the grid */
    double level;        /* quanta: its surface plus the stable rise; material moves to it from above this */
    double capacity;     /* quanta that it can take */
    int i, j, k;
};

/* The height of the top of the material in `slot`. */
static uint32_t surface_of(const struct space *s, int slot)
{
    uint32_t z = s->floor;
    for (int k = 0; k <= slot; k++)
        z += s->amount[k];
    return z;
}

/* The amount of all materials except water, which is displaced. */
static uint32_t filled(const struct spaces_kinds *kinds, const struct space *s)
{
    uint32_t sum = 0;
    for (int k = 0; k < kinds->n; k++)
        sum += kinds->material[k] == MATERIAL_WATER ? 0 : s->amount[k];
    return sum;
}

/* Adds the spaces of a neighbouring stack into which material from `from`, whose surface is at h, slides. */
static int targets_in(const struct slide *s, const struct space *from, double h, int i, int j, double rise,
                      struct target *out, int n)
{
    int count;
    struct space *space = spaces_at(&s->spaces, i, j, &count);
    for (int k = 0; k < count && n < TARGETS; k++) {
        struct space *b = &space[k];
        if (b->floor >= h || b->floor >= from->ceiling || b->ceiling <= from->floor)
            continue;
        double capacity = (double)(b->ceiling - b->floor) - filled(&s->spaces.kinds, b);
        double surface = surface_of(b, s->slot);
        /* Below a lintel lower than h the pile only rises to the lintel. */
        double limit = fmin(h, surface + capacity);
        if (limit < h)
            capacity = fmin(capacity, limit - rise - surface);
        if (capacity < 1 || limit - surface - rise <= s->tolerance)
            continue;
        out[n++] = (struct target){b, surface + rise, capacity, i, j, k};
    }
    return n;
}

/* Does material that slides to (i, j), outside of the grid, cross a side that is not a wall? */
static bool leaves(const struct slide *s, int i, int j)
{
    const int *n = s->spaces.stacks->n;
    const unsigned across = (i < 0 ? WALL_X_MIN : 0) | (i >= n[0] ? WALL_X_MAX : 0) |
                            (j < 0 ? WALL_Y_MIN : 0) | (j >= n[1] ? WALL_Y_MAX : 0);
    return (across & ~s->options->walls) != 0;
}

static status targets_of(struct slide *s, const struct entry *p, const struct space *from, double h,
                         struct target out[TARGETS], int *n)
{
    status st = OK;
    const struct stacks *g = s->spaces.stacks;
    *n = 0;
    for (int dj = -1; dj <= 1; dj++)
        for (int di = -1; di <= 1; di++) {
            int i = p->i + di, j = p->j + dj;
            double rise = s->stable_rise[di && dj];
            struct space_tile *tile;
            if (!di && !dj)
                continue;
            if (i >= 0 && j >= 0 && i < g->n[0] && j < g->n[1]) {
                TRY(spaces_tile(&s->spaces, i, j, &tile));
                *n = targets_in(s, from, h, i, j, rise, out, *n);
            } else if (leaves(s, i, j) && *n < TARGETS && h - from->floor - rise > s->tolerance) {
                out[(*n)++] = (struct target){NULL, from->floor + rise, HUGE_VAL, i, j, 0};
            }
        }
done:
    return st;
}

/* The amount that has moved when the surface is at `level`. */
static double moved_at_level(const struct target *t, int n, double level)
{
    double sum = 0;
    for (int k = 0; k < n; k++)
        sum += fmin(fmax(level - t[k].level, 0), t[k].capacity);
    return sum;
}

/* The level L at which L + moved_at_level(L) = h, by bisection to a quarter of a quantum, rounded upwards: where a surface at h ends when
 * all lower targets rise to meet it. */
static double level_of(const struct target *t, int n, double h)
{
    double low = h, high = h;
    for (int k = 0; k < n; k++)
        low = fmin(low, t[k].level);
    for (int i = 0; i < 48 && high - low > 0.25; i++) {
        double middle = 0.5 * (low + high);
        if (middle + moved_at_level(t, n, middle) > h)
            high = middle;
        else
            low = middle;
    }
    return high;
}

static status push(struct slide *s, struct space_tile *tile, int i, int j, int k)
{
    int slot = j % STACK_TILE * STACK_TILE + i % STACK_TILE;
    uint32_t at = tile->first[slot] + (uint32_t)k;
    if (tile->mark[at] || tile->space[at].amount[s->slot] == 0)
        return OK;
    status st = memory_grow(&s->next.at, &s->next.capacity, s->next.n + 1, sizeof *s->next.at, "a slide");
    if (st != OK)
        return st;
    tile->mark[at] = 1;
    s->next.at[s->next.n++] = (struct entry){surface_of(&tile->space[at], s->slot), i, j, k};
    return OK;
}

/* Queues the spaces of a changed stack and its eight neighbours, which may move now. */
static status push_around(struct slide *s, int i, int j)
{
    status st = OK;
    const struct stacks *g = s->spaces.stacks;
    for (int b = j > 0 ? j - 1 : 0; b <= j + 1 && b < g->n[1]; b++)
        for (int a = i > 0 ? i - 1 : 0; a <= i + 1 && a < g->n[0]; a++) {
            struct space_tile *tile;
            int n;
            TRY(spaces_tile(&s->spaces, a, b, &tile));
            spaces_at(&s->spaces, a, b, &n);
            for (int k = 0; k < n; k++)
                TRY(push(s, tile, a, b, k));
        }
done:
    return st;
}

/* Levels one space with its lower neighbours. */
static status level_space(struct slide *s, const struct entry *p)
{
    status st = OK;
    struct space_tile *tile, *other;
    struct target target[TARGETS];
    int n;
    TRY(spaces_tile(&s->spaces, p->i, p->j, &tile));
    struct space *from = spaces_at(&s->spaces, p->i, p->j, &n) + p->k;
    double h = surface_of(from, s->slot), most = from->amount[s->slot], share = 1;
    TRY(targets_of(s, p, from, h, target, &n));
    if (n == 0 || most < 1)
        goto done;
    double level = level_of(target, n, h), sum = moved_at_level(target, n, level);
    /* No more can leave than the space has, nor, up to the error of `level`, than its surface sinks. */
    most = fmin(most, h - level + 1);
    if (sum > most)
        share = most / sum;
    uint32_t moved = 0;
    for (int k = 0; k < n; k++) {
        uint32_t m = (uint32_t)(share * fmin(fmax(level - target[k].level, 0), target[k].capacity));
        if (m == 0)
            continue;
        moved += m;
        if (!target[k].space) {
            s->out->left[s->spaces.kinds.material[s->slot]] += m;
            continue;
        }
        target[k].space->amount[s->slot] += m;
        TRY(spaces_tile(&s->spaces, target[k].i, target[k].j, &other));
        other->changed = true;
        TRY(push_around(s, target[k].i, target[k].j));
    }
    if (moved == 0)
        goto done;
    from->amount[s->slot] -= moved;
    tile->changed = true;
    s->out->moves++;
    TRY(push_around(s, p->i, p->j));
done:
    return st;
}

/* Highest first, so that material crosses a whole slope in one sweep. */
static int by_height(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;
    if (x->height != y->height)
        return x->height < y->height ? 1 : -1;
    if (x->j != y->j)
        return x->j < y->j ? -1 : 1;
    if (x->i != y->i)
        return x->i < y->i ? -1 : 1;
    return (x->k > y->k) - (x->k < y->k);
}

/* Can material of this space move? Does not open tiles: next to an unopened one the answer is yes. */
static bool may_move(const struct slide *s, int i, int j, int k)
{
    const struct stacks *g = s->spaces.stacks;
    struct target target[TARGETS];
    int n;
    const struct space *from = spaces_at(&s->spaces, i, j, &n) + k;
    double h = surface_of(from, s->slot);
    if (from->amount[s->slot] == 0)
        return false;
    for (int d = 0; d < 9; d++) {
        int a = i + d % 3 - 1, b = j + d / 3 - 1;
        double rise = s->stable_rise[d % 3 != 1 && d / 3 != 1];
        if (d == 4)
            continue;
        if (a < 0 || b < 0 || a >= g->n[0] || b >= g->n[1]) {
            if (leaves(s, a, b))
                return true;
            continue;
        }
        if (!s->spaces.tile[(size_t)(b / STACK_TILE) * (size_t)g->tiles[0] + (size_t)(a / STACK_TILE)].open ||
            targets_in(s, from, h, a, b, rise, target, 0) > 0)
            return true;
    }
    return false;
}

/* Marks the stacks of row j, lo..hi, whose material may move. */
static void mark_row(const struct slide *s, int j, int lo, int hi, uint8_t *mark)
{
    const struct stacks *g = s->spaces.stacks;
    for (int i = lo; i <= hi; i++) {
        const struct space_tile *tile =
            &s->spaces.tile[(size_t)(j / STACK_TILE) * (size_t)g->tiles[0] + (size_t)(i / STACK_TILE)];
        int n;
        mark[i] = 0;
        if (!tile->open)
            continue;
        spaces_at(&s->spaces, i, j, &n);
        for (int k = 0; k < n && !mark[i]; k++)
            mark[i] = may_move(s, i, j, k);
    }
}

/* Queues the spaces that may move: in lo..hi and one stack around it, or in all open tiles. */
static status find_unstable(struct slide *s, const int lo[2], const int hi[2], bool everywhere)
{
    status st = OK;
    const struct stacks *g = s->spaces.stacks;
    uint8_t *mark = NULL;
    int from[2], to[2];
    for (int a = 0; a < 2; a++) {
        from[a] = everywhere || lo[a] < 1 ? 0 : lo[a] - 1;
        to[a] = everywhere || hi[a] + 2 > g->n[a] ? g->n[a] - 1 : hi[a] + 1;
    }
    TRY(memory_alloc((size_t)g->n[0] * (size_t)g->n[1], 1, "a slide", &mark));
#pragma omp parallel for schedule(dynamic, 8)
    for (int j = from[1]; j <= to[1]; j++)
        mark_row(s, j, from[0], to[0], mark + (size_t)j * (size_t)g->n[0]);
    for (int j = from[1]; j <= to[1]; j++)
        for (int i = from[0]; i <= to[0]; i++) {
            struct space_tile *tile;
            int n;
            if (!mark[(size_t)j * (size_t)g->n[0] + (size_t)i])
                continue;
            TRY(spaces_tile(&s->spaces, i, j, &tile));
            spaces_at(&s->spaces, i, j, &n);
            for (int k = 0; k < n; k++)
                TRY(push(s, tile, i, j, k));
        }
done:
    free(mark);
    return st;
}

/* Slides one material until it is at rest, or options->sweeps. *moved: has anything moved? */
static status slide_material(struct slide *s, const int lo[2], const int hi[2], bool everywhere, bool *moved)
{
    status st = OK;
    const struct stacks *g = s->spaces.stacks;
    double repose = s->options->table[s->spaces.kinds.material[s->slot]].repose_deg;
    double most = fmin(repose + STABILISE_TOLERANCE_DEG, 89.9) * M_PI / 180;
    double width = g->cell / g->quantum, before = (double)s->out->moves;
    s->stable_rise[0] = width * tan(fmin(repose, 89.8) * M_PI / 180);
    s->stable_rise[1] = s->stable_rise[0] * sqrt(2);
    s->tolerance = fmax(width * tan(most) - s->stable_rise[0], 2);
    s->next.n = 0;
    TRY(find_unstable(s, lo, hi, everywhere));
    for (int64_t sweep = 0; s->next.n && (s->options->sweeps == 0 || sweep < s->options->sweeps); sweep++) {
        struct list list = s->now;
        s->now = s->next;
        s->next = list;
        s->next.n = 0;
        qsort(s->now.at, s->now.n, sizeof *s->now.at, by_height);
        for (size_t p = 0; p < s->now.n; p++) {
            const struct entry *at = &s->now.at[p];
            struct space_tile *tile;
            TRY(spaces_tile(&s->spaces, at->i, at->j, &tile));
            tile->mark[tile->first[at->j % STACK_TILE * STACK_TILE + at->i % STACK_TILE] + (uint32_t)at->k] =
                0;
            TRY(level_space(s, at));
        }
        s->out->sweeps++;
    }
    *moved = (double)s->out->moves > before;
    s->out->resting &= s->next.n == 0;
    for (size_t p = 0; p < s->next.n; p++) {
        const struct entry *at = &s->next.at[p];
        struct space_tile *tile;
        TRY(spaces_tile(&s->spaces, at->i, at->j, &tile));
        tile->mark[tile->first[at->j % STACK_TILE * STACK_TILE + at->i % STACK_TILE] + (uint32_t)at->k] = 0;
    }
done:
    return st;
}

status stabilise(struct stacks *s, const struct stabilise *options, const int lo[2], const int hi[2],
                 struct stabilised *out)
{
    status st = OK;
    struct spaces_kinds kinds = spaces_kinds(options->table, options->n_materials);
    struct slide slide = {.options = options, .out = out};
    *out = (struct stabilised){.resting = true};
    TRY(spaces_create(s, &kinds, &slide.spaces));
    TRY(spaces_open(&slide.spaces, (const int[]){lo[0] - 1, lo[1] - 1}, (const int[]){hi[0] + 1, hi[1] + 1}));
    /* A material that has moved may have made space below a ceiling for a material under it. */
    bool again = true;
    int rounds = options->sweeps ? 1 : ROUNDS;
    for (int round = 0; again && round < rounds; round++) {
        again = false;
        for (int slot = 0; slot < kinds.n; slot++) {
            bool moved = false;
            if (kinds.material[slot] == MATERIAL_WATER)
                continue;
            slide.slot = slot;
            TRY(slide_material(&slide, lo, hi, round > 0, &moved));
            again |= moved;
        }
    }
    out->resting &= !again;
    TRY(spaces_close(&slide.spaces, true, s, &out->lost));
done:
    spaces_destroy(&slide.spaces);
    free(slide.now.at);
    free(slide.next.at);
    return st;
}
