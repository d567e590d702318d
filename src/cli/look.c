/* hoodoo look JOB: renders one frame in seconds; with --watch again whenever the job is saved. */
#include "look/look.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "base/log.h"
#include "base/memory.h"
#include "cli/answer.h"
#include "cli/cli.h"
#include "look/live.h"
#include "run/branch.h"
#include "system/atomic_file.h"
#include "system/progress.h"
#include "system/signals.h"

#define QUALITY_CHOICE (QUALITY_SKETCH, "sketch")(QUALITY_DRAFT, "draft")(QUALITY_FULL, "full")
enum { CHOICE_CONSTANTS(QUALITY_CHOICE) };

/* Limits of a quality: seconds of simulation, width of the picture, and rays per pixel. */
static const struct quality {
    double seconds;
    int width, samples;
} qualities[] = {{2, 640, 4}, {20, 960, 9}, {HUGE_VAL, 1280, 16}};

/* The state of a file when it was last examined. */
struct watched {
    struct path path;
    struct timespec modified;
    off_t size;
    bool there;
};

struct looking {
    struct common common;
    const char *job, *out;
    struct path folder; /* the picture's */
    struct look_options options;
    struct progress progress;
    bool watch, serves, abandoned;
    struct watched *file; /* the job and its input files */
    size_t n_files, capacity;
};

/* ---- watched files */

static struct watched stat_of(const char *path)
{
    struct watched w = {0};
    struct stat info;
    if (path_format(&w.path, "%s", path) == OK && stat(path, &info) == 0) {
        w.there = true;
        w.modified = info.st_mtim;
        w.size = info.st_size;
    }
    return w;
}

static status watch_file(struct looking *l, const char *path)
{
    status st = memory_grow(&l->file, &l->capacity, l->n_files + 1, sizeof *l->file, "watched files");
    if (st == OK)
        l->file[l->n_files++] = stat_of(path);
    return st;
}

/* Records the state of the job and its input files. If the job cannot be read, the inputs known from before are kept. */
static status watch_all(struct looking *l)
{
    status st = OK;
    struct job *job = NULL;
    struct job_input *inputs = NULL;
    size_t n = 0;
    const bool hushed = log_silence(true);
    if (job_load(l->job, l->common.sets.item, l->common.sets.n, &job) != OK ||
        job_inputs(job, &inputs, &n) != OK) {
        for (size_t i = 0; i < l->n_files; i++)
            l->file[i] = stat_of(l->file[i].path.text);
        if (l->n_files == 0)
            TRY(watch_file(l, l->job));
        goto done;
    }
    l->n_files = 0;
    TRY(watch_file(l, l->job));
    for (size_t i = 0; i < n; i++)
        TRY(watch_file(l, inputs[i].path));
done:
    log_silence(hushed);
    job_inputs_free(&inputs, n);
    job_destroy(&job);
    return st;
}

static bool has_changed(const struct looking *l)
{
    for (size_t i = 0; i < l->n_files; i++) {
        const struct watched now = stat_of(l->file[i].path.text), *was = &l->file[i];
        if (now.there != was->there || now.size != was->size || now.modified.tv_sec != was->modified.tv_sec ||
            now.modified.tv_nsec != was->modified.tv_nsec)
            return true;
    }
    return false;
}

static void pause_seconds(double seconds)
{
    struct timespec t = {0, (long)(1e9 * seconds)};
    nanosleep(&t, NULL);
}

/* ---- one picture */

static bool should_stop(void *user)
{
    struct looking *l = user;
    l->abandoned = (l->watch || l->serves) && has_changed(l);
    return l->abandoned || stop_requested();
}

static void begin(void *user, struct frame_range frames)
{
    struct looking *l = user;
    progress_begin(&l->progress, (enum progress_style)l->common.progress, frames, 1);
}

static void frame_done(void *user, int frame)
{
    struct looking *l = user;
    progress_frame(&l->progress, frame, -1, "");
}

/* "50 s", "4 min", "3 h" */
static const char *rough_time(double seconds, char out[24])
{
    const bool minutes = seconds >= 100, hours = seconds >= 100 * 60;
    snprintf(out, 24, "%.2g %s",
             hours     ? seconds / 3600
             : minutes ? seconds / 60
                       : seconds,
             hours     ? "h"
             : minutes ? "min"
                       : "s");
    return out;
}

static void print_text(const char *path, const struct look_made *m)
{
    char time[24];
    printf("%s: %s, frame %d, at %.4g m", path, m->name, m->frame, m->spacing_m);
    if (m->spacing_m != m->own_spacing_m)
        printf(" (the job's spacing is %.4g)", m->own_spacing_m);
    if (m->air_m > 0)
        printf(", air at %.3g m", m->air_m);
    printf("\n%d frames simulated", m->frame - m->began);
    if (m->found)
        printf(", from the state of frame %d", m->began);
    printf("; load %.1f s, simulate %.1f s, picture %.1f s\n", m->load_seconds, m->step_seconds,
           m->picture_seconds);
    printf(
        "about %zu particles; the job itself: %zu, roughly %s here, %.2f GB on the device and %.2f GB beside; 'hoodoo plan' measures its speed\n",
        m->n_particles, m->own_estimate.n_particles, rough_time(m->own_seconds, time),
        (double)m->own_estimate.device_bytes / 1e9, (double)m->own_estimate.host_bytes / 1e9);
    if (m->coarse.size)
        printf("too fine for this spacing:\n%s", m->coarse.data);
    printf("%s", m->gizmos.data ? m->gizmos.data : "");
}

static status print_json(const char *path, const struct look_made *m)
{
    status st = OK;
    struct text t = {0};
    answer_begin(&t);
    json_text(&t, "picture", path);
    json_text(&t, "name", m->name);
    json_integer(&t, "frame", m->frame);
    json_number(&t, "years", m->years);
    json_number(&t, "spacing_m", m->spacing_m);
    json_number(&t, "job_spacing_m", m->own_spacing_m);
    json_integer(&t, "particles", (int64_t)m->n_particles);
    json_integer(&t, "job_particles", (int64_t)m->own_estimate.n_particles);
    json_number(&t, "job_seconds", m->own_seconds);
    json_integer(&t, "job_device_bytes", (int64_t)m->own_estimate.device_bytes);
    json_integer(&t, "job_host_bytes", (int64_t)m->own_estimate.host_bytes);
    json_integer(&t, "from_frame", m->began);
    json_bool(&t, "state_found", m->found);
    json_number(&t, "load_seconds", m->load_seconds);
    json_number(&t, "simulate_seconds", m->step_seconds);
    json_number(&t, "picture_seconds", m->picture_seconds);
    json_end_object(&t);
    TRY(text_status(&t));
    json_one_line(&t);
    printf("%s%s", t.data, t.data[t.size - 1] == '\n' ? "" : "\n");
done:
    text_free(&t);
    return st;
}

static status look_once(struct looking *l, struct look *look)
{
    status st = OK;
    struct look_made made = {0};
    struct path path, name;
    st = look_make(look, &l->options, &made);
    progress_end(&l->progress);
    TRY(st);
    TRY(path_format(&name, "%s.look.png", made.name));
    TRY(path_format(&path, "%s", l->out ? l->out : name.text));
    TRY(atomic_file_write(path.text, made.png, made.png_size));
    if (l->common.json)
        TRY(print_json(path.text, &made));
    else
        print_text(path.text, &made);
done:
    fflush(stdout);
    look_made_free(&made);
    return st;
}

/* Errors that the user can correct in the job, so that watching continues. */
static bool user_can_fix(status st)
{
    return st == E_USAGE || st == E_INPUT || st == E_NUMERIC || st == E_MEMORY;
}

/* Renders at each change until a signal arrives. */
static status watch_loop(struct looking *l, struct look *look)
{
    status st = OK;
    for (;;) {
        TRY(watch_all(l));
        st = look_once(l, look);
        if (st == STOPPED && !l->abandoned)
            return OK;
        if (user_can_fix(st))
            log_error(status_message());
        else if (st != STOPPED)
            TRY(st);
        while (!has_changed(l)) {
            if (stop_requested())
                return OK;
            pause_seconds(0.1);
        }
        pause_seconds(0.05); /* an editor may write a file in several steps */
    }
done:
    return st;
}

/* Serves the page until a signal arrives. */
static status serve(struct looking *l, struct look *look, int port)
{
    status st = OK;
    struct serve *serve = NULL;
    struct live live = {.look = look, .options = &l->options};
    TRY(watch_all(l));
    TRY(serve_begin(port, live_answer, &live, &serve));
    printf("%s\n", serve_address(serve));
    fflush(stdout);
    while (!stop_requested() && live.broken == OK) {
        TRY(serve_wait(serve, 0.2));
        if (has_changed(l)) {
            TRY(watch_all(l));
            live.saves++;
        }
    }
    if (live.broken != OK)
        st = fail(live.broken, "%s", live.message);
done:
    serve_end(&serve);
    return st;
}

/* ---- the verb */

static status apply_options(struct looking *l, int quality, int show, double seconds, double spacing)
{
    struct sketch_options *s = &l->options.sketch;
    s->path = l->job;
    s->from = l->common.from;
    s->sets = l->common.sets.item;
    s->n_sets = l->common.sets.n;
    s->width = qualities[quality].width;
    s->samples = qualities[quality].samples;
    s->seconds = seconds > 0 ? seconds : qualities[quality].seconds;
    s->spacing_m = spacing;
    s->show = show_of_word(show);
    if (seconds < 0 || spacing < 0)
        return fail(E_USAGE, "%s %g: must be above 0", seconds < 0 ? "--seconds" : "--spacing",
                    seconds < 0 ? seconds : spacing);
    if (seconds > 0 && spacing > 0)
        return fail(E_USAGE, "--seconds and --spacing exclude each other: --seconds chooses the spacing");
    if (l->options.range && s->show == VALUE_NONE)
        return fail(E_USAGE, "--range %.40s: choose a value with --show first", l->options.range);
    if (s->show != VALUE_NONE && !value_table[s->show].channel[0])
        return fail(E_USAGE, "--show %s: not available in look; 'hoodoo preview --show' has it",
                    value_table[s->show].name);
    return OK;
}

status cli_look(int argc, char **argv)
{
    status st = OK;
    struct arguments operands = {0};
    struct look *look = NULL;
    struct looking l = {0};
    char shown[SHOW_WORDS];
    double seconds = 0, spacing = 0;
    int quality = QUALITY_SKETCH, show = 0, gizmos = GIZMOS_NOW;
    bool help = false, page = false;
    int port = 0;
    const struct option options[] = {
        {"frame", "N|last", OPTION_TEXT, &l.options.sketch.frame, "the frame to show (default: last)"},
        {"camera", "NAME|AZ,EL", OPTION_TEXT, &l.options.sketch.camera,
         "a camera of the job, or a direction in degrees from which to view the whole domain, such as -55,9 (default: the job's first camera)"},
        {"quality", CHOICE_TEXT(QUALITY_CHOICE), OPTION_CHOICE, &quality,
         "sketch: about 2 seconds of simulation; draft: about 20, and a larger picture; full: at the job's own spacing (default: sketch)"},
        {"seconds", "S", OPTION_NUMBER, &seconds,
         "choose the spacing for about this many seconds of simulation"},
        {"spacing", "M", OPTION_NUMBER, &spacing, "simulate at this spacing, in metres"},
        {"show", show_words(shown), OPTION_CHOICE, &show,
         "a value of the surface in false colours, with a legend (default: rock, its natural colours)"},
        {"range", "LO:HI", OPTION_TEXT, &l.options.range,
         "range of the colours, in the legend's unit (default: the same as in previews of the job)"},
        {"cut", "AXIS=M", OPTION_TEXT, &l.options.cut,
         "cut the rock at x, y or z, such as x=12.5, and show its inside there: beds, or the value of --show. What is between the cut and the camera is left out; of z, what is above"},
        {"figure", NULL, OPTION_FLAG, &l.options.figure, "add a person of 1.75 m in front of the rock"},
        {"gizmos", CHOICE_TEXT(GIZMOS_CHOICE), OPTION_CHOICE, &gizmos,
         "lines over the picture: domain, wind, water paths, paint, cameras, and edits and tools of this frame (now) or of all frames (all) (default: now)"},
        {"no-slate", NULL, OPTION_FLAG, &l.options.no_slate,
         "omit the scale bar and the strip with name, frame and age"},
        {"watch", NULL, OPTION_FLAG, &l.watch,
         "render again whenever the job or one of its input files is saved, until Ctrl-C; errors in the job are reported and do not end it"},
        {"serve", NULL, OPTION_FLAG, &page,
         "serve a page for a browser on this machine, until Ctrl-C: orbit, step through frames, cut, click for positions and values, and see curves. The address is printed; anyone who knows it can see the page"},
        {"port", "N", OPTION_INT, &port, "port of the page (default: any free one)"},
        {"out", "PNG", OPTION_TEXT, &l.out, "the picture's file (default: NAME.look.png)"},
        OPTION_WEDGE(&l.options.sketch.wedge),
        OPTION_FROM(&l.common),
        OPTION_DEVICE(&l.common),
        OPTION_SET(&l.common),
        OPTION_PROGRESS(&l.common),
        OPTION_JSON(&l.common)};
    TRY(options_parse(&usage_look, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
    if (help)
        goto done;
    l.job = operands.item[0];
    if (l.common.from)
        TRY(arguments_add(&l.common.sets, BRANCH_SET));
    TRY(apply_options(&l, quality, show, seconds, spacing));
    TRY(path_folder(&l.folder, l.out ? l.out : ""));
    l.options.folder = l.folder.text;
    l.options.gizmos = (enum gizmos)gizmos;
    l.serves = page;
    if (page && l.watch) {
        st = fail(E_USAGE, "--serve already watches the job; omit --watch");
        goto done;
    }
    if (page)
        l.common.progress = PROGRESS_NONE;
    l.options.stop = should_stop;
    l.options.begin = begin;
    l.options.frame = frame_done;
    l.options.user = &l;
    signals_install();
    TRY(look_begin(l.common.device, spacing > 0 || l.common.from ? HUGE_VAL : l.options.sketch.seconds,
                   &look));
    l.options.sketch.gpu = look_on_gpu(look);
    TRY(page ? serve(&l, look, port) : l.watch ? watch_loop(&l, look) : look_once(&l, look));
done:
    progress_end(&l.progress);
    look_end(&look);
    free(l.file);
    arguments_free(&operands);
    common_free(&l.common);
    return st;
}
