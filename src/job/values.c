#include "job/values.h"

#include <string.h>

#define CHANNELS(...)                                                                                        \
    {                                                                                                        \
        __VA_ARGS__                                                                                          \
    }
#define NO_CHANNELS                                                                                          \
    {                                                                                                        \
        NULL                                                                                                 \
    }
#define LEGEND(unit, scale, axis, span, above, below)                                                        \
    {                                                                                                        \
        unit, scale, axis, span, above, below                                                                \
    }
#define SPAN(low, high) SPAN_FIXED, low, high
#define SPAN_BY(rule) SPAN_##rule, 0, 1
#define NO_LEGEND                                                                                            \
    {                                                                                                        \
        .scale = 1                                                                                           \
    }

const struct value value_table[VALUES] = {
    {"", "", "", "the rock as it looks", .layer = "", .legend = {"", 1, AXIS_LINEAR, SPAN(0, 1), "", ""}},
#define VALUE(name, unit, symbol, of, from, kind, has, where, bits, layer, channels, legend, meaning)        \
    {#name, unit, symbol, meaning, from, kind, has, where, bits, layer, channels, legend},
#include "job/values.def"
};

#define VALUE(name, unit, symbol, of, from, kind, has, where, bits, layer, channels, legend, meaning)        \
    _Static_assert(sizeof #name <= VALUE_NAME + 1, "names of tasks and files have room for short names "     \
                                                   "only");
#include "job/values.def"

enum value_id value_of_name(const char *name)
{
    for (int v = 1; v < VALUES; v++)
        if (strcmp(value_table[v].name, name) == 0)
            return (enum value_id)v;
    return VALUE_NONE;
}

size_t value_names(unsigned where, const char *out[VALUES])
{
    size_t n = 0;
    for (int v = 1; v < VALUES; v++)
        if (value_table[v].where & where)
            out[n++] = value_table[v].name;
    return n;
}

size_t value_layers(const char *out[VALUES])
{
    size_t n = 0;
    for (int v = 1; v < VALUES; v++) {
        const char *layer = value_table[v].layer;
        bool again = !*layer;
        for (size_t i = 0; i < n; i++)
            again |= strcmp(out[i], layer) == 0;
        if (!again)
            out[n++] = layer;
    }
    return n;
}

size_t value_grids(unsigned has)
{
    size_t n = 0;
    for (int v = 1; v < VALUES; v++)
        if ((value_table[v].where & IN_VOLUMES) && (value_table[v].has & has))
            n += value_table[v].kind == KIND_VECTOR ? 3 : 1;
    return n;
}

/* ---- the reference page */

static const char *has_words(enum value_has has)
{
    switch (has) {
    case HAS_ALWAYS:
        return "all";
    case HAS_WATER:
        return "arenite, where water runs";
    case HAS_PLANTS:
        return "arenite, where plants grow";
    case HAS_DEPOSITS:
        return "arenite, where rock is deposited";
    case HAS_WIND:
        return "arenite, where the wind is a flow";
    case HAS_TERRAIN:
        return "arches";
    case HAS_MOTION:
        return "arenite with `clock.seconds_per_frame`";
    case HAS_EXPOSED:
        return "arenite with `skin`";
    case HAS_SEEPAGE:
        return "arenite with `groundwater`";
    }
    return "";
}

void value_reference(struct text *t)
{
    static const char *const bits[] = {
        [BITS_EXACT] = "no", [BITS_HALF] = "half floats", [BITS_SHARE] = "yes", [BITS_DIRECTION] = "yes"};
    text_add(
        t,
        "\n## Values\n\n"
        "The columns volumes, meshes and channels refer to grids in `volumes/`, vertex values in `mesh/*.ply` and channels in "
        "`aov/`.\nPoints have all values that are fields of particles. 16 bits: whether `output.vdb.half` and `precision: 16bit` "
        "store the value in\n16 bits; positions are then relative to their voxels.\n\n"
        "| value | unit | symbol | frames | volumes | meshes | channels | `--show` | USD | 16 bits | meaning |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int v = 1; v < VALUES; v++) {
        const struct value *a = &value_table[v];
        text_add(t, "| `%s` | %s | %s | %s | %s | %s |", a->name, a->unit, a->symbol, has_words(a->has),
                 a->where & IN_VOLUMES ? "yes" : "", a->where & IN_MESHES ? "yes" : "");
        for (int c = 0; c < VALUE_CHANNELS && a->channel[c]; c++)
            text_add(t, " `%s`", a->channel[c]);
        text_add(t, " | %s | %s | %s | %s |\n", a->where & IN_SHOW ? "yes" : "",
                 a->where & IN_USD ? "yes" : "", bits[a->bits], a->meaning);
    }
}
