/* What tasks request from schedulers, what their tries say, and which OpenJD templates are refused. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "farm/needs.h"
#include "farm/openjd.h"
#include "farm/submission.h"
#include "farm/tries.h"
#include "system/atomic_file.h"

static struct job sample_job(void)
{
    struct job job = {.name = (char *)(uintptr_t) "sample", .frames = {1001, 1020, 1}};
    job.output.vdb.every = job.output.aov.every = 1;
    job.farm.block_frames = 10;
    job.farm.chunk_frames = 5;
    job.farm.still_every = 1;
    job.farm.meshes = 1;
    return job;
}

static void requests_come_from_the_plan(void **state)
{
    (void)state;
    struct job job = sample_job();
    struct farm_wedge wedge = {
        .job = &job,
        .frame_seconds = 90,
        .estimate = {
            .n_particles = 1000000, .device_bytes = 3000000000, .host_bytes = 500000000, .kernels = 80}};
    struct farm f = {.base = &job, .wedge = &wedge, .n_wedges = 1};
    struct farm_needs gpu, cpu, other;
    assert_ok(graph_make(&wedge, 1, &f.graph));
    const struct farm_task *sim = &f.graph.task[0];
    farm_needs(&f, sim, NULL, &gpu);
    farm_needs(&f, sim, "cpu", &cpu);
    assert_true(gpu.gpu && !cpu.gpu);
    assert_int_equal(gpu.gpu_bytes, 3000000000);
    assert_int_equal(cpu.gpu_bytes, 0);
    /* On the CPU the device's memory is the machine's. */
    assert_int_equal(cpu.peak_bytes - gpu.peak_bytes, 3000000000);
    assert_true(gpu.peak_bytes > 600000000 && gpu.peak_bytes < 900000000);
    assert_true(fabs((double)gpu.memory_bytes / (double)gpu.peak_bytes - NEEDS_MARGIN) < 1e-6);
    /* Ten frames of 90 s; the notice is two frames and a minute. */
    assert_int_equal(gpu.notice_s, 240);
    assert_int_equal(gpu.limit_s, 1350 + 600 + 240);
    assert_int_equal(gpu.cpus, 2);
    assert_int_equal(cpu.cpus, 4);
    for (size_t i = 0; i < f.graph.n; i++) {
        farm_needs(&f, &f.graph.task[i], NULL, &other);
        assert_int_equal(other.gpu, f.graph.task[i].kind == FARM_SIM);
        assert_true(other.peak_bytes >= 40000000 && other.memory_bytes > other.peak_bytes);
        /* A picture for each core. */
        if (f.graph.task[i].kind == FARM_STILL) {
            struct farm_needs more;
            job.farm.preview.cpus = 4;
            farm_needs(&f, &f.graph.task[i], NULL, &more);
            assert_int_equal(more.cpus, 4);
            assert_int_equal(more.peak_bytes, 40000000 + 4 * (other.peak_bytes - 40000000));
            job.farm.preview.cpus = 0;
        }
    }
    /* What is not known is not made up, and what the job says counts. */
    wedge.frame_seconds = 0;
    struct farm_task unknown = *sim;
    unknown.seconds = 0;
    farm_needs(&f, &unknown, NULL, &other);
    assert_int_equal(other.limit_s, 0);
    assert_int_equal(other.notice_s, 180);
    job.farm.sim = (struct job_tasks){.cpus = 7, .memory_GB = 2.5, .hours = 0.5};
    farm_needs(&f, &unknown, NULL, &other);
    assert_int_equal(other.cpus, 7);
    assert_int_equal(other.memory_bytes, 2500000000);
    assert_int_equal(other.limit_s, 1800);
    assert_int_equal(farm_units(1, 1 << 20), 1);
    assert_int_equal(farm_units(1 << 20, 1 << 20), 1);
    assert_int_equal(farm_units((1 << 20) + 1, 1 << 20), 2);
    graph_free(&f.graph);
}

static void tries_are_counted_from_the_last_submission(void **state)
{
    (void)state;
    char root[] = "tries-XXXXXX";
    struct farm f = {0};
    const struct farm_task task = {.name = "sim.1001-1010"};
    struct farm_tries t;
    struct path path;
    char meaning[160];
    assert_non_null(mkdtemp(root));
    assert_ok(path_format(&f.root, "%s", root));
    assert_ok(path_join(&path, root, "log/farm"));
    assert_ok(folder_make(path.text));
    assert_ok(tries_read(&f, &task, &t));
    assert_true(t.starts == 0 && t.exit_code == -1 && !t.running);
    assert_ok(tries_add(&f, &task, "submitted"));
    assert_ok(tries_add_start(&f, &task, "12"));
    assert_ok(tries_add_end(&f, &task, 4, 33));
    assert_ok(tries_add_start(&f, &task, "12"));
    assert_ok(tries_read(&f, &task, &t));
    assert_true(t.starts == 2 && t.exit_code == 4 && t.running && *t.node);
    /* A line that a dying machine has cut, and what Slurm's script writes. */
    static const char more[] = "{\"event\": \"end\", \"ex\n"
                               "{\"event\": \"end\", \"exit\": 127, \"seconds\": 1}\n"
                               "{\"event\": \"excluded\", \"node\": \"n1\"}\n"
                               "{\"event\": \"start\", \"node\": \"n2\", \"job\": \"13_4\", \"time\": 1}\n"
                               "{\"event\": \"end\", \"exit\": 0, \"seconds\": 7}\n";
    assert_ok(tries_path(&f, &task, &path));
    FILE *file = fopen(path.text, "a");
    assert_non_null(file);
    assert_true(fputs(more, file) >= 0 && fclose(file) == 0);
    assert_ok(tries_read(&f, &task, &t));
    assert_true(t.starts == 3 && t.exit_code == 0 && !t.running);
    assert_true(t.seconds == 7);
    assert_string_equal(t.node, "n2");
    assert_string_equal(t.excluded, "n1");
    assert_ok(tries_add(&f, &task, "cancelled"));
    assert_ok(tries_read(&f, &task, &t));
    assert_true(t.cancelled);
    assert_ok(tries_add(&f, &task, "submitted"));
    assert_ok(tries_read(&f, &task, &t));
    assert_true(t.starts == 0 && t.exit_code == -1 && !*t.excluded && !t.cancelled);
    assert_string_equal(farm_exit_meaning(4, meaning), "output cannot be written");
    assert_non_null(strstr(farm_exit_meaning(137, meaning), "signal 9"));
    assert_non_null(strstr(farm_exit_meaning(127, meaning), "no such program"));
    assert_non_null(strstr(farm_exit_meaning(55, meaning), "not an exit code"));
}

static void submissions_are_read_as_written(void **state)
{
    (void)state;
    char root[] = "submission-XXXXXX";
    struct path path;
    struct submission got,
        s = {.to = TO_SLURM, .wedge = 3, .device = "slurm", .extra = {"--qos=x", "it's \"\\"}, .n_extra = 2};
    assert_non_null(mkdtemp(root));
    assert_ok(submission_read(root, &got));
    assert_int_equal(got.to, -1);
    assert_ok(path_join(&path, root, "farm"));
    assert_ok(folder_make(path.text));
    process_self(&s.process);
    assert_ok(submission_write(root, &s));
    assert_ok(submission_read(root, &got));
    assert_true(got.to == TO_SLURM && got.wedge == 3 && got.workers == 0 && !got.gpus && got.n_extra == 2);
    assert_string_equal(got.device, "slurm");
    assert_string_equal(got.extra[1], "it's \"\\");
    assert_int_equal(process_fate(&got.process), PROCESS_LIVES);
    submission_free(&got);
    assert_ok(path_join(&path, root, "farm/submission.json"));
    assert_ok(atomic_file_write(path.text, "{\"to\": \"nowhere\"}", 17));
    assert_int_equal(submission_read(root, &got), E_INPUT);
}

/* A template of ours, and the same with each of these pieces replaced. */
static void wrong_templates_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *from, *to, *says;
    } cases[] = {
        {"\"Sim_1001-1010\"", "\"\"", "1 to 64 characters"},
        {"\"Sim_1011-1020\"", "\"Sim_1001-1010\"", "two of the step"},
        {"\"dependsOn\": \"Sim_1001-1010\"", "\"dependsOn\": \"Sim_1\"", "is not another step"},
        {"\"name\": \"Device\"", "\"name\": \"Dev-ice\"", "letters, digits"},
        {"\"name\": \"Device\"", "\"name\": \"Hoodoo\"", "two of the parameter"},
        {"{{Param.Device}}", "{{Param.Gadget}}", "Param.Gadget"},
        {"{{Task.Param.Frames}}", "{{Task.Param.Shots}}", "Task.Param.Shots"},
        {"\"1001-1010\"", "\"1010-1001\"", "not ascending"},
        {"\"1001-1010\"", "\"1001-1010,1005\"", "not ascending"},
        {"\"min\": 1\n", "\"min\": 0\n", "positive"},
        {"\"notifyPeriodInSeconds\": 300", "\"notifyPeriodInSeconds\": 601", "1 to 600"},
        {"\"hoodoo sample\"", "\"\"", "1 to 128"},
        {"\"{{Param.Hoodoo}}\"", "\"\"", "no command"},
        {"\"1001-1020\"", NULL, "1030 characters; at most 1024"},
    };
    struct job job = sample_job();
    struct farm_wedge wedge = {.job = &job,
                               .estimate = {.n_particles = 1000, .device_bytes = 1000000, .kernels = 80}};
    struct farm f = {.base = &job, .wedge = &wedge, .n_wedges = 1, .hoodoo = {"hoodoo"}};
    struct text good = {0};
    char frames[1040] = "\"1";
    assert_ok(graph_make(&wedge, 1, &f.graph));
    assert_ok(openjd_template(&f, NULL, &good));
    memset(frames + 1, '1', 1030);
    strcpy(frames + 1031, "\"");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct text bad = {0};
        const char *at = strstr(good.data, cases[i].from);
        assert_non_null(at);
        text_add(&bad, "%.*s%s%s", (int)(at - good.data), good.data, cases[i].to ? cases[i].to : frames,
                 at + strlen(cases[i].from));
        assert_ok(text_status(&bad));
        assert_int_equal(openjd_check(bad.data, bad.size), E_USAGE);
        if (!strstr(status_message(), cases[i].says))
            print_error("%s: %s\n", cases[i].says, status_message());
        assert_non_null(strstr(status_message(), cases[i].says));
        text_free(&bad);
    }
    text_free(&good);
    graph_free(&f.graph);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(requests_come_from_the_plan),
        cmocka_unit_test(tries_are_counted_from_the_last_submission),
        cmocka_unit_test(submissions_are_read_as_written),
        cmocka_unit_test(wrong_templates_are_refused),
    };
    return cmocka_run_group_tests_name("requests", tests, NULL, NULL);
}
