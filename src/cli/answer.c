#include "cli/answer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "system/progress.h"
#include "text/json.h"

enum { COLUMNS_MAX = 16, LABEL_SIZE = 64 };

static bool ends_with(const char *text, const char *end)
{
    size_t n = strlen(text), m = strlen(end);
    return n > m && strcmp(text + n - m, end) == 0;
}

static bool is_group(const struct json *v)
{
    return v->kind == JSON_ARRAY || v->kind == JSON_OBJECT;
}

/* "stored_bytes" -> "stored", "max_stress_Pa" -> "max stress Pa" */
static const char *label(const struct json *v, char out[LABEL_SIZE])
{
    if (strlen(v->key) >= LABEL_SIZE)
        return "...";
    strcpy(out, v->key);
    if (ends_with(out, "_bytes") || ends_with(out, "_seconds"))
        *strrchr(out, '_') = '\0';
    for (char *c = out; *c; c++)
        if (*c == '_' || (unsigned char)*c < 0x20 || *c == 0x7f)
            *c = ' ';
    return out;
}

static const char *bytes_text(double n, char out[32])
{
    static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB", "PB"};
    size_t i = 0;
    for (; n >= 1000 && i + 1 < sizeof units / sizeof *units; i++)
        n /= 1000;
    snprintf(out, 32, i ? "%.1f %s" : "%.0f %s", n, units[i]);
    return out;
}

/* A number, text, boolean or null as text for people; *out is released with free(). */
static status scalar(const struct json *v, char **out)
{
    status st = OK;
    const char *key = v->key ? v->key : "";
    /* 32 bytes hold any number, duration or size. */
    const size_t size = (v->text ? strlen(v->text) : 0) + 32;
    TRY(memory_alloc(size, 1, "a text", out));
    if (v->kind == JSON_TEXT) {
        strcpy(*out, v->text);
        for (char *c = *out; *c; c++)
            if ((unsigned char)*c < 0x20 || *c == 0x7f)
                *c = ' ';
    } else if (v->kind == JSON_BOOL) {
        strcpy(*out, v->number != 0 ? "yes" : "no");
    } else if (v->kind == JSON_NULL) {
        strcpy(*out, "-");
    } else if (ends_with(key, "_bytes")) {
        bytes_text(v->number, *out);
    } else if (ends_with(key, "_seconds")) {
        duration_text(v->number, *out);
    } else if (strchr(v->text, 'e') && fabs(v->number) >= 1e-4 && fabs(v->number) < 1e15) {
        snprintf(*out, size, "%.15g", v->number); /* JSON has the shortest form, such as 5e+03 */
    } else {
        strcpy(*out, v->text);
    }
done:
    return st;
}

/* ---- tables */

/* Whether every value of the array is a flat object with as many members as the first. */
static bool is_table(const struct json *array)
{
    const size_t columns = array->first ? array->first->n : 0;
    for (const struct json *row = array->first; row; row = row->next) {
        if (row->kind != JSON_OBJECT || row->n != columns || columns == 0 || columns > COLUMNS_MAX)
            return false;
        for (const struct json *v = row->first; v; v = v->next)
            if (is_group(v))
                return false;
    }
    return array->n > 0;
}

/* One pass over the table, which either measures the columns or prints them. */
static status walk_table(const struct json *array, int indent, bool print, int width[])
{
    char name[LABEL_SIZE];
    size_t k = 0;
    for (const struct json *v = array->first->first; v; v = v->next, k++) {
        const char *head = label(v, name);
        if (print)
            printf("%*s%-*s", k ? 2 : indent, "", v->next ? width[k] : 0, head);
        else if ((int)strlen(head) > width[k])
            width[k] = (int)strlen(head);
    }
    for (const struct json *row = array->first; row; row = row->next) {
        k = 0;
        for (const struct json *v = row->first; v; v = v->next, k++) {
            char *text = NULL;
            status st = scalar(v, &text);
            if (st != OK)
                return st;
            if (print)
                printf("%s%*s%-*s", k ? "" : "\n", k ? 2 : indent, "", v->next ? width[k] : 0, text);
            else if (strlen(text) < 60 && (int)strlen(text) > width[k])
                width[k] = (int)strlen(text);
            free(text);
        }
    }
    if (print)
        printf("\n");
    return OK;
}

static status print_table(const struct json *array, int indent)
{
    int width[COLUMNS_MAX] = {0};
    status st = OK;
    TRY(walk_table(array, indent, false, width));
    TRY(walk_table(array, indent, true, width));
done:
    return st;
}

/* ---- everything else */

static status print_scalars(const struct json *array)
{
    for (const struct json *v = array->first; v; v = v->next) {
        char *text = NULL;
        status st = scalar(v, &text);
        if (st != OK)
            return st;
        printf("%s%s", v == array->first ? "" : " ", text);
        free(text);
    }
    printf("%s\n", array->n ? "" : "none");
    return OK;
}

static bool holds_groups(const struct json *group)
{
    for (const struct json *v = group->first; v; v = v->next)
        if (is_group(v))
            return true;
    return false;
}

static status print_members(const struct json *group, int indent)
{
    status st = OK;
    int widest = 0;
    char name[LABEL_SIZE];
    for (const struct json *v = group->first; v; v = v->next) {
        int n = v->key ? (int)strlen(label(v, name)) : 1;
        widest = n > widest ? n : widest;
    }
    for (const struct json *v = group->first; v; v = v->next) {
        const char *head = v->key ? label(v, name) : "-";
        bool flat = v->kind == JSON_ARRAY && !holds_groups(v);
        if (is_group(v) && !flat) {
            printf("%*s%s\n", indent, "", head);
            TRY(is_table(v) ? print_table(v, indent + 2) : print_members(v, indent + 2));
            continue;
        }
        printf("%*s%-*s  ", indent, "", widest, head);
        if (flat) {
            TRY(print_scalars(v));
        } else {
            char *text = NULL;
            TRY(scalar(v, &text));
            printf("%s\n", text);
            free(text);
        }
    }
done:
    return st;
}

void answer_begin(struct text *answer)
{
    json_object(answer, NULL);
    json_integer(answer, "format", ANSWER_FORMAT);
}

/* Removes the member `format` from the answer. */
static void drop_format(struct json *answer)
{
    if (answer->first && answer->first->key && strcmp(answer->first->key, "format") == 0) {
        answer->first = answer->first->next;
        answer->n--;
    }
}

status answer_print(const struct text *answer, bool as_json)
{
    struct json *json = NULL;
    status st = OK;
    TRY(text_status(answer));
    if (as_json) {
        fwrite(answer->data, 1, answer->size, stdout);
        return OK;
    }
    TRY(json_read(NULL, answer->data, answer->size, &json));
    drop_format(json);
    TRY(print_members(json, 0));
done:
    json_free(&json);
    return st;
}
