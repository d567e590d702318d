#include "farm/openjd.h"

#include <stdio.h>
#include <string.h>

#include "farm/command.h"
#include "run/memory.h"

/* Seconds between the notice and the end of a task: of a simulation, a frame and its checkpoint. OpenJD allows 600. */
enum { NOTIFY_SIM_S = 300, NOTIFY_S = 30, NOTIFY_MOST_S = 600, MIB = 1 << 20 };

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

/* A STRING default holds no control characters and at most 1024 of others. */
static const char *plain_or(const char *text, const char *otherwise)
{
    if (strlen(text) > 1000)
        return otherwise;
    for (const char *s = text; *s; s++)
        if ((unsigned char)*s < 0x20 || *s == 0x7f)
            return otherwise;
    return text;
}

/* The tasks of a kind that steps are written from: those of the first wedge, or of all. */
static bool in_template(const struct farm *f, const struct farm_task *task, enum farm_kind kind)
{
    return task->kind == kind &&
           (farm_kinds[kind].cut == CUT_ALL_WEDGES || task->wedge == (int)f->wedge[0].job->wedge.index);
}

static bool has(const struct farm *f, enum farm_kind kind)
{
    for (size_t i = 0; i < f->graph.n; i++)
        if (in_template(f, &f->graph.task[i], kind))
            return true;
    return false;
}

/* The frames of all tasks of a kind, as "1001-1010,1011-1020:5". */
static void frames_of(const struct farm *f, enum farm_kind kind, struct text *t)
{
    const char *comma = "";
    for (size_t i = 0; i < f->graph.n; i++) {
        const struct farm_task *task = &f->graph.task[i];
        if (!in_template(f, task, kind))
            continue;
        text_add(t, "%s%d", comma, task->frames.first);
        if (task->frames.last > task->frames.first)
            text_add(t, "-%d", task->frames.last);
        if (task->frames.last > task->frames.first && task->frames.step > 1)
            text_add(t, ":%d", task->frames.step);
        comma = ",";
    }
    if (!t->data)
        text_add(t, "%s", "");
}

/* Is there a task whose command has that value? */
static bool uses(const struct farm *f, const char *value)
{
    for (int k = 0; k < FARM_KINDS; k++)
        if (strstr(farm_kinds[k].command, value) && has(f, (enum farm_kind)k))
            return true;
    return false;
}

static status put_parameters(const struct farm *f, const char *device, struct text *t)
{
    const struct job *job = f->wedge[0].job;
    struct text frames = {0};
    char wedges[32];
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
    put_parameter(t, "Device", "STRING", plain_or(device ? device : "auto", "auto"),
                  "auto, cpu, an index, uuid:HEX or pci:ADDRESS");
    json_end_object(t);
    if (job->wedge.index) {
        if (f->n_wedges == 1)
            snprintf(wedges, sizeof wedges, "%d", (int)job->wedge.index);
        else
            snprintf(wedges, sizeof wedges, "1-%zu", f->n_wedges);
        put_parameter(t, "Wedges", "STRING", wedges, "Which wedges, such as 1-4 or 2,5");
        json_end_object(t);
    }
    if (has(f, FARM_STILL)) {
        frames_of(f, FARM_STILL, &frames);
        put_parameter(t, "StillFrames", "STRING", frames.data ? frames.data : "", "Frames to make stills of");
        json_end_object(t);
    }
    if (uses(f, "{camera}") && job->n_cameras) {
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

/* ---- steps */

enum { AFTER_MAX = 4, STEP_NAME = 64 };

struct step {
    const struct farm *farm;
    enum farm_kind kind;
    char name[STEP_NAME];
    char after[AFTER_MAX][STEP_NAME];
    size_t n_after;
    const char *chunks; /* the range of a step in chunks, or NULL */
    const char *device; /* as --device has it, or NULL */
    struct command_values values;
};

static void put_space(const struct step *s, struct text *t)
{
    const struct job *job = s->farm->wedge[0].job;
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

static void put_host(const struct step *s, struct text *t)
{
    const struct model_estimate *e = &s->farm->wedge[0].estimate;
    json_object(t, "hostRequirements");
    if (farm_kinds[s->kind].device) {
        /* Without a GPU its memory is the machine's. */
        const bool gpu = farm_wants_gpu(s->kind, s->device);
        const uint64_t host = e->host_bytes + run_memory_process(NULL, e) + (gpu ? 0 : e->device_bytes);
        json_array(t, "amounts");
        if (gpu) {
            put_amount(t, "amount.worker.gpu", 1);
            put_amount(t, "amount.worker.gpu.memory", (int64_t)(e->device_bytes / MIB) + 1);
        }
        put_amount(t, "amount.worker.memory", (int64_t)(host / MIB) + 1);
        json_end_array(t);
    }
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

/* The program itself, not a shell: the notice goes to the first process alone. */
static status put_script(const struct step *s, struct text *t)
{
    struct farm_command c;
    status st = command_fill("", s->kind, &s->values, &c);
    if (st != OK)
        return st;
    json_object(t, "script");
    json_object(t, "actions");
    json_object(t, "onRun");
    json_text(t, "command", "{{Param.Hoodoo}}");
    json_array(t, "args");
    for (size_t i = 1; i < c.n; i++)
        json_text(t, NULL, c.argv[i]);
    json_end_array(t);
    json_object(t, "cancelation");
    json_text(t, "mode", "NOTIFY_THEN_TERMINATE");
    const size_t n_wedges = s->kind == FARM_SIM ? s->farm->n_wedges : 0;
    json_integer(t, "notifyPeriodInSeconds",
                 farm_kinds[s->kind].device
                     ? farm_notice_seconds(s->farm->wedge, n_wedges, NOTIFY_SIM_S, NOTIFY_MOST_S)
                     : NOTIFY_S);
    json_end_object(t);
    json_end_object(t);
    json_end_object(t);
    json_end_object(t);
    return OK;
}

static status put_step(const struct step *s, struct text *t)
{
    json_object(t, NULL);
    json_text(t, "name", s->name);
    if (s->n_after) {
        json_array(t, "dependencies");
        for (size_t i = 0; i < s->n_after; i++) {
            json_object(t, NULL);
            json_text(t, "dependsOn", s->after[i]);
            json_end_object(t);
        }
        json_end_array(t);
    }
    put_space(s, t);
    put_host(s, t);
    status st = put_script(s, t);
    json_end_object(t);
    return st;
}

static struct step step_of(const struct farm *f, enum farm_kind kind, const char *device)
{
    const struct job *job = f->wedge[0].job;
    const struct command_values values = {.job = "{{Param.JobFile}}",
                                          .out = "{{Param.OutDir}}",
                                          .wedge = job->wedge.index ? "{{Task.Param.Wedge}}" : NULL,
                                          .frames = "{{Task.Param.Frames}}",
                                          .view = "{{Task.Param.Frames}}",
                                          .device = "{{Param.Device}}",
                                          .camera = job->n_cameras ? "{{Param.Camera}}" : NULL,
                                          .map = "{{Session.PathMappingRulesFile}}",
                                          .gaps = "--allow-none",
                                          .progress = "openjd"};
    struct step s = {.farm = f, .kind = kind, .values = values, .device = device};
    snprintf(s.name, sizeof s.name, "%s", farm_kinds[kind].step);
    return s;
}

static void add_after(struct step *s, const char *name)
{
    if (*name && s->n_after < AFTER_MAX)
        snprintf(s->after[s->n_after++], STEP_NAME, "%s", name);
}

/* "Sim_1001-1050" */
static void name_after_frames(struct step *s, const char *frames)
{
    snprintf(s->name, sizeof s->name, "%s_%s", farm_kinds[s->kind].step, frames);
}

/* What is derived from a block's frames, in chunks of those from the first to the last that have it. */
static status put_derived(const struct farm *f, const char *device, enum farm_kind kind, const char *block,
                          struct frame_range frames, struct text *t)
{
    const struct job *job = f->wedge[0].job;
    const struct farm_kind_info *info = &farm_kinds[kind];
    char text[48], chunks[48];
    struct frame_range taken = {0, 0, 0};
    for (int frame = frames.first; frame <= frames.last; frame += frames.step)
        if (info->takes(job, frame))
            taken = (struct frame_range){taken.step ? taken.first : frame, frame, 1};
    if (!taken.step || (info->wanted && !info->wanted(job)))
        return OK;
    struct step s = step_of(f, kind, device);
    snprintf(chunks, sizeof chunks, "%d-%d", taken.first, taken.last);
    name_after_frames(&s, range_text(frames, text));
    add_after(&s, block);
    s.chunks = chunks;
    return put_step(&s, t);
}

/* A block, and what is derived from it. `name` is that of the block before it and becomes its own. */
static status put_block(const struct farm *f, const char *device, struct frame_range frames,
                        char name[STEP_NAME], struct text *t)
{
    status st = OK;
    char text[48];
    struct step s = step_of(f, FARM_SIM, device);
    s.values.frames = range_text(frames, text);
    name_after_frames(&s, text);
    add_after(&s, name);
    snprintf(name, STEP_NAME, "%s", s.name);
    TRY(put_step(&s, t));
    for (int k = 0; k < FARM_KINDS; k++)
        if (farm_kinds[k].cut == CUT_CHUNKS)
            TRY(put_derived(f, device, (enum farm_kind)k, name, frames, t));
done:
    return st;
}

/* The steps it waits for, as far as the template has them; else the last block, which all else waits for. */
static void add_all_after(struct step *s, const char *last_sim)
{
    const unsigned after = farm_kinds[s->kind].after;
    for (int k = 0; k < FARM_KINDS; k++)
        if ((after & 1u << k) && k != FARM_SIM && has(s->farm, (enum farm_kind)k))
            add_after(s, farm_kinds[k].step);
    if (s->n_after == 0)
        add_after(s, last_sim);
}

/* What is made of all frames together, of lists of them, or of views of the last. */
static status put_finish(const struct farm *f, const char *device, enum farm_kind kind, const char *last_sim,
                         struct text *t)
{
    status st = OK;
    const struct job *job = f->wedge[0].job;
    const struct farm_kind_info *info = &farm_kinds[kind];
    const size_t n = info->value ? info->wanted(job) : 1;
    const int last = (int)job->farm.turntable - 1;
    char views[32], list[32];
    snprintf(views, sizeof views, "%d", (int)job->farm.turntable);
    snprintf(list, sizeof list, last > 0 ? "0-%d" : "%d", last);
    for (size_t i = 0; i < n; i++) {
        struct step s = step_of(f, kind, device);
        s.values.views = views;
        s.chunks = info->cut == CUT_LIST ? "{{Param.StillFrames}}" : info->cut == CUT_VIEWS ? list : NULL;
        if (info->value) {
            s.values.value = info->value(job, i);
            snprintf(s.name, sizeof s.name, "%s_%.40s", info->step, s.values.value);
        }
        add_all_after(&s, last_sim);
        TRY(put_step(&s, t));
    }
done:
    return st;
}

static status put_steps(const struct farm *f, const char *device, struct text *t)
{
    status st = OK;
    char last_sim[STEP_NAME] = "";
    json_array(t, "steps");
    for (size_t i = 0; i < f->graph.n; i++)
        if (in_template(f, &f->graph.task[i], FARM_SIM))
            TRY(put_block(f, device, f->graph.task[i].frames, last_sim, t));
    for (int k = 0; k < FARM_KINDS; k++)
        if (farm_kinds[k].cut != CUT_BLOCKS && farm_kinds[k].cut != CUT_CHUNKS && has(f, (enum farm_kind)k))
            TRY(put_finish(f, device, (enum farm_kind)k, last_sim, t));
    json_end_array(t);
done:
    return st;
}

status openjd_template(const struct farm *f, const char *device, struct text *t)
{
    status st = OK;
    bool chunks = false;
    char name[96];
    for (int k = 0; k < FARM_KINDS; k++)
        chunks |= k != FARM_SIM && farm_kind_is_cut((enum farm_kind)k) && has(f, (enum farm_kind)k);
    json_object(t, NULL);
    json_text(t, "specificationVersion", "jobtemplate-2023-09");
    if (chunks) {
        json_array(t, "extensions");
        json_text(t, NULL, "TASK_CHUNKING");
        json_end_array(t);
    }
    snprintf(name, sizeof name, "hoodoo %s", f->base->name);
    json_text(t, "name", name);
    TRY(put_parameters(f, device, t));
    TRY(put_steps(f, device, t));
    json_end_object(t);
    TRY(text_status(t));
done:
    return st;
}
