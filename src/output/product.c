#include "output/product.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/log.h"
#include "base/memory.h"
#include "output/sealed.h"
#include "system/atomic_file.h"

#define RECORDS "records"
static const char ENDING[] = ".json";

status product_record(struct path *out, const char *path)
{
    return path_format(out, RECORDS "/%s%s", path, ENDING);
}

static status record_path(struct path *out, const char *root, const char *path)
{
    const status st = product_record(out, path);
    return st == OK ? path_join(out, root, out->text) : st;
}

status recipe_of_frame(struct recipe *recipe, const char *name, int frame)
{
    recipe->frame = frame;
    recipe->source = 0;
    status st = manifest_source(recipe->root, name, frame, &recipe->source);
    /* A disk may fail once, and a product whose source is not known is never out of date. */
    if (st == E_INPUT)
        st = manifest_source(recipe->root, name, frame, &recipe->source);
    return st == E_MEMORY ? st : OK;
}

/* ---- writing */

static status write_record(const struct recipe *r, const char *path, uint64_t hash, uint64_t size)
{
    status st = OK;
    struct path to, folder;
    struct text t = {0};
    TRY(record_path(&to, r->root, path));
    TRY(path_folder(&folder, to.text));
    TRY(folder_make(folder.text));
    json_object(&t, NULL);
    json_text(&t, "kind", "hoodoo product");
    json_integer(&t, "format", 1);
    json_text(&t, "path", path);
    json_integer(&t, "size", (int64_t)size);
    sealed_add_hash(&t, "xxh3", hash);
    if (r->frame != ALL_FRAMES)
        json_integer(&t, "frame", r->frame);
    sealed_add_hash(&t, "source_xxh3", r->source);
    json_array(&t, "command");
    for (size_t i = 0; i < r->n_words; i++)
        json_text(&t, NULL, r->word[i]);
    json_end_array(&t);
    if (r->n_shows)
        json_array(&t, "shows");
    for (size_t i = 0; i < r->n_shows; i++) {
        json_object(&t, NULL);
        json_text(&t, "path", r->shows[i].path);
        sealed_add_hash(&t, "xxh3", r->shows[i].hash);
        json_end_object(&t);
    }
    if (r->n_shows)
        json_end_array(&t);
    TRY(sealed_write(to.text, &t));
done:
    text_free(&t);
    return st;
}

static status prepare_path(struct path *out, const char *root, const char *path)
{
    status st = OK;
    struct path folder;
    TRY(path_join(out, root, path));
    TRY(path_folder(&folder, out->text));
    TRY(folder_make(folder.text));
done:
    return st;
}

status product_write(const struct recipe *r, const char *path, const void *bytes, size_t n)
{
    status st = OK;
    struct path to;
    TRY(prepare_path(&to, r->root, path));
    TRY(atomic_file_write(to.text, bytes, n));
    TRY(write_record(r, path, hash_bytes(bytes, n), n));
done:
    return st;
}

status product_adopt(const struct recipe *r, const char *temporary, const char *path)
{
    status st = OK;
    struct path from, to;
    uint64_t hash, size;
    TRY(path_join(&from, r->root, temporary));
    TRY(prepare_path(&to, r->root, path));
    /* Hash the file before it is in place: afterwards another process may have replaced it. */
    st = hash_file(from.text, &hash, &size);
    if (st == E_INPUT)
        st = fail(E_OUTPUT, "%s: the file could not be made: %s", to.text, strerror(errno));
    TRY(st);
    TRY(atomic_file_adopt(from.text, to.text));
    TRY(write_record(r, path, hash, size));
done:
    return st;
}

/* ---- reading */

void product_free(struct product *p)
{
    if (p->json)
        json_free(&p->json);
    *p = (struct product){0};
}

static bool to_words(const struct json *list, struct product *out)
{
    if (!list || list->kind != JSON_ARRAY || list->n > PRODUCT_WORDS)
        return false;
    for (const struct json *item = list->first; item; item = item->next)
        if (!(out->word[out->n_words++] = json_to_text(item)))
            return false;
    return true;
}

static bool to_product(const struct json *json, const char *path, struct product *out)
{
    const char *kind = json_to_text(json_member(json, "kind")),
               *own = json_to_text(json_member(json, "path"));
    const struct json *frame = json_member(json, "frame");
    uint64_t format;
    if (!kind || strcmp(kind, "hoodoo product") != 0 ||
        !json_to_uint64(json_member(json, "format"), &format) || format != 1)
        return false;
    if (!own || strcmp(own, path) != 0 || strlen(own) >= sizeof out->file.path || !sealed_is_inside(own))
        return false;
    snprintf(out->file.path, sizeof out->file.path, "%s", own);
    out->frame = ALL_FRAMES;
    out->shows = json_member(json, "shows");
    return json_to_uint64(json_member(json, "size"), &out->file.size) &&
           sealed_to_hash(json_member(json, "xxh3"), &out->file.hash) &&
           sealed_to_hash(json_member(json, "source_xxh3"), &out->source) &&
           (!frame || json_to_int(frame, &out->frame)) && to_words(json_member(json, "command"), out);
}

status product_read(const char *root, const char *path, struct product *out)
{
    status st = OK;
    struct path from;
    struct product p = {0};
    *out = p;
    TRY(record_path(&from, root, path));
    TRY(sealed_read(from.text, "a product's record", &p.json));
    if (!to_product(p.json, path, &p)) {
        st = fail(E_INPUT, "%s: not the record of %s, or written by a later version of hoodoo", from.text,
                  path);
        goto done;
    }
    *out = p;
    p.json = NULL;
done:
    product_free(&p);
    return st;
}

status product_check(const char *root, const char *name, const struct product *p, bool deep)
{
    uint64_t source;
    status st = listed_check(root, &p->file, deep);
    if (st != OK || p->frame == ALL_FRAMES || p->source == 0)
        return st;
    st = manifest_source(root, name, p->frame, &source);
    if (st != OK)
        return st == E_INPUT ? OK : st;
    return source == p->source ? OK
                               : fail(E_INPUT, "%s/%s: it was made from frame %d before that was changed",
                                      root, p->file.path, p->frame);
}

bool product_shows(const struct product *p, const char *path, uint64_t hash)
{
    const bool list = p->shows && p->shows->kind == JSON_ARRAY;
    for (const struct json *item = list ? p->shows->first : NULL; item; item = item->next) {
        const char *shown = json_to_text(json_member(item, "path"));
        uint64_t then;
        if (shown && strcmp(shown, path) == 0)
            return sealed_to_hash(json_member(item, "xxh3"), &then) && then == hash;
    }
    return false;
}

static bool same_words(const struct recipe *r, const struct product *p)
{
    if (r->n_words != p->n_words)
        return false;
    for (size_t i = 0; i < r->n_words; i++)
        if (strcmp(r->word[i], p->word[i]) != 0)
            return false;
    return true;
}

status product_done(const struct recipe *r, const char *path, bool deep, bool *done)
{
    struct product p = {0};
    status st = product_read(r->root, path, &p);
    if (st == OK)
        st = listed_check(r->root, &p.file, deep);
    *done =
        st == OK && p.frame == r->frame && p.source == r->source && (r->n_words == 0 || same_words(r, &p));
    product_free(&p);
    return st == E_INPUT ? OK : st;
}

/* ---- all of them */

void product_list_free(struct product_list *list)
{
    free(list->path);
    *list = (struct product_list){0};
}

/* Calls `call` for records/ (with "") and for each folder in it (with "mesh/" and the like). */
static status each_folder(const char *root, status (*call)(void *user, const char *folder, const char *below),
                          void *user)
{
    status st = OK;
    struct path records, folder, below;
    TRY(path_join(&records, root, RECORDS));
    DIR *d = opendir(records.text);
    if (!d)
        return errno == ENOENT ? OK : fail(E_INPUT, "%s: %s", records.text, strerror(errno));
    st = call(user, records.text, "");
    for (struct dirent *e; st == OK && (e = readdir(d));) {
        struct stat info;
        if (e->d_name[0] == '.')
            continue;
        st = path_join(&folder, records.text, e->d_name);
        if (st == OK)
            st = path_format(&below, "%s/", e->d_name);
        if (st == OK && stat(folder.text, &info) == 0 && S_ISDIR(info.st_mode))
            st = call(user, folder.text, below.text);
    }
    closedir(d);
done:
    return st;
}

status product_list_add(struct product_list *list, const char *path)
{
    const status st =
        memory_grow(&list->path, &list->capacity, list->n + 1, sizeof *list->path, "the products");
    if (st == OK)
        snprintf(list->path[list->n++], sizeof *list->path, "%s", path);
    return st;
}

static status add_folder(void *user, const char *folder, const char *below)
{
    struct product_list *list = user;
    const size_t m = sizeof ENDING - 1;
    status st = OK;
    DIR *d = opendir(folder);
    if (!d)
        return fail(E_INPUT, "%s: %s", folder, strerror(errno));
    for (struct dirent *e; st == OK && (e = readdir(d));) {
        const size_t n = strlen(e->d_name);
        if (n <= m || strcmp(e->d_name + n - m, ENDING) != 0 || strlen(below) + n >= sizeof *list->path)
            continue;
        char path[sizeof *list->path];
        snprintf(path, sizeof path, "%s", below);
        snprintf(path + strlen(below), sizeof path - strlen(below), "%.*s", (int)(n - m), e->d_name);
        st = product_list_add(list, path);
    }
    closedir(d);
    return st;
}

static int in_order(const void *a, const void *b)
{
    return strcmp(a, b);
}

void product_list_sort(struct product_list *list)
{
    if (list->n)
        qsort(list->path, list->n, sizeof *list->path, in_order);
}

status product_list(const char *root, struct product_list *out)
{
    *out = (struct product_list){0};
    const status st = each_folder(root, add_folder, out);
    if (st != OK)
        product_list_free(out);
    product_list_sort(out);
    return st;
}

status product_remove_records(const char *root)
{
    status st = OK;
    struct product_list list = {0};
    struct path path;
    TRY(product_list(root, &list));
    for (size_t i = 0; i < list.n; i++) {
        TRY(record_path(&path, root, list.path[i]));
        unlink(path.text);
    }
done:
    product_list_free(&list);
    return st;
}
