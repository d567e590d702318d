#include "cli/words.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "checkpoint/json_read.h"
#include "cli/progress.h"

enum { COLUMNS_MAX = 16, LABEL_SIZE = 64 };

static bool ends_with(const char *text, const char *end)
{
    size_t n = strlen(text), m = strlen(end);
    return n > m && strcmp(text + n - m, end) == 0;
}

static bool is_group(const struct json_value *v)
{
    return v->kind == JSON_IS_ARRAY || v->kind == JSON_IS_OBJECT;
}

/* "stored_bytes" -> "stored", "max_stress_Pa" -> "max stress Pa" */
static const char *label(const struct json_doc *j, const struct json_value *v, char out[LABEL_SIZE])
{
    if (!json_get_key(j, v, out, LABEL_SIZE))
        return "...";
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

/* A value that is no group, as people read it; *out is freed with free(). */
static status scalar(const struct json_doc *j, const struct json_value *v, char **out)
{
    status st = OK;
    char key[LABEL_SIZE] = "";
    double number;
    /* Escapes only shrink, and the longest duration or size fits. */
    TRY(memory_alloc((size_t)v->size + 32, 1, "a text", out));
    if (v->key_size && !json_get_key(j, v, key, sizeof key))
        key[0] = '\0';
    if (v->kind == JSON_IS_TEXT) {
        if (!json_get_text(j, v, *out, (size_t)v->size + 1))
            strcpy(*out, "?");
        for (char *c = *out; *c; c++)
            if ((unsigned char)*c < 0x20 || *c == 0x7f)
                *c = ' ';
    } else if (v->kind == JSON_IS_NUMBER && ends_with(key, "_bytes") && json_get_number(j, v, &number)) {
        bytes_text(number, *out);
    } else if (v->kind == JSON_IS_NUMBER && ends_with(key, "_seconds") && json_get_number(j, v, &number)) {
        duration_text(number, *out);
    } else if (v->kind == JSON_IS_TRUE || v->kind == JSON_IS_FALSE) {
        strcpy(*out, v->kind == JSON_IS_TRUE ? "yes" : "no");
    } else if (v->kind == JSON_IS_NULL) {
        strcpy(*out, "-");
    } else {
        memcpy(*out, j->text + v->at, v->size);
        /* 5e+03 is the shortest form, and right for programs. */
        if (strchr(*out, 'e') && json_get_number(j, v, &number) && fabs(number) >= 1e-4 &&
            fabs(number) < 1e15)
            snprintf(*out, (size_t)v->size + 32, "%.15g", number);
    }
done:
    return st;
}

/* ---- tables */

/* Is every value of the array a flat object with as many members as the first? */
static bool is_table(const struct json_doc *j, const struct json_value *array)
{
    const struct json_value *row = json_first(array);
    uint32_t columns = array->n ? row->n : 0;
    for (uint32_t i = 0; i < array->n; i++, row = json_next(j, row)) {
        if (row->kind != JSON_IS_OBJECT || row->n != columns || columns == 0 || columns > COLUMNS_MAX)
            return false;
        const struct json_value *v = json_first(row);
        for (uint32_t k = 0; k < row->n; k++, v = json_next(j, v))
            if (is_group(v))
                return false;
    }
    return array->n > 0;
}

/* One pass over the table: measures columns, or prints. */
static status walk_table(const struct json_doc *j, const struct json_value *array, int indent, bool print,
                         int width[])
{
    char name[LABEL_SIZE];
    const struct json_value *row = json_first(array), *v = json_first(row);
    for (uint32_t k = 0; k < row->n; k++, v = json_next(j, v)) {
        const char *head = label(j, v, name);
        if (print)
            printf("%*s%-*s", k ? 2 : indent, "", k + 1 < row->n ? width[k] : 0, head);
        else if ((int)strlen(head) > width[k])
            width[k] = (int)strlen(head);
    }
    for (uint32_t i = 0; i < array->n; i++, row = json_next(j, row)) {
        v = json_first(row);
        for (uint32_t k = 0; k < row->n; k++, v = json_next(j, v)) {
            char *text = NULL;
            status st = scalar(j, v, &text);
            if (st != OK)
                return st;
            if (print)
                printf("%s%*s%-*s", k ? "" : "\n", k ? 2 : indent, "", k + 1 < row->n ? width[k] : 0, text);
            else if (strlen(text) < 60 && (int)strlen(text) > width[k])
                width[k] = (int)strlen(text);
            free(text);
        }
    }
    if (print)
        printf("\n");
    return OK;
}

static status print_table(const struct json_doc *j, const struct json_value *array, int indent)
{
    int width[COLUMNS_MAX] = {0};
    status st = OK;
    TRY(walk_table(j, array, indent, false, width));
    TRY(walk_table(j, array, indent, true, width));
done:
    return st;
}

/* ---- everything else */

static status print_scalars(const struct json_doc *j, const struct json_value *array)
{
    const struct json_value *v = json_first(array);
    for (uint32_t i = 0; i < array->n; i++, v = json_next(j, v)) {
        char *text = NULL;
        status st = scalar(j, v, &text);
        if (st != OK)
            return st;
        printf("%s%s", i ? " " : "", text);
        free(text);
    }
    printf("%s\n", array->n ? "" : "none");
    return OK;
}

static bool holds_groups(const struct json_doc *j, const struct json_value *group)
{
    const struct json_value *v = json_first(group);
    for (uint32_t i = 0; i < group->n; i++, v = json_next(j, v))
        if (is_group(v))
            return true;
    return false;
}

static status print_members(const struct json_doc *j, const struct json_value *group, int indent)
{
    status st = OK;
    int widest = 0;
    char name[LABEL_SIZE];
    const struct json_value *v = json_first(group);
    for (uint32_t i = 0; i < group->n; i++, v = json_next(j, v)) {
        int n = v->key_size ? (int)strlen(label(j, v, name)) : 1;
        widest = n > widest ? n : widest;
    }
    v = json_first(group);
    for (uint32_t i = 0; i < group->n; i++, v = json_next(j, v)) {
        const char *head = group->kind == JSON_IS_OBJECT ? label(j, v, name) : "-";
        bool flat = v->kind == JSON_IS_ARRAY && !holds_groups(j, v);
        if (is_group(v) && !flat) {
            printf("%*s%s\n", indent, "", head);
            TRY(is_table(j, v) ? print_table(j, v, indent + 2) : print_members(j, v, indent + 2));
            continue;
        }
        printf("%*s%-*s  ", indent, "", widest, head);
        if (flat) {
            TRY(print_scalars(j, v));
        } else {
            char *text = NULL;
            TRY(scalar(j, v, &text));
            printf("%s\n", text);
            free(text);
        }
    }
done:
    return st;
}

status words_print(const struct text *answer, bool as_json)
{
    struct json_doc j = {0};
    status st = OK;
    TRY(text_status(answer));
    if (as_json) {
        fwrite(answer->data, 1, answer->size, stdout);
        return OK;
    }
    TRY(json_parse(answer->data, answer->size, &j));
    TRY(print_members(&j, j.value, 0));
done:
    json_doc_free(&j);
    return st;
}
