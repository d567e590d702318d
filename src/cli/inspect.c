/* hoodoo inspect FILE: describes the content of a file, whose kind is detected from its first bytes. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "checkpoint/checkpoint.h"
#include "cli/answer.h"
#include "cli/cli.h"
#include "exr/exr.h"
#include "system/atomic_file.h"
#include "text/json.h"
#include "vdb/vdb.h"

enum { JSON_FILE_MAX = 64 << 20, HEAD_SIZE = 16 };

/* Writes `v`, including nested values, into `out`. */
static void copy_value(const struct json *v, const char *key, struct text *out)
{
    int64_t whole;
    if (v->kind == JSON_ARRAY || v->kind == JSON_OBJECT) {
        (v->kind == JSON_OBJECT ? json_object : json_array)(out, key);
        for (const struct json *child = v->first; child; child = child->next)
            copy_value(child, child->key, out);
        (v->kind == JSON_OBJECT ? json_end_object : json_end_array)(out);
    } else if (v->kind == JSON_TEXT) {
        json_text(out, key, v->text);
    } else if (json_to_integer(v, INT64_MIN, INT64_MAX, &whole)) {
        json_integer(out, key, whole);
    } else if (v->kind == JSON_BOOL) {
        json_bool(out, key, v->number != 0);
    } else {
        json_number(out, key, v->kind == JSON_NUMBER ? v->number : (double)NAN);
    }
}

static status describe_json(const char *path, struct text *out)
{
    status st = OK;
    char *bytes = NULL;
    size_t size;
    struct json *json = NULL;
    TRY(file_read(path, JSON_FILE_MAX, &bytes, &size));
    TRY(json_read(path, bytes, size, &json));
    bool manifest = json_member(json, "frame") && json_member(json, "files");
    json_text(out, "kind", manifest ? "manifest" : json_member(json, "device") ? "run" : "JSON");
    copy_value(json, "content", out);
done:
    json_free(&json);
    free(bytes);
    return st;
}

static status describe_checkpoint(const char *path, struct text *out)
{
    json_text(out, "kind", "checkpoint");
    return checkpoint_describe(path, out);
}

static status describe_vdb(const char *path, struct text *out)
{
    json_text(out, "kind", "OpenVDB");
    return vdb_describe(path, out);
}

static status describe_exr(const char *path, struct text *out)
{
    json_text(out, "kind", "OpenEXR");
    return exr_describe(path, out);
}

static const struct {
    const char *magic;
    size_t size;
    status (*describe)(const char *path, struct text *out);
} kinds[] = {
    {"hoodoo.ckpt", 12, describe_checkpoint},
    {" BDV", 4, describe_vdb},
    {"\x76\x2f\x31\x01", 4, describe_exr},
    {"{", 1, describe_json},
};

static status describe(const char *path, struct text *out)
{
    char head[HEAD_SIZE] = {0};
    struct stat info;
    if (stat(path, &info) != 0)
        return fail(E_INPUT, "%s: %s", path, strerror(errno));
    if (S_ISDIR(info.st_mode))
        return fail(E_INPUT, "%s is a folder; 'hoodoo status %s' describes an output folder", path, path);
    if (!S_ISREG(info.st_mode))
        return fail(E_INPUT, "%s: not a regular file", path);
    FILE *f = fopen(path, "rb");
    if (!f)
        return fail(E_INPUT, "%s: %s", path, strerror(errno));
    size_t n = fread(head, 1, sizeof head, f);
    fclose(f);
    json_text(out, "file", path);
    json_integer(out, "file_bytes", (int64_t)info.st_size);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (n >= kinds[i].size && memcmp(head, kinds[i].magic, kinds[i].size) == 0)
            return kinds[i].describe(path, out);
    return fail(E_INPUT, "%s: the first bytes are not those of a checkpoint, VDB, EXR, manifest or run.json",
                path);
}

status cli_inspect(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct text answer = {0};
    bool help;
    const struct option options[] = {OPTION_JSON(&c)};
    TRY(options_parse(&usage_inspect, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    answer_begin(&answer);
    TRY(describe(operands.item[0], &answer));
    json_end_object(&answer);
    TRY(answer_print(&answer, c.json));
done:
    text_free(&answer);
    arguments_free(&operands);
    return st;
}
