/* hoodoo inspect FILE: what a file holds. Which kind it is, its first bytes say, not its name. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/atomic_file.h"
#include "base/memory.h"
#include "checkpoint/checkpoint.h"
#include "checkpoint/json_read.h"
#include "cli/cli.h"
#include "cli/words.h"
#include "output/exr.h"
#include "output/vdb.h"

enum { JSON_FILE_MAX = 64 << 20, HEAD_SIZE = 16 };

/* Writes `v` and all it holds into `out`, under `key` (NULL in arrays). */
static status copy_value(const struct json_doc *j, const struct json_value *v, const char *key,
                         struct text *out)
{
    status st = OK;
    char *text = NULL, name[256];
    int64_t whole;
    double number;
    if (v->kind == JSON_IS_ARRAY || v->kind == JSON_IS_OBJECT) {
        (v->kind == JSON_IS_OBJECT ? json_object : json_array)(out, key);
        const struct json_value *child = json_first(v);
        for (uint32_t i = 0; i < v->n; i++, child = json_next(j, child)) {
            if (v->kind == JSON_IS_OBJECT && !json_get_key(j, child, name, sizeof name))
                return fail(E_INPUT, "a key is longer than %zu bytes", sizeof name - 1);
            TRY(copy_value(j, child, v->kind == JSON_IS_OBJECT ? name : NULL, out));
        }
        (v->kind == JSON_IS_OBJECT ? json_end_object : json_end_array)(out);
    } else if (v->kind == JSON_IS_TEXT) {
        TRY(memory_alloc((size_t)v->size + 1, 1, "a text", &text));
        if (!json_get_text(j, v, text, (size_t)v->size + 1))
            return free(text), fail(E_INPUT, "a text holds half a surrogate pair or a NUL");
        json_text(out, key, text);
    } else if (json_get_integer(j, v, INT64_MIN, INT64_MAX, &whole)) {
        json_integer(out, key, whole);
    } else if (v->kind == JSON_IS_TRUE || v->kind == JSON_IS_FALSE) {
        json_bool(out, key, v->kind == JSON_IS_TRUE);
    } else {
        json_number(out, key, json_get_number(j, v, &number) ? number : (double)NAN);
    }
done:
    free(text);
    return st;
}

static status describe_json(const char *path, struct text *out)
{
    status st = OK;
    char *bytes = NULL;
    size_t size;
    struct json_doc j = {0};
    TRY(file_read(path, JSON_FILE_MAX, &bytes, &size));
    if (json_parse(bytes, size, &j) != OK) {
        st = fail(E_INPUT, "%s: not JSON: %s", path, status_message());
        goto done;
    }
    bool manifest = json_find(&j, j.value, "frame") && json_find(&j, j.value, "files");
    json_text(out, "kind", manifest ? "manifest" : json_find(&j, j.value, "device") ? "run" : "JSON");
    TRY(copy_value(&j, j.value, "content", out));
done:
    json_doc_free(&j);
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
        return fail(E_INPUT, "%s: a folder; 'hoodoo status %s' tells about an output folder", path, path);
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
    return fail(E_INPUT,
                "%s: neither a checkpoint, VDB, EXR, manifest nor run.json, going by its first bytes", path);
}

status cli_inspect(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct words operands = {0};
    struct text answer = {0};
    bool help;
    const struct option options[] = {OPTION_JSON(&c)};
    TRY(options_parse(&usage_inspect, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    json_object(&answer, NULL);
    TRY(describe(operands.word[0], &answer));
    json_end_object(&answer);
    TRY(words_print(&answer, c.json));
done:
    text_free(&answer);
    words_free(&operands);
    return st;
}
