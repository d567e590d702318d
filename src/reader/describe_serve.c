#include <stdlib.h>

#include "reader/describe.h"

void describe_begin(const struct serve_question *question, struct text *out)
{
    *out = (struct text){0};
    if (question->n_arguments == 2) {
        out->depth = atoi(question->argument[0]);
        out->comma = *question->argument[1] == '1';
    }
}

status describe_end(struct text *text, struct serve_answer *answer)
{
    status st = text_status(text);
    if (st == OK)
        st = serve_add_part(answer, text->data, text->size);
    text_free(text);
    return st;
}
