#include "farm/openjd.h"

#include <stdio.h>
#include <string.h>

/* Seconds between the notice and the end of a task: a frame, and its checkpoint. */
enum { NOTIFY_SIM_S = 300, NOTIFY_S = 30, MIB = 1 << 20 };

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

/* The frames of all tasks of a kind, as "1001-1010,1011-1020:5". */
static void frames_of(const struct farm *f, enum farm_kind kind, struct text *t)
{
    int wedge = (int)f->wedge[0].job->wedge.index;
    const char *comma = "";
    for (size_t i = 0; i < f->graph.n; i++) {
        const struct farm_task *task = &f->graph.task[i];
        if (task->kind != kind || task->wedge != wedge)
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

static bool has(const struct farm *f, enum farm_kind kind)
{
    for (size_t i = 0; i < f->graph.n; i++)
        if (f->graph.task[i].kind == kind)
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
    put_parameter(t, "Hoodoo", "STRING", plain_or(f->hoodoo, "hoodoo"), "The program");
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
    if ((has(f, FARM_STILL) || has(f, FARM_TURNTABLE)) && job->n_cameras) {
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

struct step {
    const char *name, *after, *also_after; /* NULL: none */
    const char *frames;                    /* the range of a chunked step, or NULL */
    int64_t chunk;
    const struct farm_wedge *gpu; /* what it needs of a GPU, or NULL */
    const char *args[12];         /* ends with NULL; "" stands for the wedge */
};

static void put_space(const struct farm *f, const struct step *s, struct text *t)
{
    bool wedges = f->wedge[0].job->wedge.index > 0;
    bool wedge = false;
    for (size_t i = 0; s->args[i]; i++)
        wedge |= wedges && !*s->args[i];
    if (!wedge && !s->frames)
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
    if (s->frames) {
        json_object(t, NULL);
        json_text(t, "name", "Frames");
        json_text(t, "type", "CHUNK[INT]");
        json_text(t, "range", s->frames);
        json_object(t, "chunks");
        json_integer(t, "defaultTaskCount", s->chunk);
        json_text(t, "rangeConstraint", "CONTIGUOUS");
        json_end_object(t);
        json_end_object(t);
    }
    json_end_array(t);
    json_end_object(t);
}

static void put_host(const struct step *s, struct text *t)
{
    json_object(t, "hostRequirements");
    if (s->gpu) {
        json_array(t, "amounts");
        json_object(t, NULL);
        json_text(t, "name", "amount.worker.gpu");
        json_integer(t, "min", 1);
        json_end_object(t);
        json_object(t, NULL);
        json_text(t, "name", "amount.worker.gpu.memory");
        json_integer(t, "min", (int64_t)(s->gpu->estimate.device_bytes / MIB) + 1);
        json_end_object(t);
        json_object(t, NULL);
        json_text(t, "name", "amount.worker.memory");
        json_integer(t, "min", (int64_t)(s->gpu->estimate.host_bytes / MIB) + 1);
        json_end_object(t);
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
static void put_step(const struct farm *f, const struct step *s, struct text *t)
{
    json_object(t, NULL);
    json_text(t, "name", s->name);
    if (s->after) {
        json_array(t, "dependencies");
        json_object(t, NULL);
        json_text(t, "dependsOn", s->after);
        json_end_object(t);
        if (s->also_after) {
            json_object(t, NULL);
            json_text(t, "dependsOn", s->also_after);
            json_end_object(t);
        }
        json_end_array(t);
    }
    put_space(f, s, t);
    put_host(s, t);
    json_object(t, "script");
    json_object(t, "actions");
    json_object(t, "onRun");
    json_text(t, "command", "{{Param.Hoodoo}}");
    json_array(t, "args");
    for (size_t i = 0; s->args[i]; i++) {
        if (*s->args[i])
            json_text(t, NULL, s->args[i]);
        else if (f->wedge[0].job->wedge.index)
            json_text(t, NULL, "--wedge={{Task.Param.Wedge}}");
    }
    json_end_array(t);
    json_object(t, "cancelation");
    json_text(t, "mode", "NOTIFY_THEN_TERMINATE");
    json_integer(t, "notifyPeriodInSeconds", s->gpu ? NOTIFY_SIM_S : NOTIFY_S);
    json_end_object(t);
    json_end_object(t);
    json_end_object(t);
    json_end_object(t);
    json_end_object(t);
}

/* "Sim_1001-1050" */
static void step_name(const char *kind, struct frame_range frames, char out[64])
{
    char range[48];
    snprintf(out, 64, "%s_%s", kind, range_text(frames, range));
}

/* What is derived from a block's volumes, in chunks of frames. */
static void put_derived(const struct farm *f, const char *kind, const char *verb, struct frame_range frames,
                        struct frame_range made, const char *block, struct text *t)
{
    bool device = strcmp(verb, "aov") == 0;
    char name[64], list[64];
    step_name(kind, frames, name);
    snprintf(list, sizeof list, "%d-%d", made.first, made.last);
    put_step(f,
             &(struct step){.name = name,
                            .after = block,
                            .frames = list,
                            .chunk = f->wedge[0].job->farm.chunk_frames,
                            .gpu = device ? &f->wedge[0] : NULL,
                            .args = {verb, "{{Param.OutDir}}", "", "--frames={{Task.Param.Frames}}",
                                     "--missing", "--allow-none", "--progress=openjd",
                                     device ? "--device={{Param.Device}}" : NULL, NULL}},
             t);
}

/* A block, and the meshes and AOVs of its frames. */
static void put_block(const struct farm *f, struct frame_range frames, const char *before, char name[64],
                      struct text *t)
{
    const struct job *job = f->wedge[0].job;
    char range[64];
    struct frame_range made = {0, 0, 0};
    step_name("Sim", frames, name);
    snprintf(range, sizeof range, "--frames=%s", name + 4);
    put_step(
        f,
        &(struct step){.name = name,
                       .after = before,
                       .gpu = &f->wedge[0],
                       .args = {"run", "{{Param.JobFile}}", "", "--farm={{Param.OutDir}}", range,
                                "--device={{Param.Device}}", "--path-map={{Session.PathMappingRulesFile}}",
                                "--progress=openjd", NULL}},
        t);
    for (int frame = frames.first; frame <= frames.last; frame += frames.step)
        if (graph_has_volumes(job, frame)) {
            made.first = made.step ? made.first : frame;
            made.last = frame;
            made.step = 1;
        }
    if (!made.step)
        return;
    if (job->farm.meshes)
        put_derived(f, "Mesh", "mesh", frames, made, name, t);
    if (job->farm.n_cameras)
        put_derived(f, "Aov", "aov", frames, made, name, t);
}

static void put_finish(const struct farm *f, const char *last_sim, struct text *t)
{
    const struct job *job = f->wedge[0].job;
    const char *camera = job->n_cameras ? "--camera={{Param.Camera}}" : NULL;
    const char *sheet = last_sim;
    char views[32], list[32];
    if (has(f, FARM_STILL)) {
        put_step(f,
                 &(struct step){.name = "Stills",
                                .after = last_sim,
                                .frames = "{{Param.StillFrames}}",
                                .chunk = job->farm.chunk_frames,
                                .args = {"preview", "{{Param.OutDir}}", "", "--frames={{Task.Param.Frames}}",
                                         "--only=stills", "--progress=openjd", camera, NULL}},
                 t);
        put_step(f,
                 &(struct step){
                     .name = "Sheet",
                     .after = "Stills",
                     .args = {"preview", "{{Param.OutDir}}", "", "--only=sheet", "--progress=openjd", NULL}},
                 t);
        sheet = "Sheet";
    }
    if (has(f, FARM_TURNTABLE)) {
        snprintf(views, sizeof views, "--views=%d", (int)job->farm.turntable);
        snprintf(list, sizeof list, job->farm.turntable > 1 ? "0-%d" : "%d", (int)job->farm.turntable - 1);
        put_step(f,
                 &(struct step){.name = "Views",
                                .after = last_sim,
                                .frames = list,
                                .chunk = job->farm.chunk_frames,
                                .args = {"preview", "{{Param.OutDir}}", "", "--only=views", views,
                                         "--view={{Task.Param.Frames}}", "--progress=openjd", camera, NULL}},
                 t);
        put_step(f,
                 &(struct step){.name = "Turntable",
                                .after = "Views",
                                .also_after = sheet != last_sim ? sheet : NULL,
                                .args = {"preview", "{{Param.OutDir}}", "", "--only=video", views,
                                         "--progress=openjd", NULL}},
                 t);
    }
    if (has(f, FARM_WEDGES))
        put_step(f,
                 &(struct step){
                     .name = "Wedges",
                     .after = "Sheet",
                     .args = {"preview", "{{Param.OutDir}}", "--only=wedges", "--progress=openjd", NULL}},
                 t);
}

status openjd_template(const struct farm *f, const char *device, struct text *t)
{
    status st = OK;
    char name[96], last[2][64] = {"", ""};
    int wedge = (int)f->wedge[0].job->wedge.index, k = 0;
    json_object(t, NULL);
    json_text(t, "specificationVersion", "jobtemplate-2023-09");
    if (has(f, FARM_MESH) || has(f, FARM_AOV) || has(f, FARM_STILL) || has(f, FARM_VIEW)) {
        json_array(t, "extensions");
        json_text(t, NULL, "TASK_CHUNKING");
        json_end_array(t);
    }
    snprintf(name, sizeof name, "hoodoo %s", f->base->name);
    json_text(t, "name", name);
    TRY(put_parameters(f, device, t));
    json_array(t, "steps");
    for (size_t i = 0; i < f->graph.n; i++) {
        const struct farm_task *task = &f->graph.task[i];
        if (task->kind != FARM_SIM || task->wedge != wedge)
            continue;
        put_block(f, task->frames, *last[k] ? last[k] : NULL, last[!k], t);
        k = !k;
    }
    put_finish(f, last[k], t);
    json_end_array(t);
    json_end_object(t);
    TRY(text_status(t));
done:
    return st;
}
