/* memory_available(), from /proc and the folders of control groups. */
#include <ctype.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "system/memory_limits.h"

/* A number in a file of a group's folder, after a key or at the beginning of a line. */
struct place {
    const char *file, *key;
};

/* The same numbers in the two versions of control groups. The kernel can reclaim the page cache and the caches of directory entries and
 * inodes. */
struct version {
    struct place limit[2], usage, reclaimable[3];
};

static const struct version one = {
    {{"/memory.limit_in_bytes", ""}, {"/memory.stat", "hierarchical_memory_limit "}},
    {"/memory.usage_in_bytes", ""},
    {{"/memory.stat", "total_inactive_file "}, {"/memory.stat", "total_active_file "}}};

static const struct version two = {{{"/memory.max", ""}, {"/memory.high", ""}},
                                   {"/memory.current", ""},
                                   {{"/memory.stat", "inactive_file "},
                                    {"/memory.stat", "active_file "},
                                    {"/memory.stat", "slab_reclaimable "}}};

/* One evaluation of all limits. */
struct look {
    const char *root; /* prefix of every path */
    size_t least;     /* smallest limit so far */
    bool grouped;     /* a control group with a limit file was found, even if it sets no limit */
};

static FILE *open_below(const char *root, const char *folder, const char *file)
{
    char *path = NULL;
    FILE *f = NULL;
    if (asprintf(&path, "%s%s%s", root, folder, file) >= 0)
        f = fopen(path, "re");
    free(path);
    return f;
}

/* Reads the number after `key` at the beginning of a line; SIZE_MAX for "max" or "unlimited". Returns false if there is none. */
static bool read_number(const struct look *l, const char *folder, struct place at, size_t *out)
{
    FILE *f = open_below(l->root, folder, at.file);
    char *line = NULL;
    size_t capacity = 0;
    bool found = false;
    while (f && !found && getline(&line, &capacity, f) > 0) {
        if (strncmp(line, at.key, strlen(at.key)) != 0)
            continue;
        const char *text = line + strlen(at.key);
        while (isspace((unsigned char)*text))
            text++;
        if (strncmp(text, "max", 3) == 0 || strncmp(text, "unlimited", 9) == 0)
            *out = SIZE_MAX;
        else if (isdigit((unsigned char)*text))
            *out = strtoull(text, NULL, 10);
        else
            continue;
        found = true;
    }
    free(line);
    if (f)
        fclose(f);
    return found;
}

static void apply_limit(struct look *l, size_t limit, size_t used)
{
    size_t left = limit > used ? limit - used : 0;
    if (limit != SIZE_MAX && left < l->least)
        l->least = left;
}

/* ---- control groups */

static void look_at_group(struct look *l, const struct version *v, const char *folder)
{
    size_t limit = SIZE_MAX, used = 0, number;
    for (int i = 0; i < 2; i++)
        if (read_number(l, folder, v->limit[i], &number)) {
            l->grouped = true;
            limit = number < limit ? number : limit;
        }
    if (limit == SIZE_MAX || !read_number(l, folder, v->usage, &used))
        used = 0;
    for (int i = 0; i < 3 && used > 0; i++)
        if (v->reclaimable[i].file && read_number(l, folder, v->reclaimable[i], &number))
            used -= number < used ? number : used;
    apply_limit(l, limit, used);
}

/* Evaluates a group and its parents, up to the root of the mount. */
static void look_upwards(struct look *l, const struct version *v, const char *mount, const char *group)
{
    char *folder = NULL, *slash;
    if (asprintf(&folder, "%s%s", mount, strcmp(group, "/") == 0 ? "" : group) < 0)
        return;
    for (;;) {
        size_t counts_children = 1;
        look_at_group(l, v, folder);
        slash = strrchr(folder + strlen(mount), '/');
        if (!slash)
            break;
        *slash = '\0';
        read_number(l, folder, (struct place){"/memory.use_hierarchy", ""}, &counts_children);
        if (!counts_children)
            break;
    }
    free(folder);
}

static bool lists(const char *words, const char *word)
{
    size_t n = strlen(word);
    for (const char *at = words; (at = strstr(at, word)); at += n)
        if ((at == words || at[-1] == ',') && (at[n] == ',' || at[n] == '\0'))
            return true;
    return false;
}

/* The process's group in this version, as a path from the root of the hierarchy, released with free(); or NULL. */
static char *group_of(const struct look *l, const struct version *v)
{
    FILE *f = open_below(l->root, "/proc/self/cgroup", "");
    char *line = NULL, *group = NULL;
    size_t capacity = 0;
    while (f && !group && getline(&line, &capacity, f) > 0) {
        char *rest = line, *number = strsep(&rest, ":"), *controllers = strsep(&rest, ":");
        if (!rest || *rest != '/')
            continue;
        rest[strcspn(rest, "\n")] = '\0';
        if (v == &two ? strcmp(number, "0") == 0 && !*controllers : lists(controllers, "memory"))
            group = strdup(rest);
    }
    free(line);
    if (f)
        fclose(f);
    return group;
}

/* Decodes octal escapes such as \040, which mountinfo uses for spaces. */
static void unescape(char *s)
{
    char *to = s;
    for (; *s; s++)
        if (*s == '\\' && strspn(s + 1, "01234567") >= 3) {
            *to++ = (char)((s[1] - '0') * 64 + (s[2] - '0') * 8 + (s[3] - '0'));
            s += 3;
        } else
            *to++ = *s;
    *to = '\0';
}

/* A line of mountinfo: numbers, root, mount point, options..., "-", type, source, options. */
struct mount {
    char *root, *place, *type, *options;
};

static bool parse_mount(char *line, struct mount *m)
{
    char *word;
    line[strcspn(line, "\n")] = '\0';
    for (int i = 0; i < 3; i++)
        strsep(&line, " ");
    m->root = strsep(&line, " ");
    m->place = strsep(&line, " ");
    while ((word = strsep(&line, " ")) && strcmp(word, "-") != 0)
        ;
    m->type = strsep(&line, " ");
    strsep(&line, " ");
    m->options = line;
    if (!m->options)
        return false;
    unescape(m->root);
    unescape(m->place);
    return true;
}

/* The path of `group` relative to the root of a mount, or NULL if it is not below that. */
static const char *below(const char *group, const char *root)
{
    size_t n = strcmp(root, "/") == 0 ? 0 : strlen(root);
    bool inside = strncmp(group, root, n) == 0 && (group[n] == '/' || group[n] == '\0');
    return inside && !strstr(group + n, "/..") ? group + n : NULL;
}

static void look_at_groups(struct look *l, const struct version *v)
{
    char *group = group_of(l, v), *line = NULL;
    FILE *f = group ? open_below(l->root, "/proc/self/mountinfo", "") : NULL;
    size_t capacity = 0;
    struct mount m;
    while (f && getline(&line, &capacity, f) > 0) {
        if (!parse_mount(line, &m))
            continue;
        bool ours = v == &two ? strcmp(m.type, "cgroup2") == 0
                              : strcmp(m.type, "cgroup") == 0 && lists(m.options, "memory");
        const char *rest = ours ? below(group, m.root) : NULL;
        if (rest)
            look_upwards(l, v, m.place, rest);
    }
    free(line);
    if (f)
        fclose(f);
    /* If mountinfo is hidden or outdated, try the usual mount points. */
    if (!l->grouped) {
        const char *rest = group ? below(group, "/") : NULL;
        look_upwards(l, v, v == &two ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory", rest ? rest : "");
    }
    free(group);
}

/* ---- all limits */

size_t memory_available_below(const char *root)
{
    struct look l = {.root = root, .least = SIZE_MAX};
    size_t kib, limit, used;
    if (read_number(&l, "/proc/meminfo", (struct place){"", "MemAvailable:"}, &kib))
        apply_limit(&l, kib > SIZE_MAX / 1024 ? SIZE_MAX : kib * 1024, 0);
    look_at_groups(&l, &two);
    look_at_groups(&l, &one);
    static const struct {
        const char *limit, *used;
    } own[] = {{"Max address space", "VmSize:"}, {"Max data size", "VmData:"}};
    for (int i = 0; i < 2; i++)
        if (read_number(&l, "/proc/self/limits", (struct place){"", own[i].limit}, &limit) &&
            read_number(&l, "/proc/self/status", (struct place){"", own[i].used}, &used))
            apply_limit(&l, limit, used * 1024);
    return l.least;
}

size_t memory_available(void)
{
    return memory_available_below("");
}

size_t memory_resident(void)
{
    struct look l = {.root = ""};
    size_t kib;
    return read_number(&l, "/proc/self/status", (struct place){"", "VmRSS:"}, &kib) ? kib * 1024 : 0;
}
