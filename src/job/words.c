#include "job/words.h"

#include <stdio.h>
#include <string.h>

const char *key_type_words(const struct job_key *key)
{
    switch (key->type) {
    case KEY_TEXT:
        return key->n ? "text or number" : "text";
    case KEY_NAME:
        return "name";
    case KEY_INPUT:
        return "file name";
    case KEY_NUM:
        return "number";
    case KEY_CURVE:
        return "curve";
    case KEY_TRACK:
        return "curve of points";
    case KEY_INT:
        return "whole number";
    case KEY_BOOL:
        return "true or false";
    case KEY_CHOICE:
        return "choice";
    case KEY_VEC:
        return "numbers";
    case KEY_RANGE:
        return "frame range";
    case KEY_SUB:
        return "mapping";
    case KEY_LIST:
        return "list of mappings";
    case KEY_MAP:
        return "mapping of names";
    case KEY_NODE:
        return "shape";
    case KEY_POINTS:
        return "list of points";
    case KEY_NAMES:
        return "list of names";
    case KEY_MAYBE:
        return "mapping";
    case KEY_RANGES:
        return "list of frame ranges";
    case KEY_SETS:
        return "mapping of key paths";
    case KEY_TEXTS:
        return "list of values";
    }
    return "";
}

void key_default_words(const struct job_key *key, struct text *out)
{
    char number[32];
    switch (key->type) {
    case KEY_NUM:
    case KEY_CURVE:
    case KEY_INT:
        text_add(out, "%s", key_number(key->number, number));
        break;
    case KEY_BOOL:
        text_add(out, key->number != 0 ? "true" : "false");
        break;
    case KEY_TEXT:
    case KEY_NAME:
    case KEY_INPUT:
        text_add(out, "\"%s\"", key->preset);
        break;
    case KEY_CHOICE:
    case KEY_VEC:
    case KEY_TRACK:
    case KEY_RANGE:
        text_add(out, "%s", key->preset);
        break;
    case KEY_LIST:
    case KEY_POINTS:
    case KEY_NAMES:
    case KEY_RANGES:
    case KEY_TEXTS:
        text_add(out, "[]");
        break;
    case KEY_MAP:
    case KEY_SETS:
        text_add(out, "{}");
        break;
    case KEY_SUB:
    case KEY_MAYBE:
    case KEY_NODE:
        break;
    }
}

const char *key_range_words(const struct job_key *key, char out[256])
{
    char low[32], high[32];
    *out = '\0';
    if (key->type == KEY_CHOICE)
        key_allowed(key, out);
    else if (key->type == KEY_NUM || key->type == KEY_CURVE || key->type == KEY_INT || key->type == KEY_VEC)
        snprintf(out, 256, "%s .. %s", key_number(key->min, low), key_number(key->max, high));
    return out;
}
