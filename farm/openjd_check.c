/* Limits of OpenJobDescription templates, 2023-09: what a farm would refuse. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "farm/openjd.h"
#include "text/json.h"

enum {
    NAME_MOST = 128,
    STEP_MOST = 64,
    IDENTIFIER_MOST = 64,
    TEXT_MOST = 1024, /* a parameter's value, a range */
    PARAMETERS_MOST = 50,
    TASK_PARAMETERS_MOST = 16,
    REQUIREMENTS_MOST = 50,
    NOTICE_MOST = 600
};

struct names {
    const char **name;
    size_t n;
};

static int by_name(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static bool listed(const struct names *names, const char *name)
{
    return bsearch(&name, names->name, names->n, sizeof *names->name, by_name) != NULL;
}

/* The names of the objects in a list, sorted. E_USAGE: one is missing, too long, no identifier if it has to be, or there twice. */
static status read_names(const struct json *list, const char *what, size_t most, bool identifier,
                         struct names *out)
{
    status st = OK;
    *out = (struct names){0};
    TRY(memory_alloc(list ? list->n : 0, sizeof *out->name, "names", &out->name));
    for (const struct json *item = list ? list->first : NULL; item; item = item->next) {
        const char *name = json_to_text(json_member(item, "name"));
        const size_t n = name ? strlen(name) : 0,
                     letters =
                         name
                             ? strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_")
                             : 0;
        if (n == 0 || n > most || (identifier && (letters != n || strspn(name, "0123456789"))))
            return fail(E_USAGE,
                        "the OpenJD template has a %s named '%.80s': a name has 1 to %zu characters%s", what,
                        name ? name : "", most, identifier ? ", which are letters, digits and _" : "");
        out->name[out->n++] = name;
    }
    qsort(out->name, out->n, sizeof *out->name, by_name);
    for (size_t i = 1; i < out->n; i++)
        if (strcmp(out->name[i - 1], out->name[i]) == 0)
            return fail(E_USAGE, "the OpenJD template has two of the %s '%.80s'", what, out->name[i]);
done:
    return st;
}

/* "1-10", "1-10:2,20": ascending and without overlap. */
static bool range_is_valid(const char *text)
{
    bool any = false;
    long last = 0;
    for (const char *s = text;; s++) {
        char *end;
        const long first = strtol(s, &end, 10);
        if (end == s || (any && first <= last))
            return false;
        last = first;
        s = end;
        if (*s == '-') {
            last = strtol(s + 1, &end, 10);
            if (end == s + 1 || last < first)
                return false;
            s = end;
        }
        if (*s == ':') {
            if (strtol(s + 1, &end, 10) < 1 || end == s + 1)
                return false;
            s = end;
        }
        any = true;
        if (!*s)
            return true;
        if (*s != ',')
            return false;
    }
}

/* Every {{Param.NAME}} and {{Task.Param.NAME}} in the text must be defined. */
static status check_references(const char *text, const char *step, const struct names *parameters,
                               const struct names *task)
{
    for (const char *s = text; (s = strstr(s, "{{"));) {
        static const struct {
            const char *prefix;
            bool task;
        } scopes[] = {{"Param.", false}, {"Task.Param.", true}};
        const char *end = strstr(s, "}}");
        char name[IDENTIFIER_MOST + 1] = "";
        if (!end)
            return fail(E_USAGE, "the OpenJD template's step %s has '{{' without '}}' in '%.80s'", step,
                        text);
        for (size_t i = 0; i < sizeof scopes / sizeof *scopes; i++) {
            const size_t n = strlen(scopes[i].prefix), length = (size_t)(end - s) - 2;
            if (strncmp(s + 2, scopes[i].prefix, n) != 0 || length <= n || length - n > IDENTIFIER_MOST)
                continue;
            memcpy(name, s + 2 + n, length - n);
            if (!listed(scopes[i].task ? task : parameters, name))
                return fail(E_USAGE, "the OpenJD template's step %s uses {{%s%s}}, which is not defined",
                            step, scopes[i].prefix, name);
        }
        s = end;
    }
    return OK;
}

static bool has_control(const char *text)
{
    for (const unsigned char *s = (const unsigned char *)text; *s; s++)
        if (*s < 0x20 || *s == 0x7f)
            return true;
    return false;
}

static status check_parameters(const struct json *list, struct names *names)
{
    status st = OK;
    TRY(read_names(list, "parameter", IDENTIFIER_MOST, true, names));
    if (names->n > PARAMETERS_MOST) {
        st = fail(E_USAGE, "the OpenJD template has %zu parameters; at most %d", names->n, PARAMETERS_MOST);
        goto done;
    }
    for (const struct json *p = list ? list->first : NULL; p; p = p->next) {
        const char *name = json_to_text(json_member(p, "name")),
                   *preset = json_to_text(json_member(p, "default"));
        const struct json *allowed = json_member(p, "allowedValues");
        bool among = !allowed;
        if (preset && strlen(preset) > TEXT_MOST) {
            st = fail(
                E_USAGE,
                "the OpenJD parameter %s has %zu characters; at most %d: choose frames that are fewer ranges (farm.still_every, output.vdb)",
                name, strlen(preset), TEXT_MOST);
            goto done;
        }
        for (const struct json *v = allowed ? allowed->first : NULL; v; v = v->next)
            among |= preset && json_to_text(v) && strcmp(json_to_text(v), preset) == 0;
        if (!preset || !among) {
            st = fail(E_USAGE, "the OpenJD parameter %s has no default among its allowed values", name);
            goto done;
        }
    }
done:
    return st;
}

static status check_space(const struct json *step, const char *name, const struct names *parameters,
                          struct names *task)
{
    status st = OK;
    const struct json *space = json_member(step, "parameterSpace"),
                      *list = json_member(space, "taskParameterDefinitions");
    TRY(read_names(list, "task parameter", IDENTIFIER_MOST, true, task));
    if (task->n > TASK_PARAMETERS_MOST || (space && task->n == 0)) {
        st = fail(E_USAGE, "the OpenJD template's step %s has %zu task parameters; 1 to %d", name, task->n,
                  TASK_PARAMETERS_MOST);
        goto done;
    }
    for (const struct json *p = list ? list->first : NULL; p; p = p->next) {
        const char *range = json_to_text(json_member(p, "range"));
        if (!range || (strncmp(range, "{{", 2) != 0 && !range_is_valid(range))) {
            st = fail(E_USAGE,
                      "the OpenJD template's step %s has the range '%.80s', which is not ascending frames",
                      name, range ? range : "");
            goto done;
        }
        TRY(check_references(range, name, parameters, &(struct names){0}));
    }
done:
    return st;
}

/* Its requirements, command and notice. */
static status check_action(const struct json *step, const char *name, const struct names *parameters,
                           const struct names *task)
{
    status st = OK;
    const struct json *host = json_member(step, "hostRequirements"), *amounts = json_member(host, "amounts"),
                      *attributes = json_member(host, "attributes");
    const struct json *run = json_member(json_member(json_member(step, "script"), "actions"), "onRun"),
                      *args = json_member(run, "args");
    const char *command = json_to_text(json_member(run, "command"));
    int64_t notice, least;
    if ((amounts ? amounts->n : 0) + (attributes ? attributes->n : 0) > REQUIREMENTS_MOST)
        return fail(E_USAGE, "the OpenJD template's step %s has more than %d host requirements", name,
                    REQUIREMENTS_MOST);
    for (const struct json *a = amounts ? amounts->first : NULL; a; a = a->next)
        if (!json_to_text(json_member(a, "name")) ||
            strncmp(json_to_text(json_member(a, "name")), "amount.worker.", 14) != 0 ||
            !json_to_integer(json_member(a, "min"), 1, INT64_MAX, &least))
            return fail(
                E_USAGE,
                "the OpenJD template's step %s requires an amount that is not a positive amount.worker",
                name);
    if (!command || !*command || has_control(command))
        return fail(E_USAGE, "the OpenJD template's step %s has no command", name);
    TRY(check_references(command, name, parameters, task));
    for (const struct json *a = args ? args->first : NULL; a; a = a->next) {
        if (!json_to_text(a) || has_control(json_to_text(a)))
            return fail(E_USAGE, "the OpenJD template's step %s has an argument with a control character",
                        name);
        TRY(check_references(json_to_text(a), name, parameters, task));
    }
    if (!json_to_integer(json_member(json_member(run, "cancelation"), "notifyPeriodInSeconds"), 1,
                         NOTICE_MOST, &notice))
        return fail(E_USAGE, "the OpenJD template's step %s has no notice of 1 to %d s", name, NOTICE_MOST);
done:
    return st;
}

static status check_step(const struct json *step, const struct names *steps, const struct names *parameters)
{
    status st = OK;
    struct names task = {0};
    const char *name = json_to_text(json_member(step, "name"));
    const struct json *after = json_member(step, "dependencies");
    if (has_control(name)) {
        st = fail(E_USAGE, "the OpenJD template has a step whose name holds a control character");
        goto done;
    }
    for (const struct json *d = after ? after->first : NULL; d; d = d->next) {
        const char *on = json_to_text(json_member(d, "dependsOn"));
        if (!on || !listed(steps, on) || strcmp(on, name) == 0) {
            st = fail(E_USAGE, "the OpenJD template's step %s depends on '%.80s', which is not another step",
                      name, on ? on : "");
            goto done;
        }
    }
    TRY(check_space(step, name, parameters, &task));
    TRY(check_action(step, name, parameters, &task));
done:
    free(task.name);
    return st;
}

status openjd_check(const char *template, size_t n)
{
    status st = OK;
    struct json *json = NULL;
    struct names parameters = {0}, steps = {0};
    TRY(json_read("the OpenJD template", template, n, &json));
    const char *name = json_to_text(json_member(json, "name"));
    const struct json *list = json_member(json, "steps");
    if (!name || !*name || strlen(name) > NAME_MOST || has_control(name)) {
        st = fail(E_USAGE, "the OpenJD template's name must have 1 to %d characters", NAME_MOST);
        goto done;
    }
    TRY(check_parameters(json_member(json, "parameterDefinitions"), &parameters));
    TRY(read_names(list, "step", STEP_MOST, false, &steps));
    if (steps.n == 0) {
        st = fail(E_USAGE, "the OpenJD template has no steps");
        goto done;
    }
    for (const struct json *step = list->first; step; step = step->next)
        TRY(check_step(step, &steps, &parameters));
done:
    free(parameters.name);
    free(steps.name);
    json_free(&json);
    return st;
}
