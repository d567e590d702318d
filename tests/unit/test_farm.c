/* The graph of tasks, on random jobs: what any scheduler relies on. And what a task's command line and a shell make of
 * names that mean harm. */
#include "check.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/memory.h"
#include "base/random.h"
#include "farm/command.h"
#include "farm/farm.h"
#include "output/product.h"
#include "system/atomic_file.h"

enum { JOBS = 500, WEDGES = 4 };

/* A number in low..high, a hash of which job it is for and what. */
static int pick(int job, int what, int low, int high)
{
    uint32_t hash = random_hash((uint32_t)job, (uint32_t)what, 77, 1);
    return low + (int)(hash % (uint32_t)(high - low + 1));
}

struct sample {
    struct job job[WEDGES];
    struct farm_wedge wedge[WEDGES];
    size_t n;
};

static void make_sample(int seed, struct sample *s)
{
    memset(s, 0, sizeof *s);
    s->n = (size_t)pick(seed, 1, 1, WEDGES);
    for (size_t i = 0; i < s->n; i++) {
        struct job *job = &s->job[i];
        int first = pick(seed, 2, -20, 1200), step = pick(seed, 3, 1, 4);
        job->name = (char *)(uintptr_t) "sample";
        job->frames = (struct frame_range){first, first + step * pick(seed, 4, 0, 120), step};
        job->output.vdb.every = pick(seed, 5, 1, 7);
        job->output.aov.every = 1;
        job->checkpoint.keep = pick(seed, 6, 1, 4);
        job->farm.block_frames = pick(seed, 7, 1, 60);
        job->farm.chunk_frames = pick(seed, 8, 1, 20);
        job->farm.meshes = pick(seed, 9, 0, 1);
        static char *shot[] = {(char *)(uintptr_t) "shot"};
        job->farm.n_cameras = (size_t)pick(seed, 12, 0, 1);
        job->farm.cameras = shot;
        static char *values[] = {(char *)(uintptr_t) "stress", (char *)(uintptr_t) "von_mises"};
        job->farm.n_show = (size_t)pick(seed, 14, 0, 2);
        job->farm.show = values;
        job->farm.still_every = pick(seed, 10, 0, 5);
        job->farm.turntable = pick(seed, 11, 0, 1) * pick(seed, 13, 1, 72);
        job->wedge.index = s->n > 1 ? (int)i + 1 : 0;
        s->wedge[i].job = job;
        s->wedge[i].frame_seconds = 1.5;
        s->wedge[i].estimate = (struct model_estimate){.n_particles = 1000,
                                                       .device_bytes = 1000000,
                                                       .host_bytes = 1000,
                                                       .disk = {.points = 5000},
                                                       .checkpoint_bytes = 3000};
    }
}

static const struct job *job_of(const struct sample *s, const struct farm_task *t)
{
    return &s->job[t->wedge ? t->wedge - 1 : 0];
}

/* The notice covers the frame that is being made and its checkpoint, within what schedulers take. */
static void long_frames_are_told_earlier(void **state)
{
    (void)state;
    struct farm_wedge wedge[3] = {{.frame_seconds = 0}, {.frame_seconds = 20}, {.frame_seconds = 0}};
    assert_int_equal(farm_notice_seconds(wedge, 3, 180, 65535), 180);
    wedge[2].frame_seconds = 400.25;
    assert_int_equal(farm_notice_seconds(wedge, 3, 180, 65535), 861);
    assert_int_equal(farm_notice_seconds(wedge, 2, 180, 65535), 180);
    assert_int_equal(farm_notice_seconds(wedge, 3, 300, 600), 600);
    wedge[2].frame_seconds = 1e300;
    assert_int_equal(farm_notice_seconds(wedge, 3, 180, 65535), 65535);
}

/* How many tasks of `kind` in `wedge` make `frame`; *which is the last of them. */
static int made(const struct farm_graph *g, enum farm_kind kind, int wedge, int frame, size_t *which)
{
    int n = 0;
    for (size_t i = 0; i < g->n; i++)
        if (g->task[i].kind == kind && g->task[i].wedge == wedge && range_holds(g->task[i].frames, frame)) {
            *which = i;
            n++;
        }
    return n;
}

static bool waits_for(const struct farm_graph *g, size_t task, size_t other)
{
    for (size_t k = 0; k < g->task[task].n_after; k++) {
        size_t before = g->after[g->task[task].after + k];
        if (before == other || waits_for(g, before, other))
            return true;
    }
    return false;
}

static void every_frame_is_made_exactly_once(void **state)
{
    (void)state;
    size_t tasks = 0, frames = 0;
    for (int seed = 0; seed < JOBS; seed++) {
        struct sample s;
        struct farm_graph g = {0};
        make_sample(seed, &s);
        assert_ok(graph_make(s.wedge, s.n, &g));
        tasks += g.n;
        for (size_t w = 0; w < s.n; w++) {
            const struct job *job = &s.job[w];
            int index = (int)job->wedge.index;
            size_t sim = SIZE_MAX, other = SIZE_MAX;
            for (int frame = job->frames.first - 3; frame <= job->frames.last + 3; frame++) {
                bool own = range_holds(job->frames, frame);
                frames += own;
                assert_int_equal(made(&g, FARM_SIM, index, frame, &sim), own);
                assert_int_equal(made(&g, FARM_MESH, index, frame, &other),
                                 own && job->farm.meshes && graph_has_volumes(job, frame));
                if (own && job->farm.meshes && graph_has_volumes(job, frame))
                    assert_true(waits_for(&g, other, sim));
                assert_int_equal(made(&g, FARM_AOV, index, frame, &other),
                                 own && job->farm.n_cameras && graph_has_volumes(job, frame));
                if (own && job->farm.n_cameras && graph_has_volumes(job, frame))
                    assert_true(waits_for(&g, other, sim));
                assert_int_equal(made(&g, FARM_STILL, index, frame, &other),
                                 own && graph_has_still(job, frame));
                if (own && graph_has_still(job, frame))
                    assert_true(waits_for(&g, other, sim));
                assert_int_equal(made(&g, FARM_SHOW, index, frame, &other),
                                 own && graph_has_still(job, frame) ? job->farm.n_show : 0);
                if (own && graph_has_still(job, frame) && job->farm.n_show)
                    assert_true(waits_for(&g, other, sim));
            }
        }
        graph_free(&g);
    }
    print_message("# %d random jobs: %zu tasks, %zu frames\n", JOBS, tasks, frames);
}

static void every_view_is_made_exactly_once(void **state)
{
    (void)state;
    size_t views = 0, tasks = 0;
    for (int seed = 0; seed < JOBS; seed++) {
        struct sample s;
        struct farm_graph g = {0};
        make_sample(seed, &s);
        assert_ok(graph_make(s.wedge, s.n, &g));
        for (size_t w = 0; w < s.n; w++) {
            const struct job *job = &s.job[w];
            int count[100] = {0};
            for (size_t i = 0; i < g.n; i++) {
                const struct farm_task *t = &g.task[i];
                if (t->kind != FARM_VIEW || t->wedge != (int)job->wedge.index)
                    continue;
                tasks++;
                assert_int_equal(t->frames.last, job->frames.last);
                assert_in_range(range_count(t->views), 1, job->farm.chunk_frames);
                for (int view = t->views.first; view <= t->views.last; view++)
                    count[view]++;
            }
            for (int view = 0; view < 100; view++)
                assert_int_equal(count[view], view < job->farm.turntable);
            views += (size_t)job->farm.turntable;
        }
        graph_free(&g);
    }
    print_message("# %zu views in %zu tasks\n", views, tasks);
}

/* Of each value every still, once. */
static void every_value_is_shown(void **state)
{
    (void)state;
    size_t n = 0;
    for (int seed = 0; seed < JOBS; seed++) {
        struct sample s;
        struct farm_graph g = {0};
        struct farm f = {.root = {"/x"}, .hoodoo = {"hoodoo"}};
        struct farm_command *c;
        assert_ok(memory_alloc(1, sizeof *c, "a command", &c));
        make_sample(seed, &s);
        f.wedge = s.wedge;
        f.n_wedges = s.n;
        assert_ok(graph_make(s.wedge, s.n, &g));
        const struct job *job = &s.job[0];
        for (size_t v = 0; v < job->farm.n_show; v++)
            for (int frame = job->frames.first; frame <= job->frames.last; frame++) {
                int times = 0;
                for (size_t i = 0; i < g.n; i++) {
                    const struct farm_task *t = &g.task[i];
                    if (t->kind != FARM_SHOW || t->wedge != (int)job->wedge.index ||
                        !range_holds(t->frames, frame) || strcmp(t->show, job->farm.show[v]) != 0)
                        continue;
                    times++;
                    char show[40];
                    int words = 0;
                    snprintf(show, sizeof show, "--show=%s", job->farm.show[v]);
                    assert_ok(farm_command(&f, t, NULL, 0, c));
                    for (size_t k = 0; k < c->n; k++)
                        words += strcmp(c->argv[k], show) == 0;
                    assert_int_equal(words, 1);
                    assert_non_null(strstr(t->name, v ? "show.von-mises." : "show.stress."));
                }
                assert_int_equal(times, range_holds(job->frames, frame) && graph_has_still(job, frame));
                n += (size_t)times;
            }
        graph_free(&g);
        free(c);
    }
    print_message("# %zu stills of values\n", n);
}

static void tasks_stand_behind_what_they_wait_for(void **state)
{
    (void)state;
    for (int seed = 0; seed < JOBS; seed++) {
        struct sample s;
        struct farm_graph g = {0};
        size_t last_sim[WEDGES + 1];
        make_sample(seed, &s);
        assert_ok(graph_make(s.wedge, s.n, &g));
        memset(last_sim, 0xff, sizeof last_sim);
        for (size_t i = 0; i < g.n; i++) {
            const struct farm_task *t = &g.task[i];
            for (size_t k = 0; k < t->n_after; k++)
                assert_true(g.after[t->after + k] < i); /* so there is no circle */
            assert_true(range_count(t->frames) <=
                        (size_t)(t->kind == FARM_SIM         ? job_of(&s, t)->farm.block_frames
                                 : farm_kind_is_cut(t->kind) ? job_of(&s, t)->farm.chunk_frames
                                                             : 100000));
            if (t->kind == FARM_SIM) {
                /* A block waits for the one before it, and for nothing else. */
                size_t before = last_sim[t->wedge];
                assert_int_equal(t->n_after, before != SIZE_MAX);
                if (before != SIZE_MAX) {
                    assert_int_equal(g.after[t->after], before);
                    assert_int_equal(g.task[before].frames.last + t->frames.step, t->frames.first);
                }
                last_sim[t->wedge] = i;
            }
            /* A finish waits for all it shows. */
            for (size_t k = 0; k < g.n && t->kind == FARM_SHEET; k++)
                if (g.task[k].kind == FARM_STILL && g.task[k].wedge == t->wedge)
                    assert_true(waits_for(&g, i, k));
            if (t->kind == FARM_TURNTABLE || t->kind == FARM_VIEW)
                assert_true(waits_for(&g, i, last_sim[t->wedge]));
            for (size_t k = 0; k < g.n && t->kind == FARM_TURNTABLE; k++)
                if (g.task[k].kind == FARM_VIEW && g.task[k].wedge == t->wedge)
                    assert_true(waits_for(&g, i, k));
            /* The task that ends the job is the last one, and no other ends after it starts. */
            assert_int_equal(t->kind == FARM_END, i == g.n - 1);
            for (size_t k = 0, at = 0; k < i && t->kind == FARM_END; k++) {
                const bool waits = at < t->n_after && g.after[t->after + at] == k;
                at += waits;
                assert_int_equal(waits, g.task[k].kind != FARM_SIM || k == last_sim[g.task[k].wedge]);
            }
            for (size_t k = 0; k < i; k++)
                assert_string_not_equal(g.task[k].name, t->name);
            assert_int_equal(strspn(t->name, "abcdefghijklmnopqrstuvwxyz0123456789.-"), strlen(t->name));
        }
        graph_free(&g);
    }
}

/* Each row of kinds.def is whole, and its command says what its tasks are for. */
static void kinds_say_what_is_needed(void **state)
{
    (void)state;
    const struct command_values none = {.progress = "none"};
    struct farm_command c;
    for (int k = 0; k < FARM_KINDS; k++) {
        const struct farm_kind_info *kind = &farm_kinds[k];
        assert_true(*kind->name && *farm_stage_name((enum farm_kind)k) && *kind->step && *kind->command);
        if (kind->cut == CUT_CHUNKS || kind->cut == CUT_LIST)
            assert_non_null(kind->takes);
        if (kind->cut == CUT_ONCE || kind->cut == CUT_LAST || kind->cut == CUT_VIEWS) {
            assert_non_null(kind->wanted);
            assert_int_not_equal(kind->after, 0);
        }
        assert_int_equal(kind->after >> k, 0); /* only kinds that stand before it */
        assert_int_equal(kind->device, strstr(kind->command, "{device}") != NULL);
        assert_int_equal(kind->cut == CUT_VIEWS, strstr(kind->command, "{view}") != NULL);
        assert_int_equal(farm_kind_is_cut((enum farm_kind)k) && kind->cut != CUT_VIEWS,
                         strstr(kind->command, "{frames}") != NULL);
        assert_int_equal(kind->cut == CUT_ALL_WEDGES || kind->cut == CUT_JOB,
                         strstr(kind->command, "{wedge}") == NULL);
        assert_int_equal(kind->side_by_side, kind->cut == CUT_LIST || kind->cut == CUT_VIEWS);
        /* Words without a value are left out, and no brace is left. */
        assert_ok(command_fill(&(struct command_head){.hoodoo = "hoodoo"}, (enum farm_kind)k, &none, &c));
        for (size_t i = 1; i < c.n; i++)
            assert_null(strpbrk(c.argv[i], "{}"));
        assert_string_equal(c.argv[c.n - 1], kind->cut == CUT_JOB ? "--end" : "--progress=none");
    }
}

/* ---- what is done, as files tell */

/* A frame's manifest, whose volumes have this hash. */
static void put_frame(const char *root, int frame, uint64_t hash)
{
    struct manifest_file file = {.size = 1, .hash = hash};
    const struct manifest m = {.frame = frame, .n_files = 1, .file = &file};
    char path[300];
    snprintf(file.path, sizeof file.path, "volumes/sample.%04d.vdb", frame);
    snprintf(path, sizeof path, "%s/frames", root);
    assert_ok(folder_make(path));
    assert_ok(manifest_write(root, "sample", &m));
}

static void put_product(const char *root, const char *name, int frame, const char *text)
{
    struct recipe recipe = {.root = root};
    assert_ok(recipe_of_frame(&recipe, "sample", frame));
    assert_ok(product_write(&recipe, name, text, strlen(text)));
}

/* Of the stills of both frames, as put_product() writes them with this text. */
static void put_sheet(const char *root, const char *text)
{
    const uint64_t hash = hash_bytes(text, strlen(text));
    const struct shown_product shows[] = {{"preview/sample.0007.png", hash},
                                          {"preview/sample.0008.png", hash}};
    const struct recipe recipe = {.root = root, .frame = ALL_FRAMES, .shows = shows, .n_shows = 2};
    assert_ok(product_write(&recipe, "sample.contact.png", "sheet", 5));
}

/* By kind, a file that its task makes and the one that is made of, in a job of frames 0007 and 0008. */
static void tasks_are_done_when_their_files_are_there_and_current(void **state)
{
    (void)state;
    static const struct {
        enum farm_kind kind;
        const char *made, *from;
    } cases[] = {
        {FARM_MESH, "mesh/sample.0008.obj", "volumes/sample.0008.vdb"},
        {FARM_AOV, "aov/sample.shot.0007.exr", "volumes/sample.0007.vdb"},
        {FARM_STILL, "preview/sample.0007.png", "volumes/sample.0007.vdb"},
        {FARM_SHOW, "preview/sample.von_mises.0008.png", "volumes/sample.0008.vdb"},
        {FARM_SHEET, "sample.contact.png", "preview/sample.0007.png"},
        {FARM_VIEW, "turntable/sample.0008.002.png", "volumes/sample.0008.vdb"},
        {FARM_TURNTABLE, "sample.turntable.mp4", "volumes/sample.0008.vdb"},
    };
    static const char *const all[] = {"mesh/sample.0007.obj",
                                      "mesh/sample.0008.obj",
                                      "aov/sample.shot.0007.exr",
                                      "aov/sample.shot.0008.exr",
                                      "preview/sample.0007.png",
                                      "preview/sample.0008.png",
                                      "preview/sample.stress.0007.png",
                                      "preview/sample.stress.0008.png",
                                      "preview/sample.von_mises.0007.png",
                                      "preview/sample.von_mises.0008.png",
                                      "turntable/sample.0008.000.png",
                                      "turntable/sample.0008.001.png",
                                      "turntable/sample.0008.002.png"};
    static char *shot[] = {(char *)(uintptr_t) "shot"};
    static char *values[] = {(char *)(uintptr_t) "stress", (char *)(uintptr_t) "von_mises"};
    struct job job = {.name = (char *)(uintptr_t) "sample", .frames = {7, 8, 1}};
    job.output.vdb.every = job.output.aov.every = job.farm.still_every = job.farm.meshes = 1;
    job.farm.block_frames = job.farm.chunk_frames = 10;
    job.farm.cameras = shot;
    job.farm.n_cameras = 1;
    job.farm.show = values;
    job.farm.n_show = 2;
    job.farm.turntable = 3;
    struct farm_wedge wedge = {.job = &job};
    struct farm f = {.base = &job, .wedge = &wedge, .n_wedges = 1};
    char root[] = "farm-done-XXXXXX";
    assert_non_null(mkdtemp(root));
    assert_ok(path_format(&f.root, "%s", root));
    assert_ok(graph_make(&wedge, 1, &f.graph));
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        put_frame(root, 7, 1);
        put_frame(root, 8, 1);
        for (size_t i = 0; i < sizeof all / sizeof *all; i++)
            put_product(root, all[i], strstr(all[i], "0007") ? 7 : 8, "made");
        put_sheet(root, "made");
        put_product(root, "sample.turntable.mp4", 8, "made");
        for (int what = 0; what < 4; what++) {
            char path[300];
            snprintf(path, sizeof path, "%s/%s", root, cases[c].made);
            if (what == 1) { /* made anew since */
                if (strncmp(cases[c].from, "volumes", 7) == 0)
                    put_frame(root, strstr(cases[c].from, "0007") ? 7 : 8, 2);
                else
                    put_product(root, cases[c].from, 7, "anew");
            }
            if (what == 2) { /* it again, of what is there */
                put_frame(root, 7, 1);
                put_frame(root, 8, 1);
                assert_int_equal(truncate(path, 3), 0);
            }
            if (what == 3)
                assert_int_equal(unlink(path), 0);
            for (size_t i = 0; i < f.graph.n; i++) {
                bool done, about = f.graph.task[i].kind == cases[c].kind;
                if (!about || (f.graph.task[i].show && !strstr(cases[c].made, f.graph.task[i].show)))
                    continue;
                assert_ok(farm_task_done(&f, &f.graph.task[i], &done));
                assert_int_equal(done, what == 0);
            }
        }
    }
    graph_free(&f.graph);
}

static void longer_jobs_take_longer(void **state)
{
    (void)state;
    for (int seed = 0; seed < JOBS; seed++) {
        struct sample s;
        struct farm_graph a = {0}, b = {0};
        double seconds[2] = {0}, disk[2] = {0};
        make_sample(seed, &s);
        assert_ok(graph_make(s.wedge, s.n, &a));
        for (size_t i = 0; i < s.n; i++) {
            s.job[i].frames.last += s.job[i].frames.step * pick(seed, 20, 1, 50);
            s.wedge[i].estimate.n_particles *= 2;
        }
        assert_ok(graph_make(s.wedge, s.n, &b));
        for (size_t i = 0; i < a.n; i++) {
            seconds[0] += a.task[i].seconds;
            disk[0] += (double)a.task[i].disk_bytes;
            /* Inside one graph: more frames, more time. */
            for (size_t k = 0; k < i; k++)
                if (a.task[k].kind == a.task[i].kind &&
                    range_count(a.task[k].frames) > range_count(a.task[i].frames))
                    assert_true(a.task[k].seconds > a.task[i].seconds);
        }
        for (size_t i = 0; i < b.n; i++) {
            seconds[1] += b.task[i].seconds;
            disk[1] += (double)b.task[i].disk_bytes;
        }
        assert_true(seconds[1] > seconds[0] && disk[1] > disk[0]);
        graph_free(&a);
        graph_free(&b);
    }
}

static const char *const hostile[] = {
    "plain",
    "two words",
    "it's",
    "\"",
    "$(touch pwned)",
    "`touch pwned`",
    "a\nopenjd_env: X=1",
    "; touch pwned",
    "../..",
    "-rf",
    "\\",
    "%j%A",
    "{{Param.X}}",
    "\xc3\xa9\xe5\xb2\xa9",
    "*",
    "~",
    "!!",
    "&&touch pwned",
    "#",
    "'$(touch pwned)'",
};

static void a_shell_takes_quoted_words_as_they_are(void **state)
{
    (void)state;
    struct text line = {0};
    char got[4096] = "", want[4096] = "";
    text_add(&line, "printf '%%s\\000'");
    for (size_t i = 0; i < sizeof hostile / sizeof *hostile; i++) {
        text_add(&line, " ");
        farm_quote(&line, hostile[i]);
    }
    assert_ok(text_status(&line));
    FILE *f = popen(line.data, "r");
    assert_non_null(f);
    size_t n = fread(got, 1, sizeof got, f), at = 0;
    assert_int_equal(pclose(f), 0);
    for (size_t i = 0; i < sizeof hostile / sizeof *hostile; i++) {
        strcpy(want + at, hostile[i]);
        at += strlen(hostile[i]) + 1;
    }
    assert_int_equal(n, at);
    assert_memory_equal(got, want, at);
    assert_int_not_equal(access("pwned", F_OK), 0);
    text_free(&line);
}

static void paths_stay_single_words_of_a_command(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof hostile / sizeof *hostile; i++) {
        struct sample s;
        struct farm f = {0};
        struct farm_command *c;
        assert_ok(memory_alloc(1, sizeof *c, "a command", &c));
        make_sample(3, &s);
        f.wedge = s.wedge;
        f.n_wedges = s.n;
        snprintf(f.root.text, sizeof f.root.text, "/x/%s", hostile[i]);
        snprintf(f.hoodoo.text, sizeof f.hoodoo.text, "/bin/%s", hostile[i]);
        assert_ok(graph_make(s.wedge, s.n, &f.graph));
        for (size_t k = 0; k < f.graph.n; k++) {
            bool root = false;
            assert_ok(farm_command(&f, &f.graph.task[k], hostile[i], 2, c));
            assert_string_equal(c->argv[0], f.hoodoo.text);
            for (size_t word = 1; word < c->n; word++) {
                root |= strncmp(c->argv[word], f.root.text, strlen(f.root.text)) == 0;
                /* No word but an option of ours begins with a dash. */
                if (c->argv[word][0] == '-')
                    assert_memory_equal(c->argv[word], "--", 2);
            }
            assert_true(root);
            assert_null(c->argv[c->n]);
        }
        graph_free(&f.graph);
        free(c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_frame_is_made_exactly_once),
        cmocka_unit_test(every_view_is_made_exactly_once),
        cmocka_unit_test(every_value_is_shown),
        cmocka_unit_test(tasks_stand_behind_what_they_wait_for),
        cmocka_unit_test(kinds_say_what_is_needed),
        cmocka_unit_test(tasks_are_done_when_their_files_are_there_and_current),
        cmocka_unit_test(longer_jobs_take_longer),
        cmocka_unit_test(long_frames_are_told_earlier),
        cmocka_unit_test(a_shell_takes_quoted_words_as_they_are),
        cmocka_unit_test(paths_stay_single_words_of_a_command),
    };
    return cmocka_run_group_tests_name("farm", tests, NULL, NULL);
}
