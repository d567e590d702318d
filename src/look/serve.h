/* HTTP for one user of this machine: on the loopback alone, and only for who has the token of its address. By libmicrohttpd, which is loaded
 * when it is wanted.
 *
 * Answered     GET and HEAD to the address itself, as its Host says: another name for it (a page of somebody else's that resolves to
 *              the loopback) is refused. 400: anything else. 403: no token, or a wrong one.
 * Threads      None: requests are answered, one after the other, within serve_wait().
 */
#ifndef HOODOO_LOOK_SERVE_H
#define HOODOO_LOOK_SERVE_H

#include <stddef.h>

#include "base/status.h"

struct serve;
struct serve_request;

/* What is sent. */
struct serve_answer {
    int code;         /* 200, 404, ... */
    const char *type; /* "text/html" */
    void *bytes;      /* freed with free() once it is sent */
    size_t n;
    char *note; /* a header X-Look, or NULL; likewise */
};
typedef void serve_handler(void *user, const struct serve_request *request, struct serve_answer *out);

/* "/picture", and what it was given for a name (?frame=1010), or NULL. */
const char *serve_path(const struct serve_request *request);
const char *serve_value(const struct serve_request *request, const char *name);

/* port 0: any that is free. E_USAGE: the port is taken. E_INPUT: libmicrohttpd is not installed. serve_end(). */
MUST_USE status serve_begin(int port, serve_handler *handler, void *user, struct serve **out);
void serve_end(struct serve **serve);

/* "http://127.0.0.1:40123/?token=...": lives as long as it. */
const char *serve_address(const struct serve *serve);

/* Answers what comes within so many seconds. */
MUST_USE status serve_wait(struct serve *serve, double seconds);

#endif
