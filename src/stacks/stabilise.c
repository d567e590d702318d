#include "stacks/stabilise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shared/params.h"

/* A space, by where it is. */
struct place {
    uint32_t height; /* of the moving material's surface when it was listed: the higher move first */
    int32_t i, j, k;
};

struct list {
    struct place *at;
    size_t n, capacity;
};

struct slide {
    const struct stabilise *options;
    struct stabilised *out;
    struct spaces spaces;
    struct list now, next;
    int slot;             /* of the material that moves */
    double run[2], spare; /* quanta: rise that is stable to a neighbour beside or across; and tolerated */
};

enum { TARGETS = 64, ROUNDS = 64 };

/* Where material of a space may go. */
struct target {
    struct space *space; /* NULL: over the side */
    double level;        /* what it may rise to meet: its surface and the stable rise */
    double room;
    int i, j, k;
};

/* Top of the material in `slot`, on which what lies above it rests. */
static uint32_t surface_of(const struct space *s, int slot)
{
    uint32_t z = s->floor;
    for (int k = 0; k <= slot; k++)
        z += s->amount[k];
    return z;
}

/* All but the water, which gives way. */
static uint32_t filled(const struct spaces_kinds *kinds, const struct space *s)
{
    uint32_t sum = 0;
    for (int k = 0; k < kinds->n; k++)
        sum += kinds->material[k] == MATERIAL_WATER ? 0 : s->amount[k];
    return sum;
}

/* The spaces of one neighbour that `from`, whose material reaches up to h, runs into. */
static int targets_in(const struct slide *s, const struct space *from, double h, int i, int j, double rise,
                      struct target *out, int n)
{
    int count;
    struct space *space = spaces_at(&s->spaces, i, j, &count);
    for (int k = 0; k < count && n < TARGETS; k++) {
        struct space *b = &space[k];
        if (b->floor >= h || b->floor >= from->ceiling || b->ceiling <= from->floor)
            continue;
        double room = (double)(b->ceiling - b->floor) - filled(&s->spaces.kinds, b);
        double surface = surface_of(b, s->slot);
        /* Under a lintel lower than h the pile runs in only up to the lintel. */
        double limit = fmin(h, surface + room);
        if (limit < h)
            room = fmin(room, limit - rise - surface);
        if (room < 1 || limit - surface - rise <= s->spare)
            continue;
        out[n++] = (struct target){b, surface + rise, room, i, j, k};
    }
    return n;
}

/* Does what slides to stack (i, j), which is beyond the grid, leave it across a side that is no wall? */
static bool leaves(const struct slide *s, int i, int j)
{
    const int *n = s->spaces.stacks->n;
    const unsigned across = (i < 0 ? WALL_X_MIN : 0) | (i >= n[0] ? WALL_X_MAX : 0) |
                            (j < 0 ? WALL_Y_MIN : 0) | (j >= n[1] ? WALL_Y_MAX : 0);
    return (across & ~s->options->walls) != 0;
}

static status targets_of(struct slide *s, const struct place *p, const struct space *from, double h,
                         struct target out[TARGETS], int *n)
{
    status st = OK;
    const struct stacks *g = s->spaces.stacks;
    *n = 0;
    for (int dj = -1; dj <= 1; dj++)
        for (int di = -1; di <= 1; di++) {
            int i = p->i + di, j = p->j + dj;
            double rise = s->run[di && dj];
            struct space_tile *tile;
            if (!di && !dj)
                continue;
            if (i >= 0 && j >= 0 && i < g->n[0] && j < g->n[1]) {
                TRY(spaces_tile(&s->spaces, i, j, &tile));
                *n = targets_in(s, from, h, i, j, rise, out, *n);
            } else if (leaves(s, i, j) && *n < TARGETS && h - from->floor - rise > s->spare) {
                out[(*n)++] = (struct target){NULL, from->floor + rise, HUGE_VAL, i, j, 0};
            }
        }
done:
    return st;
}

static double moved_down_to(const struct target *t, int n, double level)
{
    double sum = 0;
    for (int k = 0; k < n; k++)
        sum += fmin(fmax(level - t[k].level, 0), t[k].room);
    return sum;
}

/* The height that a surface at h comes to when all that is lower, and has room, rises to meet it: where
 * height and what has left it add up to h. Never below it. */
static double level_of(const struct target *t, int n, double h)
{
    double low = h, high = h;
    for (int k = 0; k < n; k++)
        low = fmin(low, t[k].level);
    for (int i = 0; i < 48 && high - low > 0.25; i++) {
        double middle = 0.5 * (low + high);
        if (middle + moved_down_to(t, n, middle) > h)
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
    s->next.at[s->next.n++] = (struct place){surface_of(&tile->space[at], s->slot), i, j, k};
    return OK;
}

/* Whatever rests against a stack that changed may move now. */
static status wake(struct slide *s, int i, int j)
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

/* Moves what one space has too much of. */
static status relax(struct slide *s, const struct place *p)
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
    double level = level_of(target, n, h), sum = moved_down_to(target, n, level);
    /* `high` of the search is a shade too high a level; and no more leaves than there is. */
    most = fmin(most, h - level + 1);
    if (sum > most)
        share = most / sum;
    uint32_t gone = 0;
    for (int k = 0; k < n; k++) {
        uint32_t m = (uint32_t)(share * fmin(fmax(level - target[k].level, 0), target[k].room));
        if (m == 0)
            continue;
        gone += m;
        if (!target[k].space) {
            s->out->left[s->spaces.kinds.material[s->slot]] += m;
            continue;
        }
        target[k].space->amount[s->slot] += m;
        TRY(spaces_tile(&s->spaces, target[k].i, target[k].j, &other));
        other->changed = true;
        TRY(wake(s, target[k].i, target[k].j));
    }
    if (gone == 0)
        goto done;
    from->amount[s->slot] -= gone;
    tile->changed = true;
    s->out->moves++;
    TRY(wake(s, p->i, p->j));
done:
    return st;
}

/* Highest first: what comes down passes over a slope in one sweep. */
static int by_height(const void *a, const void *b)
{
    const struct place *x = a, *y = b;
    if (x->height != y->height)
        return x->height < y->height ? 1 : -1;
    if (x->j != y->j)
        return x->j < y->j ? -1 : 1;
    if (x->i != y->i)
        return x->i < y->i ? -1 : 1;
    return (x->k > y->k) - (x->k < y->k);
}

/* Does this space have anywhere to go to? Reads only; where a tile has not been opened, it may. */
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
        double rise = s->run[d % 3 != 1 && d / 3 != 1];
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

/* Marks in row j of lo..hi the stacks that may move. */
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

/* What moves first: of lo..hi and a stack around, or of all that is open. */
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

/* One material until it rests; *moved: did it at all? */
static status settle(struct slide *s, const int lo[2], const int hi[2], bool everywhere, bool *moved)
{
    status st = OK;
    const struct stacks *g = s->spaces.stacks;
    double repose = s->options->table[s->spaces.kinds.material[s->slot]].repose_deg;
    double most = fmin(repose + STABILISE_TOLERANCE_DEG, 89.9) * M_PI / 180;
    double across = g->cell / g->quantum, before = (double)s->out->moves;
    s->run[0] = across * tan(fmin(repose, 89.8) * M_PI / 180);
    s->run[1] = s->run[0] * sqrt(2);
    s->spare = fmax(across * tan(most) - s->run[0], 2);
    s->next.n = 0;
    TRY(find_unstable(s, lo, hi, everywhere));
    for (int64_t sweep = 0; s->next.n && (s->options->sweeps == 0 || sweep < s->options->sweeps); sweep++) {
        struct list list = s->now;
        s->now = s->next;
        s->next = list;
        s->next.n = 0;
        qsort(s->now.at, s->now.n, sizeof *s->now.at, by_height);
        for (size_t p = 0; p < s->now.n; p++) {
            const struct place *at = &s->now.at[p];
            struct space_tile *tile;
            TRY(spaces_tile(&s->spaces, at->i, at->j, &tile));
            tile->mark[tile->first[at->j % STACK_TILE * STACK_TILE + at->i % STACK_TILE] + (uint32_t)at->k] =
                0;
            TRY(relax(s, at));
        }
        s->out->sweeps++;
    }
    *moved = (double)s->out->moves > before;
    s->out->resting &= s->next.n == 0;
    for (size_t p = 0; p < s->next.n; p++) {
        const struct place *at = &s->next.at[p];
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
    /* A material that moved may have made room under a ceiling for one that lies below it. */
    bool again = true;
    int rounds = options->sweeps ? 1 : ROUNDS;
    for (int round = 0; again && round < rounds; round++) {
        again = false;
        for (int slot = 0; slot < kinds.n; slot++) {
            bool moved = false;
            if (kinds.material[slot] == MATERIAL_WATER)
                continue;
            slide.slot = slot;
            TRY(settle(&slide, lo, hi, round > 0, &moved));
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
