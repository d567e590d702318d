#include "farm/tries.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "system/atomic_file.h"
#include "system/child.h"
#include "text/json.h"

enum { FILE_MAX = 16 << 20 };

status tries_path(const struct farm *f, const struct farm_task *t, struct path *out)
{
    return path_format(out, "%s/log/farm/%s.jsonl", f->root.text, t->name);
}

static void count(const struct json *line, struct farm_tries *out, double *began)
{
    const char *event = json_to_text(json_member(line, "event")),
               *node = json_to_text(json_member(line, "node"));
    int code;
    if (!event)
        return;
    if (strcmp(event, "submitted") == 0) {
        *out = (struct farm_tries){.exit_code = -1};
    } else if (strcmp(event, "start") == 0) {
        const struct json *time = json_member(line, "time");
        out->starts++;
        out->running = true;
        out->cancelled = false;
        *began = time && time->kind == JSON_NUMBER ? time->number : NAN;
        snprintf(out->node, sizeof out->node, "%s", node ? node : "");
    } else if (strcmp(event, "end") == 0) {
        const struct json *seconds = json_member(line, "seconds");
        out->running = false;
        if (json_to_int(json_member(line, "exit"), &code))
            out->exit_code = code;
        out->seconds = seconds && seconds->kind == JSON_NUMBER ? seconds->number : 0;
    } else if (strcmp(event, "excluded") == 0 && node) {
        const size_t n = strlen(out->excluded);
        snprintf(out->excluded + n, sizeof out->excluded - n, "%s%s", n ? "," : "", node);
    } else if (strcmp(event, "stranded") == 0) {
        out->stranded = true;
    } else if (strcmp(event, "cancelled") == 0) {
        out->cancelled = true;
    }
}

status tries_read(const struct farm *f, const struct farm_task *t, struct farm_tries *out)
{
    status st = OK;
    struct path path;
    char *bytes = NULL;
    size_t n;
    double began = NAN;
    *out = (struct farm_tries){.exit_code = -1};
    TRY(tries_path(f, t, &path));
    if (access(path.text, F_OK) != 0)
        return OK;
    TRY(file_read(path.text, FILE_MAX, &bytes, &n));
    for (char *line = bytes; line && *line;) {
        struct json *json = NULL;
        char *next = strchr(line, '\n');
        if (next)
            *next++ = '\0';
        if (json_read(NULL, line, strlen(line), &json) == OK)
            count(json, out, &began);
        json_free(&json);
        line = next;
    }
    if (out->running)
        out->seconds = isnan(began) ? 0 : fmax((double)time(NULL) - began, 0);
done:
    free(bytes);
    return st;
}

static status append(const struct farm *f, const struct farm_task *t, struct text *line)
{
    status st = OK;
    struct path path;
    json_end_object(line);
    json_one_line(line);
    text_add(line, "\n");
    TRY(text_status(line));
    TRY(tries_path(f, t, &path));
    int fd = open(path.text, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (fd < 0 || write(fd, line->data, line->size) != (ssize_t)line->size)
        st = fail(E_OUTPUT, "%s: %s", path.text, strerror(errno));
    if (fd >= 0)
        close(fd);
done:
    text_free(line);
    return st;
}

static void begin(struct text *line, const char *event)
{
    json_object(line, NULL);
    json_text(line, "event", event);
}

status tries_add(const struct farm *f, const struct farm_task *t, const char *event)
{
    struct text line = {0};
    begin(&line, event);
    return append(f, t, &line);
}

status tries_add_start(const struct farm *f, const struct farm_task *t, const char *job)
{
    struct text line = {0};
    char host[128] = "";
    gethostname(host, sizeof host - 1);
    begin(&line, "start");
    json_text(&line, "node", host);
    json_text(&line, "job", job);
    json_integer(&line, "time", (int64_t)time(NULL));
    return append(f, t, &line);
}

status tries_add_end(const struct farm *f, const struct farm_task *t, int exit_code, double seconds)
{
    struct text line = {0};
    begin(&line, "end");
    json_integer(&line, "exit", exit_code);
    json_integer(&line, "seconds", (int64_t)seconds);
    return append(f, t, &line);
}

const char *farm_exit_meaning(int code, char out[160])
{
#define KNOWN(name, value, text)                                                                             \
    if (code == (value))                                                                                     \
        return text;
    STATUS_MAP(KNOWN)
#undef KNOWN
    if (code == CHILD_NO_PROGRAM)
        return "the node has no such program";
    if (code == CHILD_NOT_SET_UP)
        return "the node cannot execute the program, or the task's folder or log cannot be opened";
    if (code > 128 && code < 128 + 65)
        snprintf(out, 160, "killed by signal %d (%s)%s", code - 128, strsignal(code - 128),
                 code == 137 ? ", which is often a lack of memory" : "");
    else
        snprintf(out, 160, "not an exit code of hoodoo's");
    return out;
}
