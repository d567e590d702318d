/* Frames back from their files. */
#include <stdlib.h>
#include <string.h>

#include "output/vdb.h"
#include "output/vdb_serve.h"
#include "reader/reader.h"

/* How many voxels; false if that is no number of voxels. */
static bool count(const int32_t n[3], size_t *out)
{
    for (int a = 0; a < 3; a++)
        if (n[a] < 1 || n[a] > 1 << 20)
            return false;
    *out = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    return true;
}

static status take_grid(struct reader_answer *answer, const struct vdb_part_grid *part, enum value_id value,
                        size_t voxels, struct frame_grids *grids)
{
    struct frame_grid *g = NULL;
    status st = frame_grids_add(grids, value, &g);
    if (st != OK)
        return st;
    g->kind = (enum grid_class)part->kind;
    g->components = part->components;
    if (part->own_n[0]) {
        g->own.voxel = part->own_voxel;
        memcpy(g->own.n, part->own_n, sizeof g->own.n);
        memcpy(g->own.origin, part->own_origin, sizeof g->own.origin);
        if (!count(part->own_n, &voxels))
            return reader_nonsense(answer);
    }
    return reader_take_array(answer, voxels, (size_t)part->components * sizeof *g->value, &g->value);
}

static bool makes_sense(const struct vdb_part_volumes *part, size_t n_words)
{
    bool good = part->n_grids <= VDB_PART_GRIDS;
    for (uint32_t i = 0; good && i < part->n_grids; i++) {
        const struct vdb_part_grid *g = &part->grid[i];
        good = g->word < n_words && (g->components == 1 || g->components == 3) && g->kind >= GRID_LEVEL_SET &&
               g->kind <= GRID_PLAIN;
    }
    return good;
}

status vdb_volumes_read(const char *path, struct frame_grids *out)
{
    status st = OK;
    struct reader_answer answer = {0};
    struct vdb_part_volumes part;
    const char *word[VALUES + 1] = {NULL};
    enum value_id value[VALUES];
    size_t voxels = 0, n_words = 0;
    *out = (struct frame_grids){0};
    for (int v = 1; v < VALUES; v++)
        if (value_table[v].where & IN_VOLUMES) {
            value[n_words] = (enum value_id)v;
            word[n_words++] = value_table[v].name;
        }
    TRY(reader_ask(
        &(struct reader_question){
            .program = "hoodoo-read", .kind = "vdb.volumes", .path = path, .word = word},
        &answer));
    TRY(reader_take(&answer, &part, sizeof part));
    if (!makes_sense(&part, n_words) || !count(part.n, &voxels)) {
        st = reader_nonsense(&answer);
        goto done;
    }
    memcpy(out->n, part.n, sizeof out->n);
    memcpy(out->origin, part.origin, sizeof out->origin);
    out->voxel = part.voxel;
    for (uint32_t i = 0; i < part.n_grids; i++)
        TRY(take_grid(&answer, &part.grid[i], value[part.grid[i].word], voxels, out));
done:
    reader_end(&answer);
    if (st != OK)
        vdb_volumes_free(out);
    return st;
}

void vdb_volumes_free(struct frame_grids *grids)
{
    for (size_t i = 0; i < grids->n_grids; i++)
        free(grids->grid[i].value);
    *grids = (struct frame_grids){0};
}

status vdb_points_read(const char *path, struct rock *out)
{
    status st = OK;
    struct reader_answer answer = {0};
    struct vdb_part_points part;
    *out = (struct rock){0};
    TRY(reader_ask(&(struct reader_question){.program = "hoodoo-read", .kind = "vdb.points", .path = path},
                   &answer));
    TRY(reader_take(&answer, &part, sizeof part));
    if (!part.has[ROCK_P] || part.n > SIZE_MAX) {
        st = reader_nonsense(&answer);
        goto done;
    }
    out->n = (size_t)part.n;
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (part.has[f])
            TRY(reader_take_array(&answer, out->n, rock_field_size((enum rock_field)f), &out->field[f]));
done:
    reader_end(&answer);
    if (st != OK)
        rock_free(out);
    return st;
}
