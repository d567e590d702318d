/* The table of values: what its rows promise each other, and that nobody who walks it has a list of their own. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/choice.h"
#include "base/memory.h"
#include "field/field.h"
#include "render/show.h"
#include "stacks/material.h"
#include "system/atomic_file.h"
#include "usd/usd.h"
#include "vdb/vdb.h"

#define COLOR_CHOICE (COLOR_RED, "red")(COLOR_16, "16bit")(COLOR_NONE, "not-any")
enum { CHOICE_CONSTANTS(COLOR_CHOICE) COLORS };

static void constants_and_words_of_a_choice_agree(void **state)
{
    (void)state;
    static const char *const words[] = {CHOICE_LIST(COLOR_CHOICE)};
    assert_int_equal(COLORS, 3);
    assert_int_equal(sizeof words / sizeof *words, COLORS);
    assert_string_equal(words[COLOR_16], "16bit");
    assert_string_equal(CHOICE_TEXT(COLOR_CHOICE), "red|16bit|not-any");
}

static void rows_hold_together(void **state)
{
    (void)state;
    for (int i = 1; i < VALUES; i++) {
        const struct value *v = &value_table[i];
        const int f = value_field[i];
        const struct rock_field_info *field = f >= 0 ? &rock_field_table[f] : NULL;
        print_message("# %s\n", v->name);
        assert_int_equal(value_of_name(v->name), i);
        assert_true((v->channel[0] != NULL) == ((v->where & IN_PICTURES) != 0));
        assert_true((v->channel[0] != NULL) == (*v->layer != '\0'));
        assert_true((v->legend.unit != NULL) == ((v->where & IN_SHOW) != 0));
        assert_true(v->legend.unit == NULL || v->legend.low < v->legend.high);
        assert_true(!(v->where & IN_MESHES) || (v->where & IN_VOLUMES));
        assert_true((v->from == FROM_MEANS) == (field_mean((enum value_id)i) >= 0));
        assert_true((v->from == FROM_TERRAIN) == (value_material[i] != MATERIAL_AIR));
        if (field)
            assert_string_equal(v->unit, field->unit);
        if (v->from == FROM_SKIN || v->from == FROM_NEAREST || (v->where & IN_USD)) {
            assert_non_null(field);
            assert_int_equal(field->components, 1);
            assert_int_equal(field->is_float, v->kind != KIND_ID);
        }
        /* Means are of numbers. */
        assert_true(!(v->where & IN_VOLUMES) || (v->from != FROM_NEAREST && v->kind != KIND_ID));
        /* What is shown and no grid comes from the points. */
        if ((v->where & IN_SHOW) && !(v->where & IN_VOLUMES)) {
            assert_non_null(field);
            assert_true(*field->vdb != '\0' && (field->is_float || v->kind == KIND_ID) &&
                        field->components == 1);
        }
    }
}

static void a_frame_takes_each_grid_once(void **state)
{
    (void)state;
    struct frame_grids grids = {0};
    struct frame_grid *grid;
    for (int v = 1; v < VALUES; v++) {
        assert_ok(frame_grids_add(&grids, (enum value_id)v, &grid));
        assert_string_equal(grid->name, value_table[v].name);
        assert_int_equal(frame_grids_add(&grids, (enum value_id)v, &grid), E_OUTPUT);
    }
    grids.n_grids = sizeof grids.grid / sizeof *grids.grid;
    grids.grid[0].name = "another"; /* as many as there can be, and room for none */
    for (size_t g = 1; g < grids.n_grids; g++)
        grids.grid[g].name = "another";
    assert_int_equal(frame_grids_add(&grids, VALUE_stress, &grid), E_OUTPUT);
}

/* Written, and read by its name in the table. */
static void every_grid_comes_back(void **state)
{
    (void)state;
    enum { SIDE = 8, SAMPLES = SIDE * SIDE * SIDE };
    static float value[VALUES][3 * SAMPLES];
    struct frame_grids in, out;
    uint32_t *number = NULL;
    const struct vdb_options options = {.up = OUTPUT_UP_Y, .spacing = 0.5, .frame = 1};
    struct draft bytes = {0};
    assert_ok(frame_grids_begin(&(struct grid_lattice){{SIDE, SIDE, SIDE}, 0.5, {0}}, &in));
    assert_ok(memory_alloc(1, sizeof *number, "bricks", &number));
    frame_grids_choose(&in, &number, 1);
    for (int v = 1; v < VALUES; v++) {
        struct frame_grid *grid;
        if (!(value_table[v].where & IN_VOLUMES))
            continue;
        assert_ok(frame_grids_add(&in, (enum value_id)v, &grid));
        grid->value = value[v];
        for (size_t i = 0; i < 3 * SAMPLES; i++)
            value[v][i] = grid->kind == GRID_FOG ? 0.5F : (float)(v + 1) * (float)(i % 7 + 1) * 0.01F;
    }
    assert_ok(vdb_volumes(&in, &options, &bytes));
    assert_ok(atomic_file_write("all.vdb", bytes.bytes, bytes.size));
    draft_drop(&bytes);
    assert_ok(vdb_volumes_read("all.vdb", &out));
    assert_int_equal(out.n_grids, in.n_grids);
    for (size_t g = 0; g < in.n_grids; g++) {
        assert_string_equal(out.grid[g].name, in.grid[g].name);
        assert_int_equal(out.grid[g].kind, in.grid[g].kind);
        assert_int_equal(out.grid[g].components, in.grid[g].components);
        if (in.grid[g].kind != GRID_LEVEL_SET)
            assert_memory_equal(out.grid[g].value, in.grid[g].value,
                                SAMPLES * (size_t)in.grid[g].components * sizeof(float));
    }
    frame_grids_free(&out);
    for (size_t g = 0; g < in.n_grids; g++)
        in.grid[g].value = NULL;
    frame_grids_free(&in);
}

static void words_and_primvars_are_the_tables(void **state)
{
    (void)state;
    char words[SHOW_WORDS];
    const char *name[VALUES];
    const size_t n = value_names(IN_SHOW, name);
    assert_true(n > 0);
    show_words(words);
    int number = 0;
    for (char *w = strtok(words, "|"); w; w = strtok(NULL, "|"), number++)
        assert_string_equal(number ? w : "", value_table[show_of_word(number)].name);
    assert_int_equal(number, n + 1);
    const struct usd_prim *prim = usd_points_prim(false);
    for (int v = 1; v < VALUES; v++) {
        char primvar[64];
        int there = 0;
        snprintf(primvar, sizeof primvar, "primvars:%s", value_table[v].name);
        for (size_t i = 0; i < prim->n; i++)
            there += strcmp(prim->attribute[i].name, primvar) == 0;
        assert_int_equal(there, (value_table[v].where & IN_USD) != 0);
    }
    for (size_t i = 1; i < prim->n; i++)
        assert_true(strcmp(prim->attribute[i - 1].name, prim->attribute[i].name) < 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants_and_words_of_a_choice_agree), cmocka_unit_test(rows_hold_together),
        cmocka_unit_test(a_frame_takes_each_grid_once),          cmocka_unit_test(every_grid_comes_back),
        cmocka_unit_test(words_and_primvars_are_the_tables),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
