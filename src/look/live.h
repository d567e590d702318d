/* The page of `hoodoo look --serve`: a picture that can be turned, a slider over frames, and values to show and to read off. The page itself
 * is render/look.html. Requests:
 *
 *   /          the page
 *   /job       JSON: name, frames, values, cameras, size_m of the domain; `saves` counts how often its files have been saved
 *   /picture   ?frame&camera&zoom&show&cut&gizmos&figure&rough: a PNG, described by JSON in the header X-Look. 422: an error in the job, as text
 *   /curves    JSON: the report's curves over the frames simulated so far, as SVG; the last picture's frame is marked
 *   /at        ?x&y (0..1): JSON with the position and the values at this point of the last picture
 */
#ifndef HOODOO_LOOK_LIVE_H
#define HOODOO_LOOK_LIVE_H

#include "look/look.h"
#include "look/serve.h"

struct live {
    struct look *look;
    const struct look_options *options; /* defaults of every picture, which a request overrides */
    int saves;                          /* incremented by the caller when a file of the job is saved */
    status broken; /* the error that ends the server: one that does not come from the job */
    char message[1000];
};

/* A serve_handler, whose user pointer is a struct live. */
void live_answer(void *live, const struct serve_request *request, struct serve_answer *out);

#endif
