/* The state of arenite at another spacing: its sections. The rock itself: src/resample. */
#include <stdlib.h>
#include <string.h>

#include "model/arenite_deep.h"
#include "model/resampling.h"
#include "particles/held.h"

/* The checkpoint's rock and the scenes of both spacings. */
struct state {
    struct rock rock; /* borrowed from the checkpoint */
    struct idset ids;
    struct scene_source *before, *scene;
    const uint32_t *deep;
};

static void state_free(struct state *s)
{
    idset_free(&s->ids);
    scene_source_destroy(&s->before);
    scene_source_destroy(&s->scene);
}

static status read_state(const struct resampling *r, struct state *s)
{
    status st = OK;
    struct model m = {.whole = &r->before, .job = &r->before, .h = r->ratio.was.h, .ledger = r->ledger};
    memcpy(m.voxels, r->ratio.was.n, sizeof m.voxels);
    const size_t n_deep = arenite_deep_count(m.voxels, r->from);
    TRY(arenite_read_rock(&m, r->from, &s->rock, n_deep, &s->ids));
    for (size_t p = 0; p < s->rock.n; p++)
        if (s->rock.phase[p] > 1)
            return fail(
                E_CHECKPOINT,
                "the checkpoint of frame %d has falling rock, which cannot be resampled; branch from a frame in which all rock is at rest",
                r->from->frame);
    TRY(scene_source_create(&r->before, &s->before));
    TRY(scene_source_create(r->job, &s->scene));
    if (n_deep)
        TRY(arenite_read_deep(s->before, m.voxels, r->from, &s->ids, &s->deep));
done:
    return st;
}

static status add_rock(const struct rock *rock, struct checkpoint *out)
{
    status st = OK;
    void *data;
    for (int f = 0; f < ROCK_FIELDS; f++) {
        if (rock_field_table[f].keep != STATE || !rock->field[f])
            continue;
        TRY(section_add(out, rock_field_table[f].name, 4, rock->n * (size_t)rock_field_table[f].components,
                        &data));
        memcpy(data, rock->field[f], rock->n * rock_field_size((enum rock_field)f));
    }
done:
    return st;
}

static status add_deep(const struct resample_to *to, struct checkpoint *out)
{
    status st = OK;
    uint32_t *bits;
    if (voxel_set_count(&to->deep) == 0)
        return OK;
    TRY(arenite_add_deep(to->scene, to->deep.n, out, &bits));
    memcpy(bits, to->deep.bits, to->deep.words * sizeof *bits);
done:
    return st;
}

static struct ledger count(const struct resample_to *to)
{
    struct ledger l = {.start = to->n_ids, .rock = voxel_set_count(&to->deep)};
    for (size_t p = 0; p < to->rock.n; p++)
        *(to->rock.phase[p] == 1 ? &l.deposit : &l.rock) += 1;
    return l;
}

status arenite_resample(struct resampling *r)
{
    status st = OK;
    struct state s = {0};
    struct resample_to to = {0};
    TRY(read_state(r, &s));
    to.scene = s.scene;
    TRY(resample_rock(&r->ratio, &(struct resample_from){&s.rock, s.deep, s.before}, &to));
    TRY(add_rock(&to.rock, r->out));
    TRY(add_deep(&to, r->out));
    r->counts = count(&to);
    /* The stress is solved again from zero: the displacements belong to the old voxels. */
    TRY(resampling_keep(r, "iterations"));
    TRY(resampling_keep(r, "elasticity"));
    TRY(resampling_keep(r, "processes"));
    TRY(resampling_keep(r, "air"));
done:
    rock_free(&to.rock);
    voxel_set_destroy(&to.deep);
    state_free(&s);
    return st;
}
