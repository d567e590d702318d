#include "farm/openjd.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/visible.h"
#include "farm/command.h"
#include "farm/needs.h"

/* Seconds between the notice and the end of a task: of one on a device, a frame and its checkpoint. OpenJD allows 600. */
enum { NOTIFY_DEVICE_S = 300, NOTIFY_S = 30, NOTIFY_MOST_S = 600, MIB = 1 << 20 };

enum { STEP_NAME = 64 };

#define PROGRAM "{{Param.Hoodoo}}" /* of tasks for which the job names none */

/* What the functions below share: the text that is written, and facts of the tasks. */
struct writer {
    const struct farm *farm;
    const char *device; /* for --device, or NULL */
    struct text *out;
    bool has[FARM_KINDS];                /* the template has tasks of this kind */
    struct farm_needs needs[FARM_KINDS]; /* of the wedge that needs most memory */
    char (*step)[STEP_NAME];             /* names of the steps written so far, in order */
    size_t n_steps, capacity;
};

static void survey(struct writer *w)
{
    const struct farm *f = w->farm;
    for (size_t i = 0; i < f->graph.n; i++) {
        const struct farm_task *t = &f->graph.task[i];
        struct farm_needs needs;
        farm_needs(f, t, w->device, &needs);
        if (!w->has[t->kind] || needs.memory_bytes > w->needs[t->kind].memory_bytes)
            w->needs[t->kind] = needs;
        w->has[t->kind] = true;
    }
    w->has[FARM_END] = f->base->farm.n_on_done > 0; /* without farm.on_done the farm itself knows the end */
}

/* ---- parameters */

static void put_parameter(struct text *t, const char *name, const char *type, const char *preset,
                          const char *description)
{
    json_object(t, NULL);
    json_text(t, "name", name);
    json_text(t, "type", type);
    json_text(t, "default", preset);
    json_text(t, "description", description);
}

/* `text`, if a parameter's default can hold it: at most 1,024 characters and none of them a control character. */
static const char *plain_or(const char *text, const char *otherwise)
{
    if (strlen(text) > 1000)
        return otherwise;
    for (const char *s = text; *s; s++)
        if ((unsigned char)*s < 0x20 || *s == 0x7f)
            return otherwise;
    return text;
}

static void put_range(struct text *t, struct frame_range r)
{
    text_add(t, "%s%d", t->size ? "," : "", r.first);
    if (r.last > r.first)
        text_add(t, "-%d", r.last);
    if (r.last > r.first && r.step > 1)
        text_add(t, ":%d", r.step);
}

/* The frames of the first wedge that a kind takes, as few ranges: "1001-1991:5,1994". */
static void put_frames(const struct farm *f, enum farm_kind kind, struct text *t)
{
    const struct job *job = f->wedge[0].job;
    struct frame_range run = {0, 0, 0};
    for (int frame = job->frames.first; frame <= job->frames.last; frame += job->frames.step) {
        if (!farm_kinds[kind].takes(job, frame))
            continue;
        const int step = frame - run.last;
        if (run.step && (run.first == run.last || step == run.step)) {
            run = (struct frame_range){run.first, frame, step};
            continue;
        }
        if (run.step)
            put_range(t, run);
        run = (struct frame_range){frame, frame, 1};
    }
    if (run.step)
        put_range(t, run);
}

/* Whether a task of the template has that value in its command. */
static bool uses(const struct writer *w, const char *value)
{
    for (int k = 0; k < FARM_KINDS; k++)
        if (w->has[k] && strstr(farm_kinds[k].command, value))
            return true;
    return false;
}

static status put_parameters(const struct writer *w)
{
    const struct farm *f = w->farm;
    struct text *t = w->out, frames = {0};
    const struct job *job = f->wedge[0].job;
    char wedges[32], delay[16];
    json_array(t, "parameterDefinitions");
    put_parameter(t, "JobFile", "PATH", "farm/job.yaml", "The job as it was submitted");
    json_text(t, "objectType", "FILE");
    json_text(t, "dataFlow", "IN");
    json_end_object(t);
    put_parameter(t, "OutDir", "PATH", ".", "Where frames go; on a disk that all workers share");
    json_text(t, "objectType", "DIRECTORY");
    json_text(t, "dataFlow", "INOUT");
    json_end_object(t);
    put_parameter(t, "Hoodoo", "STRING", plain_or(f->hoodoo.text, "hoodoo"), "The program");
    json_end_object(t);
    put_parameter(t, "Device", "STRING", plain_or(w->device ? w->device : "auto", "auto"),
                  "auto, cpu, an index, uuid:HEX or pci:ADDRESS");
    json_end_object(t);
    snprintf(delay, sizeof delay, "%d", VISIBLE_DELAY_S);
    put_parameter(t, "DiskDelay", "INT", delay,
                  "Seconds for which a worker may not see yet what another has written");
    json_end_object(t);
    if (job->wedge.index) {
        if (f->n_wedges == 1)
            snprintf(wedges, sizeof wedges, "%d", (int)job->wedge.index);
        else
            snprintf(wedges, sizeof wedges, "1-%zu", f->n_wedges);
        put_parameter(t, "Wedges", "STRING", wedges, "Which wedges, such as 1-4 or 2,5");
        json_end_object(t);
    }
    if (w->has[FARM_STILL]) {
        put_frames(f, FARM_STILL, &frames);
        put_parameter(t, "StillFrames", "STRING", frames.data ? frames.data : "", "Frames to make stills of");
        json_end_object(t);
    }
    if (uses(w, "{camera}") && job->n_cameras) {
        put_parameter(t, "Camera", "STRING", job->cameras[0].name, "The camera of the stills");
        json_array(t, "allowedValues");
        for (size_t i = 0; i < job->n_cameras; i++)
            json_text(t, NULL, job->cameras[i].name);
        json_end_array(t);
        json_end_object(t);
    }
    json_end_array(t);
    status st = text_status(&frames);
    text_free(&frames);
    return st;
}

static void put_environment(struct text *t)
{
    json_array(t, "jobEnvironments");
    json_object(t, NULL);
    json_text(t, "name", "Disk");
    json_object(t, "variables");
    json_text(t, "HOODOO_DISK_DELAY", "{{Param.DiskDelay}}");
    json_end_object(t);
    json_end_object(t);
    json_end_array(t);
}

/* ---- steps */

enum { AFTER_MOST = 4 };

struct step {
    enum farm_kind kind;
    char name[STEP_NAME];
    char after[AFTER_MOST][STEP_NAME];
    size_t n_after;
    const char *chunks; /* the range of a chunked step, or NULL */
    struct command_values values;
};

static void put_space(const struct writer *w, const struct step *s)
{
    struct text *t = w->out;
    const struct job *job = w->farm->wedge[0].job;
    const bool wedge = s->values.wedge && strstr(farm_kinds[s->kind].command, "{wedge}");
    if (!wedge && !s->chunks)
        return;
    json_object(t, "parameterSpace");
    json_array(t, "taskParameterDefinitions");
    if (wedge) {
        json_object(t, NULL);
        json_text(t, "name", "Wedge");
        json_text(t, "type", "INT");
        json_text(t, "range", "{{Param.Wedges}}");
        json_end_object(t);
    }
    if (s->chunks) {
        json_object(t, NULL);
        json_text(t, "name", "Frames");
        json_text(t, "type", "CHUNK[INT]");
        json_text(t, "range", s->chunks);
        json_object(t, "chunks");
        json_integer(t, "defaultTaskCount", job->farm.chunk_frames);
        json_text(t, "rangeConstraint", "CONTIGUOUS");
        json_end_object(t);
        json_end_object(t);
    }
    json_end_array(t);
    json_end_object(t);
}

static void put_amount(struct text *t, const char *name, int64_t least)
{
    json_object(t, NULL);
    json_text(t, "name", name);
    json_integer(t, "min", least);
    json_end_object(t);
}

static void put_host(const struct writer *w, const struct step *s)
{
    struct text *t = w->out;
    const struct farm_needs *needs = &w->needs[s->kind];
    json_object(t, "hostRequirements");
    json_array(t, "amounts");
    if (needs->gpu) {
        put_amount(t, "amount.worker.gpu", 1);
        put_amount(t, "amount.worker.gpu.memory", farm_units(needs->gpu_bytes, MIB));
    }
    put_amount(t, "amount.worker.vcpu", needs->cpus);
    put_amount(t, "amount.worker.memory", farm_units(needs->memory_bytes, MIB));
    json_end_array(t);
    json_array(t, "attributes");
    json_object(t, NULL);
    json_text(t, "name", "attr.worker.os.family");
    json_array(t, "anyOf");
    json_text(t, NULL, "linux");
    json_end_array(t);
    json_end_object(t);
    json_end_array(t);
    json_end_object(t);
}

/* Braces of the job's own words would be expanded by OpenJD. */
static status check_head(const struct command_head *head)
{
    for (size_t i = 0; i < head->n_prologue; i++)
        if (strstr(head->prologue[i], "{{"))
            return fail(
                E_USAGE,
                "farm: '{{' in the prologue's argument '%.80s' has a meaning in OpenJD: put it into a script",
                head->prologue[i]);
    if (strstr(head->hoodoo, "{{") && strcmp(head->hoodoo, PROGRAM) != 0)
        return fail(E_USAGE, "farm: '{{' in the binary '%.80s' has a meaning in OpenJD: use another path",
                    head->hoodoo);
    return OK;
}

/* The program itself and not a shell: only the first process gets the notice. */
static status put_script(const struct writer *w, const struct step *s)
{
    status st = OK;
    struct text *t = w->out;
    struct farm_command c;
    const struct command_head head = command_head(w->farm->wedge[0].job, s->kind, PROGRAM);
    TRY(check_head(&head));
    TRY(command_fill(&head, s->kind, &s->values, &c));
    json_object(t, "script");
    json_object(t, "actions");
    json_object(t, "onRun");
    json_text(t, "command", c.argv[0]);
    json_array(t, "args");
    for (size_t i = 1; i < c.n; i++)
        json_text(t, NULL, c.argv[i]);
    json_end_array(t);
    json_object(t, "cancelation");
    json_text(t, "mode", "NOTIFY_THEN_TERMINATE");
    const size_t n_wedges = s->kind == FARM_SIM ? w->farm->n_wedges : 0;
    json_integer(t, "notifyPeriodInSeconds",
                 farm_kinds[s->kind].device
                     ? farm_notice_seconds(w->farm->wedge, n_wedges, NOTIFY_DEVICE_S, NOTIFY_MOST_S)
                     : NOTIFY_S);
    json_end_object(t);
    json_end_object(t);
    json_end_object(t);
    json_end_object(t);
done:
    return st;
}

static void put_dependency(struct text *t, const char *name)
{
    json_object(t, NULL);
    json_text(t, "dependsOn", name);
    json_end_object(t);
}

static status put_step(struct writer *w, const struct step *s)
{
    status st = OK;
    struct text *t = w->out;
    const bool end = s->kind == FARM_END;
    json_object(t, NULL);
    json_text(t, "name", s->name);
    if (s->n_after || end) {
        json_array(t, "dependencies");
        for (size_t i = 0; i < s->n_after; i++)
            put_dependency(t, s->after[i]);
        for (size_t i = 0; end && i < w->n_steps; i++)
            put_dependency(t, w->step[i]);
        json_end_array(t);
    }
    put_space(w, s);
    put_host(w, s);
    TRY(put_script(w, s));
    json_end_object(t);
    TRY(memory_grow(&w->step, &w->capacity, w->n_steps + 1, sizeof *w->step, "the steps"));
    memcpy(w->step[w->n_steps++], s->name, STEP_NAME);
done:
    return st;
}

static struct step step_of(const struct writer *w, enum farm_kind kind)
{
    const struct job *job = w->farm->wedge[0].job;
    const struct command_values values = {.job = "{{Param.JobFile}}",
                                          .out = "{{Param.OutDir}}",
                                          .wedge = job->wedge.index ? "{{Task.Param.Wedge}}" : NULL,
                                          .frames = "{{Task.Param.Frames}}",
                                          .view = "{{Task.Param.Frames}}",
                                          .device = "{{Param.Device}}",
                                          .camera = job->n_cameras ? "{{Param.Camera}}" : NULL,
                                          .jobs = w->needs[kind].cpus_text,
                                          .map = "{{Session.PathMappingRulesFile}}",
                                          .gaps = "--allow-none",
                                          .progress = "openjd"};
    struct step s = {.kind = kind, .values = values};
    snprintf(s.name, sizeof s.name, "%s", farm_kinds[kind].step);
    return s;
}

static void add_after(struct step *s, const char *name)
{
    if (*name && s->n_after < AFTER_MOST)
        snprintf(s->after[s->n_after++], STEP_NAME, "%s", name);
}

/* "Sim_1001-1050" */
static void name_after_frames(struct step *s, const char *frames)
{
    snprintf(s->name, sizeof s->name, "%s_%s", farm_kinds[s->kind].step, frames);
}

/* What is made of a block's frames, in chunks of those from the first to the last that have a source. */
static status put_derived(struct writer *w, enum farm_kind kind, const char *block, struct frame_range frames)
{
    const struct job *job = w->farm->wedge[0].job;
    const struct farm_kind_info *info = &farm_kinds[kind];
    char text[48], chunks[48];
    struct frame_range taken = {0, 0, 0};
    for (int frame = frames.first; frame <= frames.last; frame += frames.step)
        if (info->takes(job, frame))
            taken = (struct frame_range){taken.step ? taken.first : frame, frame, 1};
    if (!taken.step || (info->wanted && !info->wanted(job)))
        return OK;
    struct step s = step_of(w, kind);
    snprintf(chunks, sizeof chunks, "%d-%d", taken.first, taken.last);
    name_after_frames(&s, range_text(frames, text));
    add_after(&s, block);
    s.chunks = chunks;
    return put_step(w, &s);
}

/* A block, and what is derived from it. `name` is that of the block before it and becomes its own. */
static status put_block(struct writer *w, struct frame_range frames, char name[STEP_NAME])
{
    status st = OK;
    char text[48];
    struct step s = step_of(w, FARM_SIM);
    s.values.frames = range_text(frames, text);
    name_after_frames(&s, text);
    add_after(&s, name);
    snprintf(name, STEP_NAME, "%s", s.name);
    TRY(put_step(w, &s));
    for (int k = 0; k < FARM_KINDS; k++)
        if (farm_kinds[k].cut == CUT_CHUNKS)
            TRY(put_derived(w, (enum farm_kind)k, name, frames));
done:
    return st;
}

/* The steps of the kinds it waits for, as far as the template has them; else the last block. */
static void add_all_after(const struct writer *w, struct step *s, const char *last_sim)
{
    const unsigned after = farm_kinds[s->kind].after;
    for (int k = 0; k < FARM_KINDS; k++)
        if ((after & 1u << k) && k != FARM_SIM && w->has[k])
            add_after(s, farm_kinds[k].step);
    if (s->n_after == 0 && s->kind != FARM_END)
        add_after(s, last_sim);
}

/* What is made of all frames together, of lists of frames, or of views of the last frame. */
static status put_finish(struct writer *w, enum farm_kind kind, const char *last_sim)
{
    status st = OK;
    const struct job *job = w->farm->wedge[0].job;
    const struct farm_kind_info *info = &farm_kinds[kind];
    const size_t n = info->value ? info->wanted(job) : 1;
    const int last = (int)job->farm.turntable - 1;
    char views[32], list[32];
    snprintf(views, sizeof views, "%d", (int)job->farm.turntable);
    snprintf(list, sizeof list, last > 0 ? "0-%d" : "%d", last);
    for (size_t i = 0; i < n; i++) {
        struct step s = step_of(w, kind);
        s.values.views = views;
        s.chunks = info->cut == CUT_LIST ? "{{Param.StillFrames}}" : info->cut == CUT_VIEWS ? list : NULL;
        if (info->value) {
            s.values.value = info->value(job, i);
            snprintf(s.name, sizeof s.name, "%s_%.40s", info->step, s.values.value);
        }
        add_all_after(w, &s, last_sim);
        TRY(put_step(w, &s));
    }
done:
    return st;
}

/* Blocks of the first wedge: a task parameter repeats them for each wedge. */
static status put_steps(struct writer *w)
{
    status st = OK;
    char last_sim[STEP_NAME] = "";
    const struct farm *f = w->farm;
    json_array(w->out, "steps");
    for (size_t i = 0; i < f->graph.n; i++)
        if (f->graph.task[i].kind == FARM_SIM && f->graph.task[i].wedge == (int)f->wedge[0].job->wedge.index)
            TRY(put_block(w, f->graph.task[i].frames, last_sim));
    for (int k = 0; k < FARM_KINDS; k++)
        if (farm_kinds[k].cut != CUT_BLOCKS && farm_kinds[k].cut != CUT_CHUNKS && w->has[k])
            TRY(put_finish(w, (enum farm_kind)k, last_sim));
    json_end_array(w->out);
done:
    return st;
}

status openjd_template(const struct farm *f, const char *device, struct text *t)
{
    status st = OK;
    bool chunks = false;
    char name[96];
    struct writer w = {.farm = f, .device = device, .out = t};
    survey(&w);
    for (int k = 0; k < FARM_KINDS; k++)
        chunks |= k != FARM_SIM && farm_kind_is_cut((enum farm_kind)k) && w.has[k];
    json_object(t, NULL);
    json_text(t, "specificationVersion", "jobtemplate-2023-09");
    if (chunks) {
        json_array(t, "extensions");
        json_text(t, NULL, "TASK_CHUNKING");
        json_end_array(t);
    }
    snprintf(name, sizeof name, "hoodoo %s", f->base->name);
    json_text(t, "name", name);
    TRY(put_parameters(&w));
    put_environment(t);
    TRY(put_steps(&w));
    json_end_object(t);
    TRY(text_status(t));
    TRY(openjd_check(t->data, t->size));
done:
    free(w.step);
    return st;
}
