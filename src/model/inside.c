#include "model/inside.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "job/values.h"

/* A batch of positions, and where their values are to be stored. */
struct asking {
    struct gpu *gpu;
    struct stress_places places;
    size_t n;
    float *P, *value;
    float **stress, **von_mises; /* [PLACES_MOST] */
};

/* Stores one of the two values of the batch. */
static status hand_out(struct asking *a, enum rock_field value, float **to)
{
    status st = OK;
    TRY(gpu_download(a->gpu, a->places.at.field[value], 0, a->value, a->n));
    for (size_t i = 0; i < a->n; i++)
        *to[i] = a->value[i];
done:
    return st;
}

static status answer(struct asking *a)
{
    status st = OK;
    if (a->n == 0)
        return OK;
    TRY(stress_places_find(a->gpu, &a->places, a->P, a->n));
    TRY(hand_out(a, ROCK_stress, a->stress));
    TRY(hand_out(a, ROCK_von_mises, a->von_mises));
    a->n = 0;
done:
    return st;
}

/* Adds a sample of the lattice, which may lie between its points, to the batch. */
static status ask(struct asking *a, const struct grid_lattice *l, const double sample[3], float *stress,
                  float *von_mises)
{
    float *P = a->P + 4 * a->n;
    for (int i = 0; i < 3; i++)
        P[i] = (float)(l->origin[i] + sample[i] * l->voxel);
    P[3] = 0;
    a->stress[a->n] = stress;
    a->von_mises[a->n] = von_mises;
    return ++a->n == PLACES_MOST ? answer(a) : OK;
}

static status asking_begin(struct gpu *gpu, struct elastic *e, struct asking *a)
{
    status st = OK;
    *a = (struct asking){.gpu = gpu};
    TRY(stress_places_begin(gpu, e, &a->places));
    TRY(memory_alloc(4 * PLACES_MOST, sizeof *a->P, "places inside", &a->P));
    TRY(memory_alloc(PLACES_MOST, sizeof *a->value, "stress inside", &a->value));
    TRY(memory_alloc(PLACES_MOST, sizeof *a->stress, "stress inside", &a->stress));
    TRY(memory_alloc(PLACES_MOST, sizeof *a->von_mises, "stress inside", &a->von_mises));
done:
    return st;
}

static void asking_end(struct asking *a)
{
    stress_places_end(a->gpu, &a->places);
    free(a->P);
    free(a->value);
    free(a->stress);
    free(a->von_mises);
}

static void first_of(const struct frame_grids *grids, size_t brick, double first[3])
{
    const size_t nx = (size_t)grids->bricks.n[0], ny = (size_t)grids->bricks.n[1];
    const size_t at[3] = {brick % nx, brick / nx % ny, brick / nx / ny};
    for (int a = 0; a < 3; a++)
        first[a] = (double)(BRICK_SIDE * at[a]);
}

/* Adds the samples of kept bricks that are rock but have no value yet. */
static status ask_samples(struct asking *a, const struct frame_grids *grids, const float *density,
                          float *stress, float *von_mises)
{
    status st = OK;
    for (size_t b = 0; b < grids->bricks.count; b++) {
        double first[3];
        first_of(grids, grids->bricks.number[b], first);
        for (size_t s = 0; s < BRICK_SAMPLES; s++) {
            const size_t i = b * BRICK_SAMPLES + s;
            const double at[3] = {first[0] + (double)(s % 8), first[1] + (double)(s / 8 % 8),
                                  first[2] + (double)(s / 64)};
            if (density[i] > 0 && stress[i] == 0 && von_mises[i] == 0)
                TRY(ask(a, &grids->lattice, at, &stress[i], &von_mises[i]));
        }
    }
done:
    return st;
}

/* Adds the centres of bricks that are not kept because they are inside. */
static status ask_bricks(struct asking *a, const struct frame_grids *grids, size_t n, float *stress,
                         float *von_mises)
{
    status st = OK;
    for (size_t b = 0; b < n; b++) {
        double middle[3];
        if (grids->bricks.slot[b] != BRICK_INSIDE)
            continue;
        first_of(grids, b, middle);
        for (int i = 0; i < 3; i++)
            middle[i] += (BRICK_SIDE - 1) / 2.0;
        TRY(ask(a, &grids->lattice, middle, &stress[b], &von_mises[b]));
    }
done:
    return st;
}

static struct frame_grid *named(struct frame_grids *grids, enum value_id value)
{
    for (size_t g = 0; g < grids->n_grids; g++)
        if (strcmp(grids->grid[g].name, value_table[value].name) == 0)
            return &grids->grid[g];
    return NULL;
}

status inside_values(struct gpu *gpu, struct elastic *e, struct frame_grids *grids)
{
    status st = OK;
    struct asking a = {.gpu = gpu};
    struct frame_grid *stress = named(grids, VALUE_stress), *mises = named(grids, VALUE_von_mises),
                      *viability = named(grids, VALUE_viability);
    const struct frame_grid *density = named(grids, VALUE_density);
    float *share = NULL;
    const size_t n = (size_t)grids->bricks.n[0] * (size_t)grids->bricks.n[1] * (size_t)grids->bricks.n[2];
    if (viability) /* no rock was removed there */
        viability->inside = 1;
    if (!stress || !mises || !density || e->lattice.n_active == 0)
        return OK;
    TRY(memory_alloc(n, sizeof *stress->deep, "stress inside", &stress->deep));
    TRY(memory_alloc(n, sizeof *mises->deep, "stress inside", &mises->deep));
    TRY(frame_grid_read(grids, stress));
    TRY(frame_grid_read(grids, mises));
    TRY(grids->source.read(grids->source.user, density, &share));
    TRY(asking_begin(gpu, e, &a));
    TRY(ask_samples(&a, grids, share, stress->value, mises->value));
    TRY(ask_bricks(&a, grids, n, stress->deep, mises->deep));
    TRY(answer(&a));
done:
    asking_end(&a);
    free(share);
    return st;
}
