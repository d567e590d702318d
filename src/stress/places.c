#include "stress/places.h"

static const enum rock_field fields[] = {ROCK_P, ROCK_stress, ROCK_von_mises};

status stress_places_begin(struct gpu *gpu, struct elastic *e, struct stress_places *s)
{
    status st = OK;
    *s = (struct stress_places){.e = e, .at = {.n_max = PLACES_MOST}};
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        TRY(gpu_buffer_create(gpu, rock_field_table[fields[i]].name, PLACES_MOST, rock_field_size(fields[i]),
                              &s->at.field[fields[i]]));
done:
    return st;
}

void stress_places_end(struct gpu *gpu, struct stress_places *s)
{
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        gpu_buffer_destroy(gpu, &s->at.field[fields[i]]);
}

status stress_places_find(struct gpu *gpu, struct stress_places *s, const float *P, size_t n)
{
    status st = OK;
    s->at.n = n;
    TRY(gpu_upload(gpu, s->at.field[ROCK_P], 0, P, n));
    if (s->recovered)
        elastic_sample(gpu, s->e, &s->at);
    else /* writing a checkpoint may have overwritten the recovered stress */
        elastic_recover(gpu, s->e, &s->at);
    s->recovered = true;
done:
    return st;
}
