#include "selftest/findings.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/build.h"
#include "base/cores.h"
#include "base/version.h"

enum { FORMAT = 1, WIDTH = 80 };

void row_found(struct row *row, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(row->found, sizeof row->found, format, args);
    va_end(args);
}

void row_value(struct row *row, const char *name, double value)
{
    if (row->n_values < VALUES_MOST)
        row->value[row->n_values++] = (struct row_value){name, value};
}

void row_wrong(struct row *row, const char *format, ...)
{
    if (!row->ok)
        return;
    row->ok = false;
    va_list args;
    va_start(args, format);
    vsnprintf(row->why, sizeof row->why, format, args);
    va_end(args);
}

void findings_free(struct findings *r)
{
    free(r->row);
    *r = (struct findings){0};
}

const struct row *findings_first_wrong(const struct findings *r)
{
    for (size_t i = 0; i < r->n_rows; i++)
        if (!r->row[i].ok)
            return &r->row[i];
    return NULL;
}

/* ---- Markdown */

static void add_item(struct text *t, const char *format, ...) PRINTF_LIKE(2, 3);
static void add_item(struct text *t, const char *format, ...)
{
    char line[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    text_add(t, "-");
    text_add_wrapped(t, line, 1, 2, WIDTH);
}

static void add_device(struct text *t, const struct findings *r)
{
    const struct gpu_limits *l = &r->limits;
    add_item(t, "device: %s, %s", r->device.name, r->device.type);
    add_item(t, "driver: %s", r->device.driver);
    add_item(t, "memory: %.1f GB in its largest heap; %.1f GB are free", (double)r->device.memory / 1e9,
             (double)r->memory_free / 1e9);
    add_item(t, "limits: a kernel binds %.1f MB and %.3g million texels; one allocation %.1f MB, %u of them",
             (double)l->range / 1e6, (double)l->texels / 1e6, (double)l->allocation / 1e6, l->allocations);
    add_item(t, "subgroup: %u threads; timestamps: %u bits; kernels: variant %s", l->subgroup,
             l->timestamp_bits, l->variant);
    add_item(t, "hoodoo %s, commit %s, build %s", hoodoo_version, hoodoo_commit, hoodoo_build);
}

static void add_rows(struct text *t, const struct findings *r)
{
    const char *group = "";
    for (size_t i = 0; i < r->n_rows; i++) {
        const struct row *row = &r->row[i];
        if (strcmp(row->group, group) != 0) {
            text_add(t, "\n## %s\n\n", row->group);
            text_add(t, "| %-18s | ok |      s | found                                   |\n", "check");
            text_add(t, "|--------------------|----|-------:|-----------------------------------------|\n");
            group = row->group;
        }
        text_add(t, "| %-18s | %s | %6.1f | %-39s |\n", row->name, row->ok ? "ok" : "NO", row->seconds,
                 row->found);
    }
}

static const struct gpu_time *stage_of(const struct pace *p, const char *name)
{
    for (size_t i = 0; i < p->n_stages; i++)
        if (strcmp(p->stage[i].name, name) == 0)
            return &p->stage[i];
    return NULL;
}

static double kernels_ms(const struct pace *p)
{
    double ms = 0;
    for (size_t i = 0; i < p->n_stages; i++)
        ms += 1e-6 * (double)p->stage[i].ns;
    return ms;
}

/* The stages of the demo in the order of the finest spacing, with a column per spacing. */
static void add_paces(struct text *t, const struct findings *r)
{
    const struct pace *finest = r->n_paces ? &r->pace[r->n_paces - 1] : NULL;
    if (!finest)
        return;
    text_add(t, "\n## demo: milliseconds a frame\n\n| %-20s |", "stage");
    for (size_t i = 0; i < r->n_paces; i++)
        text_add(t, " %7.4g m |", r->pace[i].spacing_m);
    text_add(t, "\n|----------------------|");
    for (size_t i = 0; i < r->n_paces; i++)
        text_add(t, "----------:|");
    for (size_t s = 0; s < finest->n_stages; s++) {
        if (finest->stage[s].dispatches == 0)
            continue;
        text_add(t, "\n| %-20.20s |", finest->stage[s].name);
        for (size_t i = 0; i < r->n_paces; i++) {
            const struct gpu_time *time = stage_of(&r->pace[i], finest->stage[s].name);
            text_add(t, " %9.2f |", time ? 1e-6 * (double)time->ns : 0);
        }
    }
#define PACE_ROW(name, format, value)                                                                        \
    text_add(t, "\n| %-20s |", name);                                                                        \
    for (size_t i = 0; i < r->n_paces; i++)                                                                  \
    text_add(t, " " format " |", value)
    PACE_ROW("all kernels", "%9.2f", kernels_ms(&r->pace[i]));
    PACE_ROW("the frame", "%9.2f", 1e3 * r->pace[i].frame_seconds);
    PACE_ROW("dispatches", "%9.0f", r->pace[i].dispatches);
    PACE_ROW("particles", "%9zu", r->pace[i].n_particles);
#undef PACE_ROW
    text_add(t, "\n");
}

status findings_markdown(const struct findings *r, struct text *out)
{
    size_t n_wrong = 0;
    text_add(out, "# hoodoo selftest%s\n\n", r->quick ? " --quick" : "");
    add_device(out, r);
    add_rows(out, r);
    add_paces(out, r);
    text_add(out, "\n");
    for (size_t i = 0; i < r->n_rows; i++) {
        const struct row *row = &r->row[i];
        if (row->ok)
            continue;
        n_wrong++;
        add_item(out, "NOT OK: %s, %s: %s", row->group, row->name, row->why);
    }
    text_add(out, "%s%zu checks, %zu not ok, in %.0f s (%.0f s of CPU time, on %d cores)\n",
             n_wrong ? "\n" : "", r->n_rows, n_wrong, r->seconds, r->cpu_seconds, cores());
    return text_status(out);
}

/* ---- JSON */

static void add_device_json(struct text *t, const struct findings *r)
{
    const struct gpu_limits *l = &r->limits;
    json_object(t, "device");
    json_text(t, "name", r->device.name);
    json_text(t, "driver", r->device.driver);
    json_text(t, "type", r->device.type);
    json_text(t, "uuid", r->device.uuid);
    json_text(t, "pci", r->device.pci);
    json_integer(t, "memory_bytes", (int64_t)r->device.memory);
    json_integer(t, "memory_free_bytes", (int64_t)r->memory_free);
    json_integer(t, "binding_bytes", (int64_t)l->range);
    json_integer(t, "texels", (int64_t)l->texels);
    json_integer(t, "allocation_bytes", (int64_t)l->allocation);
    json_integer(t, "allocations", l->allocations);
    json_integer(t, "subgroup", l->subgroup);
    json_integer(t, "timestamp_bits", l->timestamp_bits);
    json_text(t, "variant", l->variant);
    json_end_object(t);
}

static void add_row_json(struct text *t, const struct row *row)
{
    json_object(t, NULL);
    json_text(t, "group", row->group);
    json_text(t, "name", row->name);
    json_bool(t, "ok", row->ok);
    json_number(t, "seconds", row->seconds);
    json_text(t, "found", row->found);
    if (!row->ok)
        json_text(t, "why", row->why);
    json_object(t, "values");
    for (size_t i = 0; i < row->n_values; i++)
        json_number(t, row->value[i].name, row->value[i].value);
    json_end_object(t);
    json_end_object(t);
}

static void add_pace_json(struct text *t, const struct pace *p)
{
    json_object(t, NULL);
    json_number(t, "spacing_m", p->spacing_m);
    json_integer(t, "particles", (int64_t)p->n_particles);
    json_number(t, "start_seconds", p->start_seconds);
    json_number(t, "frame_seconds", p->frame_seconds);
    json_number(t, "frame_dispatches", p->dispatches);
    json_array(t, "stages");
    for (size_t i = 0; i < p->n_stages; i++) {
        json_object(t, NULL);
        json_text(t, "name", p->stage[i].name);
        json_number(t, "frame_ms", 1e-6 * (double)p->stage[i].ns);
        json_integer(t, "frame_dispatches", (int64_t)p->stage[i].dispatches);
        json_end_object(t);
    }
    json_end_array(t);
    json_end_object(t);
}

status findings_json(const struct findings *r, struct text *out)
{
    json_object(out, NULL);
    json_integer(out, "format", FORMAT);
    json_text(out, "version", hoodoo_version);
    json_text(out, "commit", hoodoo_commit);
    json_text(out, "build", hoodoo_build);
    json_bool(out, "ok", !findings_first_wrong(r));
    json_bool(out, "quick", r->quick);
    json_number(out, "seconds", r->seconds);
    json_number(out, "cpu_seconds", r->cpu_seconds);
    json_integer(out, "cores", cores());
    add_device_json(out, r);
    json_array(out, "checks");
    for (size_t i = 0; i < r->n_rows; i++)
        add_row_json(out, &r->row[i]);
    json_end_array(out);
    json_array(out, "demo");
    for (size_t i = 0; i < r->n_paces; i++)
        add_pace_json(out, &r->pace[i]);
    json_end_array(out);
    json_end_object(out);
    return text_status(out);
}
