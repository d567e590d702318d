#include <stdio.h>
#include <string.h>

#include "job/table.h"
#include "job/values.h"
#include "job/words.h"

static const char intro[] =
    "# Job files\n"
    "\n"
    "This page is made from the tables in `src/job/keys.def` and `src/job/values.def`; do not edit it.\n"
    "\n"
    "A job file is YAML 1.2 (which includes JSON). The unit of a number is the suffix of its key. Unknown and duplicate keys,\n"
    "anchors, tags, wrong types and numbers out of range are refused; the message has file, line, column and key path.\n"
    "`--set` adds or overrides any key on the command line: `--set wind.speed_m_s=12`, `--set strata.0.to_m=20`,\n"
    "`--set 'cameras.main.resolution=[480, 270]'`.\n"
    "\n"
    "A **curve** is a number, or a number that changes with the frame: `{1001: 8, 1060: 14, ease: smooth}`. "
    "The ease is\n"
    "`linear` (the default), `smooth` (slow near each given frame) or `step` (constant until the next one). A curve is\n"
    "constant before its first and after its last frame.\n"
    "\n"
    "A **shape** is a mapping with exactly one of the shapes below, or with one operator: `union`, "
    "`intersection` or\n"
    "`difference` (the first shape without all later ones), which holds a list of shapes.\n"
    "\n"
    "Relative file names refer to the folder of the job file; if the job file is a symbolic link, files that are not there are\n"
    "taken from the folder of its target.\n"
    "\n"
    "Keys marked \u2020 do not affect the files of frames: they may be edited at any time, and a run continues; if all frames are\n"
    "done, `hoodoo run` only updates the folder's job for the other verbs. Keys marked \u2021 (and, with `output.aov.cameras`,\n"
    "those cameras and the light) affect how frames are written: they may be edited until the first frame is written and are\n"
    "refused afterwards, because all frames of a folder must be written alike. All other keys affect the simulation and are part\n"
    "of the job's hash.\n"
    "\n"
    "## An example\n"
    "\n"
    "```yaml\n"
    "hoodoo: 1                     # version of the file format\n"
    "name: block                   # files are written to out/block\n"
    "frames: 1001-1020             # 1001 is the rock before any erosion\n"
    "clock: {years_per_frame: 500}\n"
    "domain:\n"
    "  size_m: [24, 16, 20]        # z is up; the ground is z = 0\n"
    "  spacing_m: 0.5              # half of it: eight times the particles, the same rock\n"
    "scene:\n"
    "  difference:                 # a block with a hole through it\n"
    "    - box: {min_m: [4, 4, 0], max_m: [20, 12, 16]}\n"
    "    - cylinder: {from_m: [12, 0, 5], to_m: [12, 16, 5], radius_m: 3}\n"
    "strata:                       # bottom up\n"
    "  - {to_m: 8, weak_m_per_kyr: 0.2, interlock_MPa: 0.3}\n"
    "  - {weak_m_per_kyr: 0.05, interlock_MPa: 0.3}\n"
    "wind:\n"
    "  direction: [1, 0.3, 0]\n"
    "  speed_m_s: {1001: 8, 1020: 14, ease: smooth}\n"
    "cameras:\n"
    "  main: {orbit: {target_m: [12, 8, 8], distance_m: 45}}\n"
    "output: {aov: {cameras: [main]}}\n"
    "```\n";

/* Adds text to a cell of a table. */
static void put_cell(struct text *t, const char *s)
{
    for (; *s; s++)
        text_add(t, *s == '|' || *s == '<' || *s == '*' ? "\\%c" : "%c", *s);
}

static void put_default(struct text *t, const struct job_key *key)
{
    struct text words = {0};
    if (key_required(key)) {
        text_add(t, "**required**");
        return;
    }
    key_default_words(key, &words);
    if (words.size)
        text_add(t, "`%s`", words.data);
    text_free(&words);
}

static void put_row(struct text *t, const struct job_key *key)
{
    char range[256];
    text_add(t, "| `%s`%s | ", key->name, key_simulates(key) ? "" : key_files(key) ? " \u2021" : " \u2020");
    if (key->type == KEY_VEC)
        text_add(t, "%zu ", key->n);
    text_add(t, "%s%s", key_type_words(key), key->unit[0] ? ", " : "");
    put_cell(t, key->unit);
    text_add(t, " | ");
    put_default(t, key);
    text_add(t, " | ");
    text_add(t, "%s | ", key_range_words(key, range));
    put_cell(t, key->meaning);
    text_add(t, " | ");
    put_cell(t, key->source);
    text_add(t, " |\n");
}

/* `shared`: include the keys of `group`, which all shapes have and which get a table of their own. `named`: omit the name, because
 * the items of a MAP are named by their keys. */
static void put_table(struct text *t, enum job_section_id section, const char *title, bool shared, bool named)
{
    const struct job_section *s = &job_sections[section];
    text_add(t, "\n## %s\n\n", title);
    put_cell(t, s->meaning);
    text_add(t, "\n\n| key | type, unit | default | range | meaning | source |\n|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < s->n; i++)
        if ((shared || !key_places(s->key[i].name)) && !(named && s->key[i].type == KEY_NAME))
            put_row(t, &s->key[i]);
}

/* Adds the table of a section and those of the sections inside it. `path` is its key path, such as "wind.deflation"; first[id] is
 * the path at which a section first occurred. */
static void put_tables(struct text *t, enum job_section_id section, const char *path, bool named,
                       char (*first)[256])
{
    const struct job_section *s = &job_sections[section];
    char title[300];
    if (*first[section]) {
        text_add(t, "\n## `%s`\n\nThe keys of `%s`.\n", path, first[section]);
        return;
    }
    snprintf(first[section], sizeof first[section], "%s", path);
    snprintf(title, sizeof title, path[0] ? "`%s`" : "The job", path);
    put_table(t, section, title, true, named);
    for (size_t i = 0; i < s->n; i++) {
        const struct job_key *key = &s->key[i];
        if (key->type != KEY_SUB && key->type != KEY_MAYBE && key->type != KEY_LIST && key->type != KEY_MAP)
            continue;
        char inner[256];
        snprintf(inner, sizeof inner, "%s%s%s%s", path, path[0] ? "." : "", key->name,
                 key->type == KEY_LIST  ? ".N"
                 : key->type == KEY_MAP ? ".NAME"
                                        : "");
        put_tables(t, (enum job_section_id)key->child, inner, key->type == KEY_MAP, first);
    }
}

/* The names of the models that have the process. */
static const char *models_text(const struct job_process *process, char out[80])
{
#define MODEL(constant, word, ...)                                                                           \
    if (process->models & OF_MODEL(constant))                                                                \
        snprintf(out + strlen(out), 80 - strlen(out), "%s%s", *out ? ", " : "", #word);
    *out = '\0';
    JOB_MODELS(MODEL)
#undef MODEL
    return out;
}

static void put_processes(struct text *t)
{
    char models[80];
    text_add(
        t,
        "\n## Processes\n\n"
        "`change_m3` in `frames/NAME.FRAME.json` has the change of the rock's volume by each process since the previous frame,\n"
        "negative where rock was removed. The changes add up to that of `volume_m3`. The report plots the removed volumes under\n"
        "these names.\n\n"
        "| process | models | in the report | meaning |\n|---|---|---|---|\n");
    for (int p = 0; p < PROCESSES; p++)
        text_add(t, "| `%s` | %s | %s | %s |\n", job_processes[p].name,
                 models_text(&job_processes[p], models), job_processes[p].legend, job_processes[p].meaning);
}

status job_reference(struct text *out)
{
    char title[100], first[JOB_SECTIONS][256] = {0};
    text_add(out, "%s", intro);
    put_tables(out, SECTION_job, "", false, first);
    for (int i = 0; i < SHAPES; i++) {
        snprintf(title, sizeof title, "Shape `%s`", job_sections[i].name);
        put_table(out, (enum job_section_id)i, title, false, false);
    }
    put_table(out, SECTION_group, "Every shape and operator", true, false);
    text_add(out,
             "\nThese keys are given inside the mapping of a shape, or beside the list of an operator.\n");
    value_reference(out);
    put_processes(out);
    return text_status(out);
}
