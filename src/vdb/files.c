/* Reading frames back from their files. */
#include <stdlib.h>
#include <string.h>

#include "reader/reader.h"
#include "vdb/serve.h"
#include "vdb/vdb.h"

/* The number of samples; false if the size is not one of a lattice, or has too many bricks. */
static bool count(const int32_t n[3], size_t *out)
{
    int bricks[3];
    for (int a = 0; a < 3; a++)
        if (n[a] < 1 || n[a] > 1 << 20)
            return false;
    *out = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    return grid_bricks_of(n, bricks) <= INT32_MAX;
}

static status take_grid(struct reader_answer *answer, const struct vdb_part_grid *part, enum value_id value,
                        struct frame_grids *grids)
{
    struct frame_grid *g = NULL;
    const size_t samples = grids->bricks.count * BRICK_SAMPLES;
    status st = frame_grids_add(grids, value, &g);
    if (st != OK)
        return st;
    g->kind = (enum grid_class)part->kind;
    g->components = part->components;
    return reader_take_array(answer, samples, (size_t)part->components * sizeof *g->value, &g->value);
}

/* Takes the numbers of the bricks, which must be within the lattice and ascending. */
static status take_bricks(struct reader_answer *answer, uint64_t n, struct frame_grids *grids)
{
    status st = OK;
    uint32_t *number = NULL;
    const int *m = grids->bricks.n;
    const size_t all = (size_t)m[0] * (size_t)m[1] * (size_t)m[2];
    if (n > all)
        return reader_bad_answer(answer);
    TRY(reader_take_array(answer, (size_t)n, sizeof *number, &number));
    for (size_t i = 0; i < n; i++)
        if (number[i] >= all || (i > 0 && number[i] <= number[i - 1])) {
            st = reader_bad_answer(answer);
            goto done;
        }
    frame_grids_choose(grids, &number, (size_t)n);
done:
    free(number);
    return st;
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
    struct grid_lattice lattice = {0};
    const char *word[VALUES + 1] = {NULL};
    enum value_id value[VALUES];
    size_t voxels = 0, n_words = 0;
    *out = (struct frame_grids){0};
    for (int v = 1; v < VALUES; v++)
        if (value_table[v].where & (IN_VOLUMES | IN_AIR)) {
            value[n_words] = (enum value_id)v;
            word[n_words++] = value_table[v].name;
        }
    TRY(reader_ask(
        &(struct reader_question){
            .program = "hoodoo-read", .kind = "vdb.volumes", .path = path, .argument = word},
        &answer));
    TRY(reader_take(&answer, &part, sizeof part));
    if (!makes_sense(&part, n_words) || !count(part.n, &voxels)) {
        st = reader_bad_answer(&answer);
        goto done;
    }
    memcpy(lattice.n, part.n, sizeof lattice.n);
    memcpy(lattice.origin, part.origin, sizeof lattice.origin);
    lattice.voxel = part.voxel;
    TRY(frame_grids_begin(&lattice, out));
    TRY(take_bricks(&answer, part.n_bricks, out));
    for (uint32_t i = 0; i < part.n_grids; i++)
        TRY(take_grid(&answer, &part.grid[i], value[part.grid[i].word], out));
done:
    reader_end(&answer);
    if (st != OK)
        frame_grids_free(out);
    return st;
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
        st = reader_bad_answer(&answer);
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
