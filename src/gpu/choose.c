#include "gpu/choose.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { GPUS_MAX = 64 };

static int preference(const struct gpu_info *info)
{
    static const char *const order[] = {"discrete", "integrated", "virtual", "other", "cpu"};
    int rank = 0;
    while (rank < 4 && strcmp(info->type, order[rank]) != 0)
        rank++;
    return info->usable ? rank : 99;
}

/* Some drivers give no address, or zeros. */
static bool has_address(const struct gpu_info *info)
{
    return info->pci[0] && strcmp(info->pci, "0000:00:00.0") != 0;
}

/* "2,3" or "2-3": the first number, and how many there are; false if it is anything else. */
static bool read_ids(const char *ids, int *first, int *count)
{
    int value[2], n = 0;
    *count = 0;
    for (const char *s = ids;; s++) {
        char *end;
        if (!isdigit((unsigned char)*s) || strspn(s, "0123456789") > 4)
            return false;
        value[n] = (int)strtol(s, &end, 10);
        s = end;
        if (*s == '-' && n == 0) {
            n = 1;
            continue;
        }
        if (n == 1 && value[1] < value[0])
            return false;
        if (*count == 0)
            *first = value[0];
        *count += n == 1 ? value[1] - value[0] + 1 : 1;
        n = 0;
        if (!*s)
            return true;
        if (*s != ',')
            return false;
    }
}

/* Slurm numbers its GPUs by PCI address, over the whole machine; Vulkan does not, and sees what the control
 * group lets through. Where the two cannot be matched for certain there is no answer: the wrong GPU is
 * another job's. */
static int slurm_device(const char *ids, const struct gpu_info *info, size_t n, const char **why)
{
    int gpu[GPUS_MAX], n_gpus = 0, first = 0, count = 0;
    for (size_t i = 0; i < n && n_gpus < GPUS_MAX; i++)
        if (!info[i].is_cpu)
            gpu[n_gpus++] = (int)i;
    *why = "no GPU is visible, and Slurm jobs never fall back to a CPU device";
    if (n_gpus == 0)
        return -1;
    if (n_gpus == 1)
        return gpu[0]; /* all others are kept from this job */
    *why = "neither SLURM_STEP_GPUS nor SLURM_JOB_GPUS is set";
    if (!ids)
        return -1;
    *why = "SLURM_STEP_GPUS or SLURM_JOB_GPUS is not a list of numbers";
    if (!read_ids(ids, &first, &count))
        return -1;
    *why =
        "GPUs of several types are here, and which of them Slurm counts is not known; name one by uuid: or pci:";
    for (int i = 1; i < n_gpus; i++)
        if (strcmp(info[gpu[i]].type, info[gpu[0]].type) != 0)
            return -1;
    *why = "the GPUs' PCI addresses are unknown or alike, so Slurm's numbers cannot be matched";
    for (int i = 0; i < n_gpus; i++) {
        if (!has_address(&info[gpu[i]]))
            return -1;
        for (int k = i; k > 0; k--) {
            int order = strcasecmp(info[gpu[k]].pci, info[gpu[k - 1]].pci);
            if (order == 0)
                return -1;
            if (order > 0)
                break;
            int swap = gpu[k];
            gpu[k] = gpu[k - 1];
            gpu[k - 1] = swap;
        }
    }
    if (count == n_gpus)
        return gpu[0]; /* exactly this job's are visible: its first is the first */
    *why = "Slurm's number is not one of the GPUs seen here";
    return first < n_gpus ? gpu[first] : -1;
}

static int named_device(const char *wanted, const struct gpu_info *info, size_t n)
{
    bool uuid = wanted[0] == 'u';
    char hex[64] = "";
    size_t length = 0;
    for (const char *c = wanted + (uuid ? 5 : 4); *c && length < sizeof hex - 1; c++)
        if (!uuid || *c != '-')
            hex[length++] = *c;
    for (size_t i = 0; i < n; i++)
        if (length && strcasecmp(uuid ? info[i].uuid : info[i].pci, hex) == 0)
            return (int)i;
    return -1;
}

status gpu_choose(const char *wanted, const char *slurm_gpus, const struct gpu_info *info, size_t n,
                  size_t *chosen)
{
    int found = -1;
    const char *why = "there is no such device";
    if (!wanted || strcmp(wanted, "auto") == 0) {
        why = "none of them has Vulkan 1.2 with buffer addresses and scalar layout";
        for (size_t i = 0; i < n; i++)
            if (info[i].usable && (found < 0 || preference(&info[i]) < preference(&info[found])))
                found = (int)i;
    } else if (strcmp(wanted, "cpu") == 0) {
        why = "none of them is a CPU device; install mesa-vulkan-drivers";
        for (size_t i = n; i > 0; i--)
            if (info[i - 1].usable && info[i - 1].is_cpu)
                found = (int)i - 1;
    } else if (strcmp(wanted, "slurm") == 0) {
        found = slurm_device(slurm_gpus, info, n, &why);
    } else if (strncmp(wanted, "uuid:", 5) == 0 || strncmp(wanted, "pci:", 4) == 0) {
        found = named_device(wanted, info, n);
    } else {
        char *end;
        long index = strtol(wanted, &end, 10);
        if (*wanted == '\0' || *end || index < 0)
            return fail(E_USAGE,
                        "--device %.60s: write auto, cpu, INDEX, uuid:HEX, pci:DDDD:BB:DD.F or slurm",
                        wanted);
        found = index < (long)n ? (int)index : -1;
    }
    if (found >= 0 && !info[found].usable) {
        why = "it lacks Vulkan 1.2 with buffer addresses and scalar layout";
        found = -1;
    }
    if (found < 0) {
        char list[600] = "";
        size_t used = 0;
        for (size_t i = 0; i < n && used < sizeof list - 1; i++)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%zu: %s%s%s", i ? ", " : "", i,
                                     info[i].name, info[i].pci[0] ? " at " : "", info[i].pci);
        return fail(E_DEVICE, "--device %s: %s; devices here: %s", wanted ? wanted : "auto", why, list);
    }
    *chosen = (size_t)found;
    return OK;
}
