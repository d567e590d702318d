/* Arches beside the paper's own times (Peytavie et al. 2009, table 2, a machine of its year): tiles of rocks and
 * placing them, and an edit of the cave scene at full size. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "piles/piles.h"
#include "stacks/operations.h"
#include "stacks/stabilise.h"

static const struct material table[] = {{"air", 90, 0, {0}},
                                        {"bedrock", 90, 1, {0}},
                                        {"sand", 32, 1, {0}},
                                        {"rock", 42, 1, {0}},
                                        {"water", 0, 0, {0}}};
enum { N_TABLE = 5 };

static double none(const void *user, double scale, double flatten, const double x[3])
{
    (void)user;
    (void)flatten;
    return sin(x[0] / scale) * sin(x[1] / scale) * sin(x[2] / scale);
}

/* Two layers of rocks a few sizes thick over part of the ground. */
static size_t layers(void *user, double x, double y, double (*span)[2], size_t most)
{
    const double *size = user;
    (void)y;
    if (most < 1 || x > size[0])
        return 0;
    span[0][0] = 3;
    span[0][1] = 6;
    return 1;
}

static void rocks(const char *name, size_t n, double area, double paper_tile, double paper_place)
{
    struct pile_tile tile;
    struct pile_place *place;
    struct pile_options options = {
        .radius = 0.5, .rocks = n, .erosion = 0.25, .contacts = 1, .detail = 3, .seed = 1};
    size_t n_places;
    double size[2] = {area, area};
    char tile_name[64], place_name[64];
    snprintf(tile_name, sizeof tile_name, "arches: a tile of %zu rocks, %s", n, name);
    snprintf(place_name, sizeof place_name, "arches: rocks of the %s placed", name);
    struct row tiled = {.name = tile_name,
                        .unit = "CPU s",
                        .peer = "the paper, 2009",
                        .theirs = once(paper_tile),
                        .at_least = 1};
    struct row placed = {.name = place_name,
                         .unit = "CPU s",
                         .peer = "the paper, 2009",
                         .theirs = once(paper_place),
                         .at_least = 1};
    double t0 = clock_cpu_seconds();
    check(pile_tile_create(&options, &tile));
    double t1 = clock_cpu_seconds();
    check(pile_place_all(&tile, size, layers, size, &place, &n_places));
    sample(&tiled.ours, t1 - t0);
    sample(&placed.ours, clock_cpu_seconds() - t1);
    print_row(&tiled);
    print_row(&placed);
    free(place);
    pile_tile_destroy(&tile);
}

static status fill(void *user, int i, int j, struct column *c)
{
    const struct stacks *s = user;
    /* Nowhere steeper than sand rests at. */
    double z = 550 + 12 * sin(i * 0.02) * sin(j * 0.03);
    status st = column_set(c, 0, stacks_quanta(s, z), MATERIAL_BEDROCK);
    return st == OK ? column_set(c, stacks_quanta(s, z), stacks_quanta(s, z + 2), MATERIAL_SAND) : st;
}

static void edit(void)
{
    struct stacks s;
    check(stacks_create((const int[]){1000, 750}, 1, 1000, &s));
    check(stacks_edit(&s, (const int[]){0, 0}, s.n, fill, &s));
    double at[4][4] = {{20, 100, 550, 12}, {350, 500, 320, 14}, {700, 250, 290, 12}, {980, 600, 310, 12}};
    char material[] = "";
    struct tools tools = {table, N_TABLE, s.cell, none, NULL};
    struct job_operation op = {.tool = TOOL_SWEEP,
                               .frames = {1, 1, 1},
                               .points_m = at,
                               .n_points_m = 4,
                               .material = material,
                               .travel = true,
                               .strength = 1,
                               .scale_m = 5,
                               .flatten = 1};
    int lo[2], hi[2];
    struct stabilise options = {.table = table, .n_materials = N_TABLE};
    struct stabilised out;
    double t0 = clock_seconds();
    check(operation_apply(&s, &tools, &op, "bench", 1, lo, hi));
    double t1 = clock_seconds();
    check(stabilise(&s, &options, lo, hi, &out));
    double t2 = clock_seconds();
    print_row(&(struct row){.name = "arches: a tunnel of 1200 m swept through 1000 x 750 stacks",
                            .unit = "s",
                            .ours = once(t1 - t0)});
    print_row(
        &(struct row){.name = "arches: the same terrain stabilised", .unit = "s", .ours = once(t2 - t1)});
    stacks_destroy(&s);
}

int main(void)
{
    rocks("cave", 50, 43, 30.2, 0.6);
    rocks("canyon", 70, 74, 44.1, 0.9);
    rocks("cliff", 50, 52, 19.0, 0.4);
    edit();
    return 0;
}
