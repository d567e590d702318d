/* One step of a million material points on 128^3 cells: particles to grid, grid, grid to particles, for rock that breaks and
 * slides, on the device and in plain C. peers/taichi_mpm.py times Taichi's example at the same size. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "mpm/internal.h"

enum { CELLS = 128, SIDE = 100 }; /* 100^3 particles: 50^3 cells of them */

/* ---- plain C */

#pragma GCC push_options
#pragma GCC optimize("O3", "fast-math")
#if defined(__x86_64__)
#pragma GCC target("avx2,fma")
#endif

struct point {
    float x[3], v[3], Q[3][3], H[3][3]; /* Q and H by columns */
    float share, apart, strength;
};

struct rock_c {
    int n[3]; /* nodes */
    float dx, dt, lambda, mu, viscosity, push, mass, gravity, alpha, rebound;
};

static void weights(float f, float w[3])
{
    w[0] = 0.5f * (1.5f - f) * (1.5f - f);
    w[1] = 0.75f - (f - 1) * (f - 1);
    w[2] = 0.5f * (f - 0.5f) * (f - 0.5f);
}

/* One cell's points, sorted, to its 27 nodes. */
static void scatter_cell(const struct rock_c *r, const struct point *p, size_t n, const int home[3],
                         float (*grid)[4])
{
    float sum[27][4] = {{0}};
    for (size_t s = 0; s < n; s++) {
        float f[3], w[3][3], v[3], m = r->mass * p[s].share;
        for (int a = 0; a < 3; a++) {
            f[a] = p[s].x[a] / r->dx + (a == 2 ? 0.75f : 0) - (float)(home[a] - 1);
            weights(f[a], w[a]);
        }
        for (int a = 0; a < 3; a++)
            v[a] = p[s].v[a] - r->dx * (f[0] * p[s].Q[0][a] + f[1] * p[s].Q[1][a] + f[2] * p[s].Q[2][a]);
        for (int z = 0; z < 3; z++)
            for (int y = 0; y < 3; y++) {
                float row[4] = {0, 0, 0, 1}, step[4] = {0};
                for (int a = 0; a < 3; a++) {
                    row[a] = v[a] + r->dx * ((float)y * p[s].Q[1][a] + (float)z * p[s].Q[2][a]);
                    step[a] = r->dx * p[s].Q[0][a];
                }
                for (int x = 0; x < 3; x++) {
                    float share = m * w[2][z] * w[1][y] * w[0][x];
                    for (int a = 0; a < 4; a++)
                        sum[z * 9 + y * 3 + x][a] += share * (row[a] + (float)x * step[a]);
                }
            }
    }
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 3; y++)
            for (int x = 0; x < 3; x++)
                for (int a = 0; a < 4; a++)
                    grid[((home[2] + z) * r->n[1] + home[1] + y) * r->n[0] + home[0] + x][a] +=
                        sum[z * 9 + y * 3 + x][a];
}

static void multiply(float a[3][3], float b[3][3], float out[3][3]) /* columns */
{
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            out[j][i] = a[0][i] * b[j][0] + a[1][i] * b[j][1] + a[2][i] * b[j][2];
}

static float cofactors(float m[3][3], float out[3][3])
{
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            int r = (i + 1) % 3, s = (i + 2) % 3, u = (j + 1) % 3, v = (j + 2) % 3;
            out[j][i] = m[u][r] * m[v][s] - m[u][s] * m[v][r];
        }
    return m[0][0] * out[0][0] + m[0][1] * out[0][1] + m[0][2] * out[0][2];
}

static void move_point(const struct rock_c *r, struct point *p, float (*grid)[4])
{
    int home[3];
    float f[3], w[3][3], v[3] = {0}, g[3][3] = {{0}}, F[3][3], R[3][3], S[3][3], t[3][3], stress[3][3];
    for (int a = 0; a < 3; a++) {
        float at = p->x[a] / r->dx + (a == 2 ? 0.75f : 0);
        home[a] = (int)(at - 0.5f) + 1;
        f[a] = at - (float)(home[a] - 1);
        weights(f[a], w[a]);
    }
    for (int z = 0; z < 3; z++) {
        float v2[3] = {0}, gx2[3] = {0}, gy2[3] = {0};
        for (int y = 0; y < 3; y++) {
            float(*row)[4] = grid + ((home[2] + z) * r->n[1] + home[1] + y) * r->n[0] + home[0];
            for (int a = 0; a < 3; a++) {
                float b = w[0][1] * row[1][a], c = w[0][2] * row[2][a], v1 = w[0][0] * row[0][a] + b + c;
                v2[a] += w[1][y] * v1;
                gx2[a] += w[1][y] * (b + 2 * c - f[0] * v1);
                gy2[a] += w[1][y] * ((float)y - f[1]) * v1;
            }
        }
        for (int a = 0; a < 3; a++) {
            v[a] += w[2][z] * v2[a];
            g[0][a] += w[2][z] * gx2[a];
            g[1][a] += w[2][z] * gy2[a];
            g[2][a] += w[2][z] * ((float)z - f[2]) * v2[a];
        }
    }
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            g[j][i] *= 4 / r->dx;
    multiply(g, p->H, t);
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            p->H[j][i] += r->dt * (g[j][i] + t[j][i]);
            R[j][i] = F[j][i] = p->H[j][i] + (i == j);
        }
    for (int step = 0; step < 4; step++) {
        float inverse = 1 / cofactors(R, t);
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++)
                R[j][i] = 0.5f * (R[j][i] + t[j][i] * inverse);
    }
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            S[j][i] = R[i][0] * F[j][0] + R[i][1] * F[j][1] + R[i][2] * F[j][2] - (i == j);
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < j; i++)
            S[j][i] = S[i][j] = 0.5f * (S[j][i] + S[i][j]);
    float trace = S[0][0] + S[1][1] + S[2][2];
    float j1 = trace + S[0][0] * S[1][1] - S[0][1] * S[1][0] + S[1][1] * S[2][2] - S[1][2] * S[2][1] +
               S[0][0] * S[2][2] - S[0][2] * S[2][0] + cofactors(S, t);
    multiply(S, S, t);
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            stress[j][i] = 2 * r->mu * (S[j][i] + t[j][i]) + (i == j) * r->lambda * j1 * (1 + j1);
    if (p->apart < 0) {
        float q = (stress[0][0] + stress[1][1] + stress[2][2]) / 3, d[3][3], two = 0;
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++) {
                d[j][i] = stress[j][i] - (i == j) * q;
                two += d[j][i] * d[j][i];
            }
        float size = sqrtf(two / 6), det = cofactors(d, t);
        if (size > 0 &&
            q + 2 * size * cosf(acosf(fmaxf(-1, fminf(1, 0.5f * det / (size * size * size)))) / 3) >
                p->strength)
            p->apart = 0;
    }
    if (p->apart >= 0) { /* as in slide(), shaders/mpm/rock.glsl */
        float both = trace + p->apart, size = 0, left = 0;
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++) {
                float d = S[j][i] - (i == j) * trace / 3;
                size += d * d;
            }
        size = sqrtf(size);
        p->apart = fmaxf(both, 0);
        float allowed = -r->alpha * (3 * r->lambda + 2 * r->mu) / (2 * r->mu) * fminf(both, 0);
        left = both >= 0 ? 0 : size > allowed ? allowed / size : 1;
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++)
                S[j][i] = left * (S[j][i] - (i == j) * trace / 3) + (i == j) * fminf(both, 0) / 3;
        multiply(R, S, t);
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++)
                p->H[j][i] = t[j][i] + R[j][i] - (i == j);
        j1 = fminf(both, 0);
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++)
                stress[j][i] = 2 * r->mu * S[j][i] + (i == j) * r->lambda * j1 * (1 + j1);
    }
    multiply(R, stress, t);
    float tau[3][3], power = 0, size = 0;
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            tau[j][i] = t[0][i] * R[0][j] + t[1][i] * R[1][j] + t[2][i] * R[2][j];
            power += tau[j][i] * g[j][i];
            size += tau[j][i] * tau[j][i];
        }
    size = sqrtf(size);
    float back = size > 0 ? fminf(1, fmaxf(0, -power / (size * MPM_REBOUND_RATE))) : 0;
    float give = 1 + back * (r->rebound - 1);
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            p->Q[j][i] = g[j][i] - r->dt * r->push * (give * tau[j][i] + r->viscosity * (g[j][i] + g[i][j]));
    for (int a = 0; a < 3; a++) {
        p->v[a] = v[a];
        p->x[a] += r->dt * v[a];
    }
}

static void step_in_c(const struct rock_c *r, struct point *p, size_t n, const uint32_t *start,
                      float (*grid)[4])
{
    long nodes = (long)r->n[0] * r->n[1] * r->n[2], slab = (long)r->n[0] * r->n[1];
#pragma omp parallel
    {
#pragma omp for schedule(static)
        for (long c = 0; c < nodes; c++)
            memset(grid[c], 0, sizeof *grid);
        /* Slabs three apart share no node. */
        for (int color = 0; color < 3; color++) {
#pragma omp for schedule(dynamic)
            for (int z = color; z < r->n[2] - 2; z += 3)
                for (long c = z * slab; c < (z + 1) * slab; c++)
                    if (start[c + 1] > start[c]) {
                        const int home[3] = {(int)(c % r->n[0]), (int)(c / r->n[0] % r->n[1]), z};
                        scatter_cell(r, p + start[c], start[c + 1] - start[c], home, grid);
                    }
        }
#pragma omp for schedule(static)
        for (long c = 0; c < nodes; c++)
            if (grid[c][3] > 0) {
                for (int a = 0; a < 3; a++)
                    grid[c][a] /= grid[c][3];
                grid[c][2] -= r->gravity * r->dt;
                if (c < 2 * slab)
                    grid[c][2] = fmaxf(grid[c][2], 0);
            }
#pragma omp for schedule(static)
        for (size_t i = 0; i < n; i++)
            move_point(r, p + i, grid);
    }
}
#pragma GCC pop_options

/* ---- both */

static void compare(void)
{
    struct gpu *gpu = NULL;
    struct gpu_work *work = NULL;
    struct mpm m = {0};
    const int voxels[3] = {2 * CELLS, 2 * CELLS, 2 * CELLS};
    const size_t n = (size_t)SIDE * SIDE * SIDE, nodes = mpm_nodes(voxels);
    struct mpm_options o = {.lambda = 12e9,
                            .mu = 15e9,
                            .density = 2300,
                            .gravity = 9.81,
                            .cfl = 0.4,
                            .viscosity = 0.1,
                            .rebound = 0.1,
                            .friction = 0.6,
                            .repose_deg = 36,
                            .strength = 1e5,
                            .lift = 0.75};
    mpm_soften(&o, 200);
    check(gpu_create(&(struct gpu_options){.device = "auto"}, &gpu));
    check(gpu_work_create(gpu, nodes + 2, &work));
    check(mpm_create(gpu, voxels, 0.5, n, &o, &m));
    float *place = need(n, 16), *speed = need(n, 16), *word = need(n, 4);
    uint32_t *id = need(n, 4), *order = need(n, 4), *start = need(nodes + 2, 4);
    struct point *p = need(n, sizeof *p);
    for (size_t i = 0; i < n; i++) {
        const size_t at[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
        for (size_t a = 0; a < 3; a++) {
            place[4 * i + a] = (float)(14 + 0.5 * (double)at[a] + 0.25 + 0.1 * sin((double)(7 * i + a)));
            speed[4 * i + a] = (float)(0.5 * sin(0.05 * (double)at[a]));
        }
        id[i] = (uint32_t)i;
        word[i] = 1;
    }
    m.n = n;
    check(gpu_upload(gpu, m.vector[MPM_PLACE], 0, place, n));
    check(gpu_upload(gpu, m.vector[MPM_VELOCITY], 0, speed, n));
    check(gpu_upload(gpu, m.word[MPM_SHARE], 0, word, n));
    for (size_t i = 0; i < n; i++)
        word[i] = i % 4 ? -1.0f : 0.0f; /* a quarter broken */
    check(gpu_upload(gpu, m.word[MPM_APART], 0, word, n));
    for (size_t i = 0; i < n; i++)
        word[i] = 1e5f;
    check(gpu_upload(gpu, m.word[MPM_STRENGTH], 0, word, n));
    check(gpu_upload(gpu, m.word[MPM_ID], 0, id, n));
    check(mpm_sort(gpu, work, &m));
    check(gpu_download(gpu, m.word[MPM_ID], 0, order, n));
    check(gpu_download(gpu, m.start, 0, start, nodes + 1));
    for (size_t i = 0; i < n; i++) {
        memcpy(p[i].x, place + 4 * order[i], 12);
        memcpy(p[i].v, speed + 4 * order[i], 12);
        p[i].share = 1;
        p[i].apart = order[i] % 4 ? -1.0f : 0.0f;
        p[i].strength = 1e5f;
    }
    const double dt = 1e-3;
    const struct mpm_params k = mpm_params_of(&m, n, dt);
    const struct rock_c r = {.n = {CELLS + 3, CELLS + 3, CELLS + 3},
                             .dx = k.dx,
                             .dt = k.dt,
                             .lambda = k.lambda,
                             .mu = k.mu,
                             .viscosity = k.viscosity,
                             .push = k.push,
                             .mass = k.mass,
                             .gravity = k.gravity,
                             .alpha = k.alpha,
                             .rebound = k.rebound};
    float(*grid)[4] = need(nodes, 16);
    struct row step = {.name = "mpm: a step of a million points",
                       .unit = "ms",
                       .peer = "plain C, OpenMP",
                       .at_least = 0.62},
               sort = {.name = "mpm: a sort of a million points", .unit = "ms"};
    double error = 0;
    for (int i = 0; i <= BENCH_REPEATS; i++) { /* the first compiles */
        double begin = clock_seconds();
        mpm_step(gpu, &m, &k, false);
        check(gpu_wait(gpu));
        if (i > 0)
            sample(&step.ours, 1e3 * (clock_seconds() - begin));
        begin = clock_seconds();
        step_in_c(&r, p, n, start, grid);
        if (i > 0)
            sample(&step.theirs, 1e3 * (clock_seconds() - begin));
    }
    check(gpu_download(gpu, m.vector[MPM_VELOCITY], 0, speed, n));
    for (size_t i = 0; i < n; i++)
        for (size_t a = 0; a < 3; a++)
            error = fmax(error, fabs((double)(speed[4 * i + a] - p[i].v[a])));
    for (int i = 0; i < BENCH_REPEATS; i++) {
        const double begin = clock_seconds();
        check(mpm_sort(gpu, work, &m));
        check(gpu_wait(gpu));
        sample(&sort.ours, 1e3 * (clock_seconds() - begin));
    }
    print_row(&step);
    print_row(&sort);
    printf("    after %d steps speeds differ by %.1g m/s\n", BENCH_REPEATS + 1, error);
    static const struct {
        enum gpu_kernel kernel;
        const char *name;
    } part[] = {{KERNEL_mpm_scatter, "scatter"}, {KERNEL_mpm_node, "node"}, {KERNEL_mpm_gather, "gather"}};
    for (size_t i = 0; i < 3; i++) {
        const struct gpu_time *t = gpu_kernel_time(gpu, part[i].kernel);
        printf("    %-12s %7.1f ms on average\n", part[i].name, 1e-6 * (double)t->ns / (double)t->dispatches);
    }
    mpm_destroy(gpu, &m);
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
    free(place);
    free(speed);
    free(word);
    free(id);
    free(order);
    free(start);
    free(p);
    free(grid);
}

int main(void)
{
    compare();
    return 0;
}
