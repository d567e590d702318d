/* --device, on machines that are made up: above all Slurm's numbers, which are not Vulkan's. */
#include "check.h"

#include <stdio.h>
#include <string.h>

#include "gpu/choose.h"

static struct gpu_info gpu(const char *name, const char *pci)
{
    struct gpu_info g = {.usable = true};
    snprintf(g.name, sizeof g.name, "%s", name);
    snprintf(g.pci, sizeof g.pci, "%s", pci);
    snprintf(g.uuid, sizeof g.uuid, "%032x", (unsigned)strlen(name));
    snprintf(g.type, sizeof g.type, "discrete");
    return g;
}

static struct gpu_info cpu(void)
{
    struct gpu_info g = gpu("llvmpipe", "");
    snprintf(g.type, sizeof g.type, "cpu");
    g.is_cpu = true;
    return g;
}

/* The name chosen, or the sentence of the refusal. */
static const char *chosen(const char *wanted, const char *ids, const struct gpu_info *info, size_t n)
{
    size_t k;
    return gpu_choose(wanted, ids, info, n, &k) == OK ? info[k].name : status_message();
}

static void slurms_numbers_go_by_pci_address(void **state)
{
    (void)state;
    const struct gpu_info four[] = {cpu(), gpu("d", "0000:c1:00.0"), gpu("a", "0000:01:00.0"),
                                    gpu("c", "0000:81:00.0"), gpu("b", "0000:41:00.0")};
    assert_string_equal(chosen("slurm", "0", four, 5), "a");
    assert_string_equal(chosen("slurm", "1", four, 5), "b");
    assert_string_equal(chosen("slurm", "3", four, 5), "d");
    assert_string_equal(chosen("slurm", "2,3", four, 5), "c");
    assert_string_equal(chosen("slurm", "1-2", four, 5), "b");
    assert_string_equal(chosen("slurm", "0-3", four, 5), "a");
}

static void a_control_group_hides_other_jobs_gpus(void **state)
{
    (void)state;
    /* Slurm's number 3 is the only one seen; 2 and 3 are the two that are seen. */
    const struct gpu_info one[] = {cpu(), gpu("only", "0000:c1:00.0")};
    const struct gpu_info two[] = {gpu("d", "0000:c1:00.0"), gpu("c", "0000:81:00.0"), cpu()};
    assert_string_equal(chosen("slurm", "3", one, 2), "only");
    assert_string_equal(chosen("slurm", NULL, one, 2), "only");
    assert_string_equal(chosen("slurm", "2,3", two, 3), "c");
}

static void what_is_not_certain_is_refused(void **state)
{
    (void)state;
    const struct gpu_info two[] = {gpu("b", "0000:41:00.0"), gpu("a", "0000:01:00.0")};
    const struct gpu_info blind[] = {gpu("b", ""), gpu("a", "0000:01:00.0")};
    const struct gpu_info zeros[] = {gpu("b", "0000:00:00.0"), gpu("a", "0000:00:00.0")};
    const struct gpu_info alike[] = {gpu("b", "0000:01:00.0"), gpu("a", "0000:01:00.0"),
                                     gpu("c", "0000:02:00.0")};
    const struct gpu_info none[] = {cpu()};
    const char *const bad[] = {"",    "x",           "-1",   "1,", "0;1",  "GPU-2",
                               "3-2", "99999999999", "0,,1", "1 ", "0-1-2"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_non_null(strstr(chosen("slurm", bad[i], two, 2), "not a list of numbers"));
    assert_non_null(strstr(chosen("slurm", "2", two, 2), "does not match any visible GPU"));
    assert_non_null(strstr(chosen("slurm", NULL, two, 2), "neither SLURM_STEP_GPUS"));
    assert_non_null(strstr(chosen("slurm", "0", blind, 2), "the PCI addresses of the GPUs are unknown"));
    assert_non_null(strstr(chosen("slurm", "0", zeros, 2), "the PCI addresses of the GPUs are unknown"));
    assert_non_null(strstr(chosen("slurm", "0", alike, 3), "unknown or equal"));
    struct gpu_info laptop[] = {two[0], two[1]};
    snprintf(laptop[1].type, sizeof laptop[1].type, "integrated");
    assert_non_null(strstr(chosen("slurm", "0", laptop, 2), "several types"));
    assert_non_null(strstr(chosen("slurm", "0", none, 1), "no GPU is visible"));
    assert_non_null(strstr(chosen("slurm", "2", two, 2), "0: b at 0000:41:00.0, 1: a at 0000:01:00.0"));
}

static void other_names(void **state)
{
    (void)state;
    struct gpu_info mixed[] = {cpu(), gpu("old", "0000:01:00.0"), gpu("gpu", "0000:02:00.0")};
    mixed[1].usable = false;
    assert_string_equal(chosen(NULL, NULL, mixed, 3), "gpu");
    assert_string_equal(chosen("auto", "0", mixed, 3), "gpu");
    assert_string_equal(chosen("cpu", NULL, mixed, 3), "llvmpipe");
    assert_string_equal(chosen("0", NULL, mixed, 3), "llvmpipe");
    assert_string_equal(chosen("pci:0000:02:00.0", NULL, mixed, 3), "gpu");
    assert_string_equal(chosen("uuid:00000000-0000-0000-0000-000000000008", NULL, mixed, 3), "llvmpipe");
    assert_non_null(strstr(chosen("1", NULL, mixed, 3), "lacks Vulkan 1.2"));
    assert_non_null(strstr(chosen("slurm", "0", mixed, 3), "lacks Vulkan 1.2")); /* it counts among Slurm's */
    assert_string_equal(chosen("slurm", "1", mixed, 3), "gpu");
    assert_non_null(strstr(chosen("7", NULL, mixed, 3), "no such device"));
    assert_non_null(strstr(chosen("fast", NULL, mixed, 3), "write auto, cpu, INDEX"));
    assert_non_null(strstr(chosen("uuid:", NULL, mixed, 3), "no such device"));
    assert_non_null(strstr(chosen("cpu", NULL, mixed + 1, 2), "none of them is a CPU device"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slurms_numbers_go_by_pci_address),
        cmocka_unit_test(a_control_group_hides_other_jobs_gpus),
        cmocka_unit_test(what_is_not_certain_is_refused),
        cmocka_unit_test(other_names),
    };
    return cmocka_run_group_tests_name("choose", tests, NULL, NULL);
}
