/* Edits: the parameters that they set, and the resulting jobs. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "job/parse.h"

/* Writes a value as one line of YAML. */
static void put_flow(struct text *t, const struct yaml *v)
{
    if (v->kind == YAML_SCALAR) {
        /* Plain text is quoted, because it may contain characters with a meaning inside brackets. */
        if (v->quoted || v->text[strcspn(v->text, ",[]{}:#\n")])
            put_quoted(t, v->text);
        else
            text_add(t, "%s", *v->text ? v->text : "null");
        return;
    }
    text_add(t, v->kind == YAML_MAP ? "{" : "[");
    for (const struct yaml *item = v->first; item; item = item->next) {
        text_add(t, item == v->first ? "" : ", ");
        if (v->kind == YAML_MAP) {
            put_quoted(t, item->key);
            text_add(t, ": ");
        }
        put_flow(t, item);
    }
    text_add(t, v->kind == YAML_MAP ? "}" : "]");
}

void free_sets(struct job_sets *sets)
{
    for (size_t i = 0; i < sets->n; i++) {
        free(sets->item[i].path);
        free(sets->item[i].value);
    }
    free(sets->item);
    job_destroy(&sets->job);
    *sets = (struct job_sets){0};
}

status read_sets(const struct yaml *map, struct job_sets *out)
{
    status st = OK;
    struct text t = {0};
    if (map->kind != YAML_MAP)
        return yaml_fail(map, NULL, "%s where a mapping of key paths is expected ({wind.speed_m_s: 14, ...})",
                         yaml_what(map));
    TRY(memory_alloc(map->n, sizeof *out->item, "settings", &out->item));
    for (const struct yaml *v = map->first; v; v = v->next) {
        struct job_set *set = &out->item[out->n++];
        TRY(memory_strdup(v->key, &set->path));
        put_flow(&t, v);
        TRY(text_status(&t));
        TRY(memory_strdup(t.data, &set->value));
        text_free(&t);
    }
done:
    text_free(&t);
    return st;
}

/* Refuses changes that the state does not allow: particles refer to strata by index, processes keep state for every source, and the air
 * has a fixed box. */
static status check_layout(const struct yaml *at, const struct job *job, const struct job *edited)
{
    if (edited->n_strata != job->n_strata)
        return yaml_fail(at, NULL, "an edit cannot add to strata");
    if (edited->n_sources != job->n_sources)
        return yaml_fail(
            at, NULL, "an edit cannot add to sources; list it from the start, with m3_per_yr 0 until then");
    const struct job_flow *was = &job->wind.flow, *is = &edited->wind.flow;
    if (is->solver != was->solver || is->spacing_m != was->spacing_m || is->domain != was->domain ||
        is->density_iterations != was->density_iterations ||
        is->divergence_iterations != was->divergence_iterations || is->viscosity != was->viscosity)
        return yaml_fail(
            at, NULL,
            "an edit can change only reach_m, settled, flushes, rock_change and wind_change of wind.flow: the air is set up at the start");
    return OK;
}

status read_edited_jobs(struct yaml_tree *tree, struct yaml *root, const char *folder, struct job *job)
{
    status st = OK;
    const struct yaml *list = yaml_get(root, "edits");
    for (size_t i = 0; i < job->n_edits; i++) {
        const struct yaml *set = yaml_get(yaml_item(list, i), "set");
        struct job **edited = &job->edits[i].set.job;
        if (job->edits[i].set.n == 0)
            continue;
        for (const struct yaml *v = set->first; v; v = v->next)
            TRY(job_set_edit(tree, root, v));
        TRY(memory_alloc(1, sizeof **edited, "an edited job", edited));
        TRY(read_section(SECTION_job, root, NULL, folder, *edited));
        TRY(read_default_layer(root, *edited));
        TRY(check_layout(set, job, *edited));
        TRY(check_job(root, *edited));
    }
done:
    return st;
}
