/* Maps the input files of a job: by OpenJD's path mapping rules (pathmapping-1.0) on another machine, or to the folder of the job itself
 * if it was loaded through a symbolic link. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/log.h"
#include "base/memory.h"
#include "job/parse.h"
#include "system/atomic_file.h"
#include "text/json.h"

enum { RULES_BYTES = 4 << 20 };

struct rule {
    const char *from, *to;
};

struct rules {
    struct rule *rule;
    size_t n;
    bool missing; /* map only files that are missing, and only if the mapped file exists */
};

/* Whether `path` is the rule's source or below it. */
static bool applies(const struct rule *r, const char *path, size_t *length)
{
    size_t n = strlen(r->from);
    while (n > 1 && r->from[n - 1] == '/')
        n--;
    *length = n;
    return n > 0 && strncmp(path, r->from, n) == 0 &&
           (path[n] == '\0' || path[n] == '/' || (n == 1 && *path == '/'));
}

/* The rule with the longest source that applies; the first one of several. */
static status map_path(const struct rules *rules, char **path)
{
    const struct rule *best = NULL;
    size_t longest = 0, n;
    char *mapped = NULL;
    for (size_t i = 0; i < rules->n; i++)
        if (applies(&rules->rule[i], *path, &n) && n > longest) {
            best = &rules->rule[i];
            longest = n;
        }
    if (!best)
        return OK;
    const char *rest = *path + longest;
    size_t size = strlen(best->to) + strlen(rest) + 2;
    status st = memory_alloc(size, 1, "a path", &mapped);
    if (st != OK)
        return st;
    snprintf(mapped, size, "%s%s%s", best->to, *rest && *rest != '/' ? "/" : "", rest);
    if (rules->missing && (access(*path, F_OK) == 0 || access(mapped, F_OK) != 0)) {
        free(mapped);
        return OK;
    }
    if (rules->missing)
        log_info("%s is missing; using %s from the folder of the job that the link refers to", *path, mapped);
    free(*path);
    *path = mapped;
    return OK;
}

static status map_section(const struct rules *rules, enum job_section_id section, void *base);

static status map_node(const struct rules *rules, struct job_node *node)
{
    status st = map_section(rules, node_section(node), &node->u);
    for (size_t i = 0; i < node->n_child && st == OK; i++)
        st = map_node(rules, node->child[i]);
    return st;
}

static status map_section(const struct rules *rules, enum job_section_id section, void *base)
{
    const struct job_section *s = &job_sections[section];
    status st = OK;
    for (size_t i = 0; i < s->n && st == OK; i++) {
        const struct job_key *key = &s->key[i];
        void *member = key_member(key, base);
        size_t n;
        char *items;
        if (key->type == KEY_INPUT) {
            st = map_path(rules, member);
        } else if (key->type == KEY_SUB) {
            st = map_section(rules, (enum job_section_id)key->child, member);
        } else if (key->type == KEY_MAYBE) {
            void *child = *(void **)member;
            st = child ? map_section(rules, (enum job_section_id)key->child, child) : OK;
        } else if (key->type == KEY_NODE) {
            st = *(struct job_node **)member ? map_node(rules, *(struct job_node **)member) : OK;
        } else if (key->type == KEY_LIST || key->type == KEY_MAP) {
            items = key_items(key, base, &n);
            for (size_t k = 0; k < n && st == OK; k++)
                st = map_section(rules, (enum job_section_id)key->child,
                                 items + k * job_sections[key->child].size);
        }
    }
    return st;
}

status map_beside_link(struct job *job, const char *link, const char *real)
{
    struct rule rule = {link, real};
    const struct rules rules = {&rule, 1, true};
    return map_section(&rules, SECTION_job, job);
}

status job_map_paths(struct job *job, const char *file)
{
    status st = OK;
    char *bytes = NULL;
    size_t n;
    struct json *json = NULL;
    struct rules rules = {0};
    TRY(file_read(file, RULES_BYTES, &bytes, &n));
    TRY(json_read(file, bytes, n, &json));
    const struct json *list = json_member(json, "path_mapping_rules");
    if (!list)
        goto done; /* a session without rules has an empty file */
    TRY(memory_alloc(list->n, sizeof *rules.rule, "path mapping rules", &rules.rule));
    for (const struct json *r = list->first; r; r = r->next) {
        const char *format = json_to_text(json_member(r, "source_path_format")),
                   *from = json_to_text(json_member(r, "source_path")),
                   *to = json_to_text(json_member(r, "destination_path"));
        if (!format || !from || !to) {
            st = fail(E_INPUT,
                      "%s: a path mapping rule without source_path_format, source_path or destination_path",
                      file);
            goto done;
        }
        /* Job files contain POSIX paths only. */
        if (strcmp(format, "POSIX") == 0)
            rules.rule[rules.n++] = (struct rule){from, to};
    }
    TRY(map_section(&rules, SECTION_job, job));
done:
    free(rules.rule);
    json_free(&json);
    free(bytes);
    return st;
}
