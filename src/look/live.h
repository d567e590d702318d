/* The page of `hoodoo look --serve`: a picture to turn, frames to go through, values to show and to read off. render/look.html is what a
 * browser sees of it.
 *
 *   /          the page
 *   /job       JSON: name, frames, values, cameras, size; `saves` counts the saves of its files
 *   /picture   ?frame&camera&zoom&show&gizmos&figure&rough: a PNG, and in X-Look what it is (JSON). 422: what is wrong with the job
 *   /at        ?x&y of 0..1: JSON of the place and the values in the last picture
 */
#ifndef HOODOO_LOOK_LIVE_H
#define HOODOO_LOOK_LIVE_H

#include "look/look.h"
#include "look/serve.h"

struct live {
    struct look *look;
    const struct look_options *options; /* of every picture; the request's come over them */
    int saves;                          /* raised by whoever watches the files */
    status broken;                      /* what ended it, if it is not the job's fault */
    char message[1000];
};

/* A serve_handler; `live` is its user. */
void live_answer(void *live, const struct serve_request *request, struct serve_answer *out);

#endif
