#include "groundwater/aquifer.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Least thickness of water, m, so that the derivative of its square root is finite in dry rock. */
static const double THIN = 1e-15;
/* Relative increase of the diagonal: regions without an outlet then fill up instead of making the matrix singular. */
static const double SHIFT = 1e-10;
static const double LINEAR = 1e-4; /* what a round's linear system leaves of its right side */
enum { LINEAR_MOST = 200 };

static size_t cells_of(const struct aquifer *a)
{
    return (size_t)a->n[0] * (size_t)a->n[1];
}

status aquifer_create(const int n[2], double dx, struct aquifer *a)
{
    status st = OK;
    *a = (struct aquifer){.n = {n[0], n[1]}, .dx = dx};
    const size_t cells = cells_of(a);
    double **const array[] = {&a->conductivity, &a->base, &a->room, &a->recharge,
                              &a->thick,        &a->over, &a->step, &a->scale};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        TRY(memory_alloc(cells, sizeof(double), "groundwater", array[i]));
    TRY(memory_alloc(cells, sizeof *a->full, "groundwater", &a->full));
    for (int d = 0; d < NEIGHBOURS; d++) {
        TRY(memory_alloc(cells, sizeof *a->face[d], "groundwater", &a->face[d]));
        TRY(memory_alloc(cells, sizeof *a->sill[d], "groundwater", &a->sill[d]));
    }
done:
    if (st != OK)
        aquifer_destroy(a);
    return st;
}

void aquifer_destroy(struct aquifer *a)
{
    double *const array[] = {a->conductivity, a->base, a->room, a->recharge,
                             a->thick,        a->over, a->step, a->scale};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        free(array[i]);
    free(a->full);
    for (int d = 0; d < NEIGHBOURS; d++) {
        free(a->face[d]);
        free(a->sill[d]);
    }
    *a = (struct aquifer){0};
}

/* Flow from c towards d, m3/yr, and its derivatives with respect to b^2 / 2 in c and in its neighbour. */
struct flow {
    double out, here, beyond;
};

static struct flow joined(double K, double upper, double lower, double drop)
{
    const double fall = drop + upper - lower;
    if (lower > drop)
        return (struct flow){.out = K * (upper + lower) / 2 * fall,
                             .here = K * (upper + drop / 2) / upper,
                             .beyond = K * (drop / 2 - lower) / lower};
    return (struct flow){.out = K * upper * (fall - (upper - lower) / 2),
                         .here = K * (upper + drop - lower / 2) / upper,
                         .beyond = -K * upper / 2 / lower};
}

static struct flow flow_of(const struct aquifer *a, size_t c, int d)
{
    const enum aquifer_face face = a->face[d][c];
    if (face == FACE_CLOSED)
        return (struct flow){0};
    if (face != FACE_JOINED) {
        const double K = a->conductivity[c], b = fmax(a->base[c] + a->thick[c] - a->sill[d][c], 0);
        return (struct flow){.out = K * b * b, .here = 2 * K * b / a->thick[c]};
    }
    const size_t o = (size_t)fivepoint_beside(a->n, c, d);
    const double K = 2 / (1 / a->conductivity[c] + 1 / a->conductivity[o]), drop = a->base[c] - a->base[o];
    if (drop >= 0)
        return joined(K, a->thick[c], a->thick[o], drop);
    const struct flow back = joined(K, a->thick[o], a->thick[c], -drop);
    return (struct flow){-back.out, -back.beyond, -back.here};
}

double aquifer_flow(const struct aquifer *a, size_t c, int d)
{
    return flow_of(a, c, d).out;
}

/* A cell's linearised balance and its residual. */
static double balance(const struct aquifer *a, struct fivepoint *A, size_t c)
{
    double left = a->recharge[c];
    A->diagonal[c] = SHIFT * a->conductivity[c];
    for (int d = 0; d < NEIGHBOURS; d++) {
        const struct flow f = flow_of(a, c, d);
        left -= f.out;
        A->diagonal[c] += f.here * (1 + SHIFT);
        if (a->face[d][c] == FACE_JOINED && !a->full[fivepoint_beside(a->n, c, d)])
            A->coupling[d][c] = f.beyond;
    }
    return left;
}

/* Assembles all cells; full ones have no equation. Returns the sum of the residuals, m3/yr: a surplus in full cells is none. */
static double balances(const struct aquifer *a, struct fivepoint *A, double *left)
{
    double wrong = 0;
    for (size_t c = 0; c < cells_of(a); c++) {
        A->diagonal[c] = left[c] = 0;
        for (int d = 0; d < NEIGHBOURS; d++)
            A->coupling[d][c] = 0;
        if (a->conductivity[c] == 0)
            continue;
        left[c] = balance(a, A, c);
        wrong += a->full[c] ? fmax(-left[c], 0) : fabs(left[c]);
        if (!a->full[c])
            continue;
        A->diagonal[c] = 0;
        for (int d = 0; d < NEIGHBOURS; d++)
            A->coupling[d][c] = 0;
    }
    return wrong;
}

/* Scales the unknowns: where water is thin on a steep bed, flow grows steeply with b^2 / 2, and equations would differ by orders. */
static void scale_up(const struct aquifer *a, struct fivepoint *A)
{
    for (size_t c = 0; c < cells_of(a); c++) {
        a->scale[c] = a->conductivity[c] > 0 ? fmax(A->diagonal[c] / (6 * a->conductivity[c]), 1) : 1;
        A->diagonal[c] /= a->scale[c];
        for (int d = 0; d < NEIGHBOURS; d++) {
            const ptrdiff_t o = fivepoint_beside(a->n, c, d);
            if (o >= 0)
                A->coupling[d ^ 1][o] /= a->scale[c];
        }
    }
}

/* Releases full cells from which more flows out than in. Returns whether there were any. */
static bool free_some(struct aquifer *a, const double *left)
{
    bool any = false;
    for (size_t c = 0; c < cells_of(a); c++)
        if (a->full[c] && left[c] < 0) {
            a->full[c] = 0;
            any = true;
        }
    return any;
}

/* Applies the step w of b^2 / 2. Where it would become negative, an eighth of the water stays in this round. */
static void take_step(struct aquifer *a, const double *w)
{
    for (size_t c = 0; c < cells_of(a); c++) {
        if (a->conductivity[c] == 0 || a->full[c])
            continue;
        const double b = a->thick[c], to = b * b + 2 * w[c] / a->scale[c];
        a->thick[c] = fmax(to > 0 ? sqrt(to) : b / 8, THIN);
        if (a->thick[c] >= a->room[c]) {
            a->thick[c] = fmax(a->room[c], THIN);
            a->full[c] = 1;
        }
    }
}

void aquifer_solve(struct aquifer *a, struct fivepoint_solver *solver, int most)
{
    const size_t n = cells_of(a);
    struct fivepoint *A = fivepoint_matrix(solver);
    double *left = a->over, sum = 0;
    memset(a->full, 0, n);
    for (size_t c = 0; c < n; c++) {
        a->thick[c] = a->conductivity[c] > 0 ? fmax(a->room[c], THIN) : 0;
        sum += a->recharge[c];
    }
    for (a->rounds = 0;; a->rounds++) {
        a->left = balances(a, A, left) / fmax(sum, 1e-300);
        if (a->left <= AQUIFER_LEFT || a->rounds >= most)
            break;
        if (free_some(a, left))
            balances(a, A, left);
        for (size_t c = 0; c < n; c++)
            left[c] = a->full[c] ? 0 : left[c];
        scale_up(a, A);
        fivepoint_solve(solver, left, a->step, LINEAR, LINEAR_MOST);
        take_step(a, a->step);
    }
    for (size_t c = 0; c < n; c++)
        a->over[c] = a->full[c] ? fmax(left[c], 0) : 0;
}
