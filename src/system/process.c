#include "system/process.h"

#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/hash.h"

/* Whether /proc belongs to the PID namespace of this process. In a container it may be that of the machine, with other numbers. */
static bool proc_is_ours(void)
{
    char self[32] = "";
    ssize_t n = readlink("/proc/self", self, sizeof self - 1);
    return n > 0 && strtol(self, NULL, 10) == (long)getpid();
}

/* The start time of a process; 0 if /proc does not have it. *ended: it has exited, and its parent has not waited for it yet. */
static unsigned long long process_began(long pid, bool *ended)
{
    char path[64], line[1024];
    unsigned long long began = 0;
    *ended = false;
    if (!proc_is_ours())
        return 0;
    snprintf(path, sizeof path, "/proc/%ld/stat", pid);
    FILE *f = fopen(path, "re");
    if (!f)
        return 0;
    size_t n = fread(line, 1, sizeof line - 1, f);
    fclose(f);
    line[n] = '\0';
    /* The name may contain spaces and parentheses. The start time is the 20th field behind it. */
    char *s = strrchr(line, ')');
    *ended = s && (strncmp(s, ") Z", 3) == 0 || strncmp(s, ") X", 3) == 0);
    for (int field = 0; s && field < 20; field++)
        s = strchr(s + 1, ' ');
    if (s)
        began = strtoull(s, NULL, 10);
    return began;
}

static void first_line(const char *path, char *out, size_t size)
{
    FILE *f = fopen(path, "re");
    out[0] = '\0';
    if (f && fgets(out, (int)size, f))
        out[strcspn(out, "\n")] = '\0';
    if (f)
        fclose(f);
}

static void place_self(struct process_id *p)
{
    *p = (struct process_id){.pid = (long)getpid()};
    gethostname(p->host, sizeof p->host - 1);
    first_line("/proc/sys/kernel/random/boot_id", p->boot, sizeof p->boot);
    ssize_t n = readlink("/proc/self/ns/pid", p->space, sizeof p->space - 1);
    p->space[n > 0 ? n : 0] = '\0';
}

void process_self(struct process_id *out)
{
    bool ended;
    place_self(out);
    out->began = process_began(out->pid, &ended);
}

enum process_fate process_fate(const struct process_id *p)
{
    struct process_id me;
    place_self(&me);
    if (p->pid <= 0 || strcmp(p->host, me.host) != 0 || strcmp(p->boot, me.boot) != 0 || !*p->boot ||
        strcmp(p->space, me.space) != 0 || !*p->space)
        return PROCESS_UNKNOWN;
    if (kill((pid_t)p->pid, 0) != 0 && errno == ESRCH)
        return PROCESS_GONE;
    bool ended;
    const unsigned long long began = process_began(p->pid, &ended);
    if (!began || !p->began)
        return PROCESS_UNKNOWN; /* the number is in use, possibly by another process */
    return began == p->began && !ended ? PROCESS_LIVES : PROCESS_GONE;
}

uint32_t process_place(void)
{
    struct process_id me;
    char all[sizeof me.host + sizeof me.boot + sizeof me.space + 2];
    place_self(&me);
    int n = snprintf(all, sizeof all, "%s\n%s\n%s", me.host, me.boot, me.space);
    return (uint32_t)hash_bytes(all, (size_t)n);
}
