/* Positions of keys in a job file, which is parsed again for this because loaded jobs do not keep them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "job/job.h"
#include "job/yaml.h"
#include "system/atomic_file.h"

static const struct yaml *step_into(const struct yaml *at, const char *part)
{
    if (at->kind == YAML_MAP)
        return yaml_get(at, part);
    return at->kind == YAML_LIST && strspn(part, "0123456789") == strlen(part)
               ? yaml_item(at, strtoul(part, NULL, 10))
               : NULL;
}

void job_key_place(const char *path, const char *key, char out[300])
{
    const struct yaml_source source = {.file = path};
    struct yaml_tree tree = {0};
    struct yaml *root = NULL;
    char *bytes = NULL, copy[300], *rest = copy;
    size_t n = 0;
    snprintf(out, 300, "%.280s", path);
    snprintf(copy, sizeof copy, "%s", key);
    if (file_read(path, YAML_BYTES, &bytes, &n) == OK && yaml_parse(&tree, bytes, n, &source, &root) == OK) {
        const struct yaml *at = root;
        for (char *part; (part = strsep(&rest, ".")) != NULL;) {
            const struct yaml *next = step_into(at, part);
            if (!next)
                break;
            at = next;
        }
        const int line = at->key_line ? at->key_line : at->line,
                  column = at->key_line ? at->key_column : at->column;
        if (line > 0)
            snprintf(out, 300, "%.260s:%d:%d", path, line, column);
    }
    yaml_free(&tree);
    free(bytes);
}
