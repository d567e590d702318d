#include "farm/submission.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/path.h"
#include "system/atomic_file.h"
#include "text/json.h"
#include "text/text.h"

enum { FILE_MAX = 1 << 20, WEDGES_MOST = 9999, WORKERS_MOST = 9999 };

static const char *const targets[] = {CHOICE_LIST(SUBMIT_TO_CHOICE)};

const char *submission_name(int to)
{
    return to < 0 || to >= (int)(sizeof targets / sizeof *targets) ? "an unknown scheduler" : targets[to];
}

static void put_process(const struct process_id *p, struct text *t)
{
    char began[32];
    snprintf(began, sizeof began, "%llu", p->began);
    json_object(t, "process");
    json_text(t, "host", p->host);
    json_text(t, "boot", p->boot);
    json_text(t, "space", p->space);
    json_integer(t, "pid", p->pid);
    json_text(t, "began", began);
    json_end_object(t);
}

status submission_write(const char *root, const struct submission *s)
{
    status st = OK;
    struct path path;
    struct text t = {0};
    json_object(&t, NULL);
    json_integer(&t, "format", 1);
    json_text(&t, "to", submission_name(s->to));
    json_integer(&t, "wedge", s->wedge);
    json_integer(&t, "workers", s->workers);
    if (s->device)
        json_text(&t, "device", s->device);
    if (s->gpus)
        json_text(&t, "gpus", s->gpus);
    json_array(&t, "sbatch");
    for (size_t i = 0; i < s->n_extra; i++)
        json_text(&t, NULL, s->extra[i]);
    json_end_array(&t);
    if (s->process.pid)
        put_process(&s->process, &t);
    json_end_object(&t);
    TRY(text_status(&t));
    TRY(path_join(&path, root, "farm/submission.json"));
    TRY(atomic_file_write(path.text, t.data, t.size));
done:
    text_free(&t);
    return st;
}

static void take_text(const struct json *json, const char *key, char *out, size_t size)
{
    const char *text = json_to_text(json_member(json, key));
    snprintf(out, size, "%s", text ? text : "");
}

static void take_process(const struct json *json, struct process_id *p)
{
    int64_t pid;
    char began[32];
    if (!json_to_integer(json_member(json, "pid"), 1, INT32_MAX, &pid))
        return;
    p->pid = (long)pid;
    take_text(json, "host", p->host, sizeof p->host);
    take_text(json, "boot", p->boot, sizeof p->boot);
    take_text(json, "space", p->space, sizeof p->space);
    take_text(json, "began", began, sizeof began);
    p->began = strtoull(began, NULL, 10);
}

status submission_read(const char *root, struct submission *s)
{
    status st = OK;
    struct path path;
    char *bytes = NULL;
    size_t n;
    int64_t number;
    *s = (struct submission){.to = -1};
    TRY(path_join(&path, root, "farm/submission.json"));
    if (access(path.text, F_OK) != 0)
        return OK;
    TRY(file_read(path.text, FILE_MAX, &bytes, &n));
    TRY(json_read(path.text, bytes, n, &s->json));
    const char *to = json_to_text(json_member(s->json, "to"));
    for (size_t i = 0; to && i < sizeof targets / sizeof *targets; i++)
        if (strcmp(to, targets[i]) == 0)
            s->to = (int)i;
    if (s->to < 0) {
        st = fail(E_INPUT, "%s: 'to' is missing or unknown", path.text);
        goto done;
    }
    if (json_to_integer(json_member(s->json, "wedge"), 0, WEDGES_MOST, &number))
        s->wedge = (int)number;
    if (json_to_integer(json_member(s->json, "workers"), 0, WORKERS_MOST, &number))
        s->workers = (int)number;
    s->device = json_to_text(json_member(s->json, "device"));
    s->gpus = json_to_text(json_member(s->json, "gpus"));
    const struct json *list = json_member(s->json, "sbatch");
    for (const struct json *item = list ? list->first : NULL; item && s->n_extra < SUBMISSION_EXTRA;
         item = item->next)
        if (json_to_text(item))
            s->extra[s->n_extra++] = json_to_text(item);
    take_process(json_member(s->json, "process"), &s->process);
done:
    free(bytes);
    if (st != OK)
        submission_free(s);
    return st;
}

void submission_free(struct submission *s)
{
    json_free(&s->json);
    *s = (struct submission){.to = -1};
}
