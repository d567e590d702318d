#include "gltf/gltf.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "base/path.h"
#include "system/atomic_file.h"
#include "text/json.h"

#define MAX_JSON ((size_t)1 << 30)

static bool begins_like_json(const char *path)
{
    char head[256] = "";
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode))
        return false;
    FILE *f = fopen(path, "rb");
    if (!f)
        return false;
    const size_t n = fread(head, 1, sizeof head - 1, f);
    fclose(f);
    const char *at = n >= 3 && memcmp(head, "\xef\xbb\xbf", 3) == 0 ? head + 3 : head;
    while (isspace((unsigned char)*at))
        at++;
    return *at == '{';
}

static int hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

void gltf_decode_uri(char *uri)
{
    char *to = uri;
    for (const char *c = uri; *c; c++) {
        const int high = *c == '%' ? hex_digit(c[1]) : -1, low = high >= 0 ? hex_digit(c[2]) : -1;
        const bool escape = low >= 0 && high + low > 0;
        *to++ = escape ? (char)(16 * high + low) : *c;
        c += escape ? 2 : 0;
    }
    *to = '\0';
}

static status add(const char *path, const char *uri, struct gltf_buffers *out)
{
    status st = OK;
    struct path folder, file;
    char *name = NULL;
    if (out->n == GLTF_BUFFERS)
        return fail(E_INPUT, "%s: its buffers are in more than %d files: export it as .glb", path,
                    GLTF_BUFFERS);
    TRY(memory_strdup(uri, &name));
    gltf_decode_uri(name);
    if (strchr(name, '/') || strchr(name, '\\') || strchr(name, ':') || strcmp(name, "..") == 0 ||
        strlen(name) < 1) {
        st = fail(
            E_INPUT,
            "%s: a buffer is at '%.200s', but only files in the same folder are read: put it there and change the uri, or export the asset as .glb",
            path, uri);
        goto done;
    }
    TRY(path_folder(&folder, path));
    TRY(path_join(&file, folder.text, name));
    TRY(memory_strdup(uri, &out->uri[out->n]));
    out->n++;
    TRY(memory_strdup(file.text, &out->path[out->n - 1]));
done:
    free(name);
    return st;
}

status gltf_buffers(const char *path, struct gltf_buffers *out)
{
    status st = OK;
    char *bytes = NULL;
    size_t n = 0;
    struct json *root = NULL;
    *out = (struct gltf_buffers){0};
    if (!begins_like_json(path))
        return OK;
    TRY(file_read(path, MAX_JSON, &bytes, &n));
    const size_t mark = n >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    TRY(json_read(path, bytes + mark, n - mark, &root));
    const struct json *list = json_member(root, "buffers");
    for (const struct json *b = list && list->kind == JSON_ARRAY ? list->first : NULL; b; b = b->next) {
        const char *uri = json_to_text(json_member(b, "uri"));
        if (uri && strncmp(uri, "data:", 5) != 0)
            TRY(add(path, uri, out));
    }
done:
    free(bytes);
    json_free(&root);
    return st;
}

void gltf_buffers_free(struct gltf_buffers *buffers)
{
    for (size_t i = 0; i < buffers->n; i++) {
        free(buffers->uri[i]);
        free(buffers->path[i]);
    }
    *buffers = (struct gltf_buffers){0};
}
