#include "tests/ref/flow_ref.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "shared/params.h"

static const int step_x[4] = {1, 0, -1, 0}, step_y[4] = {0, 1, 0, -1};

static void *need(size_t n, size_t size)
{
    void *memory = calloc(n + 1, size);
    assert(memory);
    return memory;
}

struct place {
    int x, y, z;
};

static struct place place_of(const struct flow_ref *f, size_t c)
{
    size_t nx = (size_t)f->cells[0], ny = (size_t)f->cells[1];
    return (struct place){(int)(c % nx), (int)(c / nx % ny), (int)(c / (nx * ny))};
}

static size_t cell(const struct flow_ref *f, int x, int y, int z)
{
    return ((size_t)z * (size_t)f->cells[1] + (size_t)y) * (size_t)f->cells[0] + (size_t)x;
}

static bool at_side(const struct flow_ref *f, struct place p)
{
    return (p.x == 0 && !(f->walls & WALL_X_MIN)) || (p.x == f->cells[0] - 1 && !(f->walls & WALL_X_MAX)) ||
           (p.y == 0 && !(f->walls & WALL_Y_MIN)) || (p.y == f->cells[1] - 1 && !(f->walls & WALL_Y_MAX));
}

/* The cell beside one, a step along a way; false: there is a wall. */
static bool beside_of(const struct flow_ref *f, struct place p, int d, size_t *c)
{
    const int x = p.x + step_x[d], y = p.y + step_y[d];
    if (x < 0 || y < 0 || x >= f->cells[0] || y >= f->cells[1])
        return false;
    *c = cell(f, x, y, p.z);
    return true;
}

static uint32_t kind(const struct flow_ref *f, size_t c)
{
    return f->tag[c] & WATER_KIND;
}

static bool is_open(const struct flow_ref *f, size_t c)
{
    return kind(f, c) == WATER_EMPTY || kind(f, c) == WATER_SURF;
}

static bool is_air(const struct flow_ref *f, int x, int y, int z)
{
    return kind(f, cell(f, x, y, z)) == WATER_EMPTY;
}

static bool is_out(const struct flow_ref *f, size_t c)
{
    struct place p = place_of(f, c);
    return at_side(f, p) || (p.z == 0 && kind(f, c) == WATER_EMPTY);
}

/* ---- kinds and altitudes */

static void find_kinds(struct flow_ref *f, const struct rock *rock, const int voxels[3], double h,
                       const int shift[3], uint32_t random)
{
    float *sum = need(f->n, sizeof *sum);
    uint8_t *rocky = need(f->n, 1);
    for (size_t i = 0; i < rock->n; i++) {
        int c[3];
        for (size_t a = 0; a < 3; a++) {
            int v = (int)floorf(rock->P[4 * i + a] / (float)h);
            c[a] = ((v < 0 ? 0 : v >= voxels[a] ? voxels[a] - 1 : v) + shift[a]) / f->size;
        }
        size_t at = cell(f, c[0], c[1], c[2]);
        rocky[at] = 1;
        sum[at] += rock->viability[i]; /* in the device's order: the same bits */
    }
    for (size_t c = 0; c < f->n; c++) {
        struct place p = place_of(f, c);
        bool covered = p.z + 1 < f->cells[2] && rocky[cell(f, p.x, p.y, p.z + 1)];
        f->tag[c] = !rocky[c] ? WATER_EMPTY : covered ? WATER_SOLID : WATER_SURF;
        f->z[c] = f->altitude[c] = (uint32_t)p.z << 16;
        if (f->tag[c] != WATER_SURF)
            continue;
        int wide[2], at[2] = {p.x, p.y};
        for (int a = 0; a < 2; a++) {
            int low = f->size * at[a] - shift[a], high = low + f->size;
            wide[a] = (high > voxels[a] ? voxels[a] : high) - (low < 0 ? 0 : low);
        }
        float columns = (float)(wide[0] * wide[1]);
        float rock_in = sum[c] + (p.z == 0 ? (float)shift[2] * columns : 0);
        uint32_t share = (uint32_t)(rock_in / columns * (64512.0f / (float)f->size));
        f->z[c] +=
            (share < 64512 ? share : 64512) + (random_hash(random, (uint32_t)c, 0, RANDOM_ROUGHNESS) & 1023);
        f->altitude[c] = f->z[c];
    }
    size_t layer = (size_t)f->cells[0] * (size_t)f->cells[1];
    for (size_t c = 0; c < f->n; c++)
        f->floor[c] = f->tag[c] == WATER_EMPTY && c >= layer ? f->floor[c - layer] : (uint32_t)c;
    free(sum);
    free(rocky);
}

/* ---- first receivers */

static uint32_t below(uint32_t hash, uint32_t n)
{
    return (uint32_t)((uint64_t)hash * n >> 32);
}

static size_t first_receiver(const struct flow_ref *f, size_t c, uint32_t random, bool leak)
{
    struct place p = place_of(f, c);
    uint32_t hash = random_hash(random, (uint32_t)c, 0, RANDOM_RECEIVER), weight[4] = {0}, sum = 0;
    bool rock = kind(f, c) == WATER_SOLID;
    size_t beside[4];
    if (is_out(f, c))
        return c;
    if (kind(f, c) == WATER_EMPTY)
        return f->floor[c];
    if ((rock || leak) && p.z > 0 && is_air(f, p.x, p.y, p.z - 1))
        return f->floor[cell(f, p.x, p.y, p.z - 1)];
    for (int d = 0; d < 4; d++) {
        if (!beside_of(f, p, d, &beside[d]))
            continue;
        uint32_t to = f->altitude[f->floor[beside[d]]];
        if (rock)
            weight[d] = kind(f, beside[d]) == WATER_EMPTY;
        else if (is_open(f, beside[d]) && to < f->z[c])
            weight[d] = f->z[c] - to;
        sum += weight[d];
    }
    if (sum == 0)
        return c;
    if (!rock && f->size == 1) /* in turns along each quadrant's diagonals */
        hash = random_hash(random, 0, 0, RANDOM_RECEIVER) +
               WATER_TURN *
                   (uint32_t)((weight[0] < weight[2] ? -p.x : p.x) + (weight[1] < weight[3] ? -p.y : p.y));
    uint32_t left = below(hash, sum);
    for (int d = 0;; d++) {
        if (left < weight[d])
            return f->floor[beside[d]];
        left -= weight[d];
    }
}

/* ---- the forest: first receivers, and the spanning tree of the passes between their basins */

struct pass {
    uint32_t z, number;
    size_t from, to;
};

static int by_height(const void *a, const void *b)
{
    const struct pass *p = a, *q = b;
    if (p->z != q->z)
        return p->z < q->z ? -1 : 1;
    return p->number < q->number ? -1 : p->number > q->number;
}

static size_t root_of(uint32_t *parent, size_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/* Floors are numbered upwards, column by column; pass d of floor c has number 4 c + d. */
static uint32_t *number_floors(const struct flow_ref *f)
{
    uint32_t *number = need(f->n, sizeof *number), next = 0;
    for (int y = 0; y < f->cells[1]; y++)
        for (int x = 0; x < f->cells[0]; x++)
            for (int z = 0; z < f->cells[2]; z++) {
                size_t c = cell(f, x, y, z);
                if (is_open(f, c) && f->floor[c] == c)
                    number[c] = next++;
            }
    return number;
}

/* Passes leave from SURF cells, on their own level. */
static struct pass *find_passes(const struct flow_ref *f, size_t *n)
{
    uint32_t *number = number_floors(f);
    struct pass *pass = need(4 * f->n, sizeof *pass);
    *n = 0;
    for (size_t c = 0; c < f->n; c++) {
        struct place p = place_of(f, c);
        if (kind(f, c) != WATER_SURF)
            continue;
        for (int d = 0; d < 4; d++) {
            int x = p.x + step_x[d], y = p.y + step_y[d];
            if (x < 0 || y < 0 || x >= f->cells[0] || y >= f->cells[1] || !is_open(f, cell(f, x, y, p.z)))
                continue;
            if (!is_air(f, x, y, p.z) && d >= 2)
                continue; /* the other cell's pass */
            size_t to = f->floor[cell(f, x, y, p.z)];
            uint32_t z = f->altitude[to] > f->z[c] ? f->altitude[to] : f->z[c];
            pass[(*n)++] = (struct pass){z, 4 * number[c] + (uint32_t)d, c, to};
        }
    }
    free(number);
    return pass;
}

/* Links of a floor, in both directions. */
struct links {
    size_t *first, *to;
};

static struct links links_of(const struct flow_ref *f, const struct pass *tree, size_t n_tree)
{
    struct links l = {need(f->n + 1, sizeof *l.first), need(2 * (f->n + n_tree), sizeof *l.to)};
    for (int fill = 0; fill < 2; fill++) {
        for (size_t e = 0; e < f->n + n_tree; e++) {
            size_t a = e < f->n ? e : tree[e - f->n].from, b = e < f->n ? f->initial[e] : tree[e - f->n].to;
            if (e < f->n && (kind(f, e) != WATER_SURF || a == b))
                continue;
            if (fill) {
                l.to[--l.first[a]] = b;
                l.to[--l.first[b]] = a;
            } else {
                l.first[a]++;
                l.first[b]++;
            }
        }
        for (size_t c = 0; c < f->n && !fill; c++)
            l.first[c + 1] += l.first[c];
    }
    return l;
}

static void turn_to_outlets(struct flow_ref *f, const struct links *l)
{
    size_t *queue = need(f->n, sizeof *queue), head = 0, tail = 0;
    uint8_t *seen = need(f->n, 1);
    for (size_t c = 0; c < f->n; c++)
        if (is_open(f, c) && is_out(f, c)) {
            seen[c] = 1;
            queue[tail++] = c;
        }
    while (head < tail) {
        size_t c = queue[head++];
        for (size_t e = l->first[c]; e < l->first[c + 1]; e++) {
            size_t o = l->to[e];
            if (seen[o])
                continue;
            seen[o] = 1;
            f->receiver[o] = (uint32_t)c;
            queue[tail++] = o;
        }
    }
    for (size_t c = 0; c < f->n; c++) {
        size_t end = kind(f, c) == WATER_SURF ? c : f->receiver[c];
        if (is_out(f, c))
            f->tag[c] = kind(f, c) == WATER_SOLID ? WATER_WALL | WATER_OUT : f->tag[c] | WATER_OUT;
        else if (kind(f, c) == WATER_SOLID && end == c)
            continue;
        else if (!seen[end])
            f->tag[c] |= WATER_DEAD;
        if (kind(f, c) == WATER_SOLID)
            f->tag[c] = WATER_WALL | (f->tag[c] & ~WATER_KIND);
    }
    free(queue);
    free(seen);
}

static void add_up(struct flow_ref *f, const int voxels[3], const int shift[3])
{
    uint32_t *donors = need(f->n, sizeof *donors);
    size_t *queue = need(f->n, sizeof *queue), head = 0, tail = 0;
    for (int y = 0; y < f->cells[1]; y++)
        for (int x = 0; x < f->cells[0]; x++)
            for (int s = 0; s < f->size * f->size; s++) {
                int vx = f->size * x + s % f->size - shift[0], vy = f->size * y + s / f->size - shift[1];
                if (vx >= 0 && vy >= 0 && vx < voxels[0] && vy < voxels[1])
                    f->rain[f->floor[cell(f, x, y, f->cells[2] - 1)]]++;
            }
    for (size_t c = 0; c < f->n; c++)
        donors[f->receiver[c]] += f->receiver[c] != c;
    for (size_t c = 0; c < f->n; c++)
        if (donors[c] == 0)
            queue[tail++] = c;
    while (head < tail) {
        size_t c = queue[head++], to = f->receiver[c];
        if (to == c)
            continue;
        f->rain[to] += f->rain[c];
        if (--donors[to] == 0)
            queue[tail++] = to;
    }
    assert(tail == f->n); /* no cycles */
    free(donors);
    free(queue);
}

struct flow_ref flow_ref_route(const struct rock *rock, const int voxels[3], double h, int size,
                               const int shift[3], uint32_t random, bool leak, unsigned walls)
{
    struct flow_ref f = {.n = 1, .size = size, .walls = walls};
    for (int a = 0; a < 3; a++) {
        f.cells[a] = voxels[a] / size + shift[a];
        f.n *= (size_t)f.cells[a];
    }
    f.tag = need(f.n, 4);
    f.z = need(f.n, 4);
    f.altitude = need(f.n, 4);
    f.initial = need(f.n, 4);
    f.floor = need(f.n, 4);
    f.receiver = need(f.n, 4);
    f.rain = need(f.n, 8);
    find_kinds(&f, rock, voxels, h, shift, random);
    for (size_t c = 0; c < f.n; c++)
        f.initial[c] = (uint32_t)first_receiver(&f, c, random, leak);
    memcpy(f.receiver, f.initial, f.n * 4);

    size_t n, n_tree = 0, outside = f.n;
    struct pass *pass = find_passes(&f, &n);
    uint32_t *parent = need(f.n + 1, sizeof *parent);
    for (size_t c = 0; c <= f.n; c++)
        parent[c] = (uint32_t)c;
    for (size_t c = 0; c < f.n; c++)
        if (is_open(&f, c))
            parent[root_of(parent, c)] = (uint32_t)root_of(parent, is_out(&f, c) ? outside : f.initial[c]);
    size_t n_between = 0;
    for (size_t e = 0; e < n; e++)
        if (root_of(parent, pass[e].from) != root_of(parent, pass[e].to))
            pass[n_between++] = pass[e];
    n = n_between;
    qsort(pass, n, sizeof *pass, by_height);
    for (size_t e = 0; e < n; e++) {
        size_t a = root_of(parent, pass[e].from), b = root_of(parent, pass[e].to);
        if (a == b)
            continue;
        parent[a] = (uint32_t)b;
        pass[n_tree++] = pass[e];
    }
    struct links l = links_of(&f, pass, n_tree);
    turn_to_outlets(&f, &l);
    add_up(&f, voxels, shift);
    free(l.first);
    free(l.to);
    free(parent);
    free(pass);
    return f;
}

void flow_ref_free(struct flow_ref *f)
{
    free(f->tag);
    free(f->z);
    free(f->altitude);
    free(f->initial);
    free(f->floor);
    free(f->receiver);
    free(f->rain);
    *f = (struct flow_ref){0};
}

/* ---- the flood */

struct heap {
    struct wet {
        uint32_t level;
        size_t c;
    } * item;
    size_t n;
};

static void heap_put(struct heap *h, struct wet w)
{
    size_t i = ++h->n;
    for (; i > 1 && h->item[i / 2].level > w.level; i /= 2)
        h->item[i] = h->item[i / 2];
    h->item[i] = w;
}

static struct wet heap_take(struct heap *h)
{
    struct wet top = h->item[1], last = h->item[h->n--];
    size_t i = 1;
    for (size_t child; (child = 2 * i) <= h->n; i = child) {
        if (child < h->n && h->item[child + 1].level < h->item[child].level)
            child++;
        if (h->item[child].level >= last.level)
            break;
        h->item[i] = h->item[child];
    }
    h->item[i] = last;
    return top;
}

uint32_t *flow_ref_levels(const struct flow_ref *f, bool leak)
{
    uint32_t *level = need(f->n, sizeof *level);
    struct heap heap = {need(8 * f->n + 2, sizeof *heap.item), 0};
    for (size_t c = 0; c < f->n; c++) {
        level[c] = UINT32_MAX;
        if (is_open(f, c) && is_out(f, c))
            heap_put(&heap, (struct wet){f->altitude[c], c});
    }
    while (heap.n) {
        struct wet w = heap_take(&heap);
        struct place p = place_of(f, w.c);
        if (level[w.c] <= w.level)
            continue;
        level[w.c] = w.level;
        for (int d = 0; d < 6; d++) {
            int x = p.x + (d < 4 ? step_x[d] : 0), y = p.y + (d < 4 ? step_y[d] : 0);
            int z = p.z + (d == 4) - (d == 5);
            if (x < 0 || y < 0 || z < 0 || x >= f->cells[0] || y >= f->cells[1] || z >= f->cells[2])
                continue;
            size_t to = cell(f, x, y, z), upper = d == 4 ? to : w.c, lower = d == 4 ? w.c : to;
            if (!is_open(f, to) || level[to] != UINT32_MAX)
                continue;
            /* Up and down only through air, or a leaking roof. */
            if (d >= 4 && kind(f, upper) != WATER_EMPTY && !(leak && kind(f, lower) == WATER_EMPTY))
                continue;
            heap_put(&heap, (struct wet){f->altitude[to] > w.level ? f->altitude[to] : w.level, to});
        }
    }
    free(heap.item);
    return level;
}

/* ---- the split */

/* Of the water; what has no way out stands no higher than its floor. */
static uint32_t level_at(const struct flow_ref *f, const uint32_t *level, size_t c)
{
    return level[c] == UINT32_MAX ? f->altitude[c] : level[c];
}

/* To whom a floor gives, in shares of WATER_WHOLE; how many. */
static int split_of(const struct flow_ref *f, const uint32_t *level, size_t c, bool leak, size_t to[4],
                    uint32_t share[4])
{
    const struct place p = place_of(f, c);
    uint32_t drop[4] = {0}, highest = 0, sum = 0, given = 0;
    size_t below[4];
    int n = 0, most = 0;
    const uint32_t own = level_at(f, level, c);
    if (is_out(f, c))
        return 0;
    const bool drips = leak && p.z > 0 && is_air(f, p.x, p.y, p.z - 1);
    for (int d = 0; d < 4 && !drips && own == f->altitude[c]; d++) {
        size_t beside;
        if (!beside_of(f, p, d, &beside) || !is_open(f, beside))
            continue;
        below[d] = f->floor[beside];
        const uint32_t there = level_at(f, level, below[d]);
        if (there >= own)
            continue;
        drop[d] = own - there;
        highest = drop[d] > highest ? drop[d] : highest;
    }
    if (highest == 0) {
        to[0] = f->receiver[c];
        share[0] = WATER_WHOLE;
        return to[0] != c;
    }
    for (; highest >> 15; highest >>= 1)
        for (int d = 0; d < 4; d++)
            drop[d] >>= 1;
    for (int d = 0; d < 4; d++) {
        sum += drop[d];
        most = drop[d] > drop[most] ? d : most;
    }
    for (int d = 0; d < 4; d++)
        given += drop[d] * WATER_WHOLE / sum;
    for (int d = 0; d < 4; d++) {
        const uint32_t part = drop[d] * WATER_WHOLE / sum + (d == most ? WATER_WHOLE - given : 0);
        if (part == 0)
            continue;
        to[n] = below[d];
        share[n++] = part;
    }
    return n;
}

/* Parts of `whole` by shares; the largest share's, of equals the first, has what is left of rounding. */
static void parts_of(uint32_t whole, const uint32_t *share, int n, uint32_t part[4])
{
    int last = 0;
    uint32_t given = 0;
    for (int i = 0; i < n; i++) {
        part[i] = (uint32_t)((uint64_t)whole * share[i] >> 15);
        given += part[i];
        last = share[i] > share[last] ? i : last;
    }
    part[last] += whole - given;
}

uint32_t *flow_ref_split(const struct flow_ref *f, const uint32_t *level, const int voxels[3], bool leak,
                         uint32_t unit)
{
    uint32_t *sum = need(f->n, sizeof *sum), *donors = need(f->n, sizeof *donors), share[4], part[4];
    size_t *queue = need(f->n, sizeof *queue), head = 0, tail = 0, floors = 0, to[4];
    assert(f->size == 1);
    for (int y = 0; y < voxels[1]; y++)
        for (int x = 0; x < voxels[0]; x++)
            sum[f->floor[cell(f, x, y, f->cells[2] - 1)]] += unit;
    for (size_t c = 0; c < f->n; c++)
        if (is_open(f, c) && f->floor[c] == c)
            for (int i = split_of(f, level, c, leak, to, share); i-- > 0;)
                donors[to[i]]++;
    for (size_t c = 0; c < f->n; c++)
        if (is_open(f, c) && f->floor[c] == c) {
            floors++;
            if (donors[c] == 0)
                queue[tail++] = c;
        }
    while (head < tail) {
        const size_t c = queue[head++];
        const int n = split_of(f, level, c, leak, to, share);
        if (n > 0)
            parts_of(sum[c], share, n, part);
        for (int i = 0; i < n; i++) {
            sum[to[i]] += part[i];
            if (--donors[to[i]] == 0)
                queue[tail++] = to[i];
        }
    }
    assert(tail == floors); /* no cycles */
    free(donors);
    free(queue);
    return sum;
}
