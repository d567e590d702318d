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

/* Some drivers report no PCI address, or zeros. */
static bool has_address(const struct gpu_info *info)
{
    return info->pci[0] && strcmp(info->pci, "0000:00:00.0") != 0;
}

/* Parses "2,3" or "2-3" into the first number and the count; false for anything else. */
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

/* Slurm numbers the GPUs of the whole machine by PCI address. Vulkan orders them differently, and sees only those that the job's
 * control group allows. If the two cannot be matched with certainty, this returns -1, because the wrong GPU may belong to another
 * job. */
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
        return gpu[0]; /* the control group hides all others */
    *why = "neither SLURM_STEP_GPUS nor SLURM_JOB_GPUS is set";
    if (!ids)
        return -1;
    *why = "SLURM_STEP_GPUS or SLURM_JOB_GPUS is not a list of numbers";
    if (!read_ids(ids, &first, &count))
        return -1;
    *why =
        "there are GPUs of several types, and it is not known which of them Slurm counts; select one with uuid: or pci:";
    for (int i = 1; i < n_gpus; i++)
        if (strcmp(info[gpu[i]].type, info[gpu[0]].type) != 0)
            return -1;
    *why = "the PCI addresses of the GPUs are unknown or equal, so Slurm's numbers cannot be matched";
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
        return gpu[0]; /* only this job's GPUs are visible, so its first is the first visible */
    *why = "Slurm's number does not match any visible GPU";
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
