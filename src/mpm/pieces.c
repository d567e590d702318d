/* Pieces of jointed rock: which joints have broken, and which pieces the others hold together as bodies. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "mpm/internal.h"

/* Pieces of fewer particles, two cells' worth, stay with their neighbours. */
enum { SLIVER = 16 };

/* State of a joint: no particles, holds, has parted its pieces. */
enum { NONE, HOLDS, PARTS };

/* BRITTLE: share of cracked particles at which a joint breaks. WIDTH: half the width of a joint in piece sizes, but at least
 * LEAST_WIDTH particle spacings. */
static const double BRITTLE = 0.25, WIDTH = 0.1, LEAST_WIDTH = 0.75;

static size_t count(const int n[3])
{
    return (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
}

/* Size of pieces, m: at least two cells. (From four cells on they are resolved.) */
static double size_of(double block, double dx)
{
    return block > 0 ? fmax(block, 2 * dx) : 0;
}

/* Number of seeds along an axis of `length` m. */
static int seeds(double length, double size)
{
    return (int)floor(length / size) + 3;
}

uint64_t mpm_pieces_bytes(const int voxels[3], double h, double block)
{
    double size = size_of(block, 2 * h);
    uint64_t n = size > 0;
    for (int a = 0; a < 3 && size > 0; a++)
        n *= (uint64_t)seeds(voxels[a] * h, size);
    return n * (3 * MPM_JOINTS + 1) * 4;
}

status mpm_pieces_create(struct gpu *gpu, struct mpm *m)
{
    status st = OK;
    struct mpm_pieces *s = &m->pieces;
    double size = size_of(m->options.block, m->dx);
    for (int a = 0; a < 3 && size > 0; a++)
        s->n[a] = seeds(m->cells[a] * m->dx, size);
    size_t n = count(s->n), joints = n > 0 ? n * MPM_JOINTS : 1;
    TRY(gpu_buffer_create(gpu, "mpm joints' counts", 2 * joints + n, 4, &s->counts));
    TRY(gpu_buffer_create(gpu, "mpm joints that hold", joints, 4, &s->holds));
    TRY(memory_alloc(n + 1, 4, "bodies", &s->body));
    TRY(memory_alloc(2 * joints + n, 4, "joints' counts", &s->host_counts));
    TRY(memory_alloc(joints, 4, "joints that hold", &s->host_holds));
done:
    return st;
}

void mpm_pieces_destroy(struct gpu *gpu, struct mpm *m)
{
    struct mpm_pieces *s = &m->pieces;
    gpu_buffer_destroy(gpu, &s->counts);
    gpu_buffer_destroy(gpu, &s->holds);
    free(s->host_counts);
    free(s->host_holds);
    free(s->body);
    *s = (struct mpm_pieces){0};
}

struct mpm_load_params mpm_load_params_of(const struct mpm *m, size_t n)
{
    double size = size_of(m->options.block, m->dx);
    return (struct mpm_load_params){
        .n = (uint)n,
        .seed = m->options.seed,
        .strength = (float)m->options.strength,
        .joint = (float)(m->options.strength * m->options.joint),
        .block = (float)size,
        .width = (float)(size > 0 ? fmax(WIDTH, LEAST_WIDTH * 0.5 * m->dx / size) : 0),
        .nx = (uint)m->pieces.n[0],
        .ny = (uint)m->pieces.n[1],
        .pieces = (uint)count(m->pieces.n),
    };
}

/* ---- bodies */

static uint32_t root_of(uint32_t *body, uint32_t i)
{
    while (body[i] != i)
        i = body[i] = body[body[i]];
    return i;
}

/* The piece on the other side of a joint; numbering as in shaders/mpm/load.comp.glsl. */
static uint32_t beyond(const int n[3], uint32_t joint)
{
    int d = (int)(joint % MPM_JOINTS) + 1, z = (d + 12) / 25, y = (d - 25 * z + 12) / 5 - 2,
        x = d - 25 * z - 5 * y;
    return (uint32_t)((int)(joint / MPM_JOINTS) + (z * n[1] + y) * n[0] + x);
}

bool mpm_piece_fits(const struct mpm *m, uint32_t piece)
{
    size_t n = count(m->pieces.n);
    return piece >= 1 && piece <= (n > 0 ? n : 1);
}

bool mpm_joint_fits(const struct mpm *m, uint32_t piece, uint32_t joint)
{
    const struct mpm_pieces *s = &m->pieces;
    uint32_t n = (uint32_t)count(s->n), j = joint & ~MPM_PARTED;
    if (joint == MPM_NO_JOINT)
        return true;
    if (j >= n * MPM_JOINTS || beyond(s->n, j) >= n)
        return false;
    return piece - 1 == j / MPM_JOINTS || piece - 1 == beyond(s->n, j);
}

status mpm_pieces_update(struct gpu *gpu, struct mpm *m)
{
    status st = OK;
    struct mpm_pieces *s = &m->pieces;
    uint32_t n = (uint32_t)count(s->n), *body = s->body + 1;
    struct mpm_load_params k = mpm_load_params_of(m, m->n);
    const uint32_t *of_piece = s->host_counts + 2 * (size_t)n * MPM_JOINTS;
    bool parted = false;
    if (n == 0)
        return OK;
    gpu_fill(gpu, s->counts, 0);
    GPU_RUN(gpu, mpm_crack, m->n, k, m->word[MPM_JOINT], m->word[MPM_APART], m->word[MPM_PIECE], s->counts);
    TRY(gpu_download(gpu, s->counts, 0, s->host_counts, (2 * MPM_JOINTS + 1) * (size_t)n));
    for (uint32_t i = 0; i < n; i++)
        body[i] = i;
    for (uint32_t j = 0; j < n * MPM_JOINTS; j++) {
        const uint32_t *c = s->host_counts + 2 * (size_t)j;
        if (c[1] & MPM_PARTED) {
            s->host_holds[j] = PARTS;
            parted |= c[0] > 0;
            continue;
        }
        bool sliver = c[0] > 0 && (of_piece[j / MPM_JOINTS] < SLIVER || of_piece[beyond(s->n, j)] < SLIVER);
        s->host_holds[j] = c[0] == 0 ? NONE : sliver || c[1] < BRITTLE * c[0] ? HOLDS : PARTS;
        parted |= s->host_holds[j] == PARTS;
        if (s->host_holds[j] == HOLDS) {
            uint32_t a = root_of(body, j / MPM_JOINTS), b = root_of(body, beyond(s->n, j));
            body[a < b ? b : a] = a < b ? a : b;
        }
    }
    for (uint32_t i = 0; i < n; i++)
        body[i] = root_of(body, i);
    TRY(gpu_upload(gpu, s->holds, 0, s->host_holds, (size_t)n * MPM_JOINTS));
    if (parted)
        GPU_RUN(gpu, mpm_part, m->n, k, s->holds, m->word[MPM_JOINT], m->word[MPM_APART],
                m->word[MPM_STRENGTH]);
done:
    return st;
}
