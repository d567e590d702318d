/* An HTTP server for one user of this machine: it listens on the loopback interface only and requires the token that is part of its address.
 * Uses libmicrohttpd, which is loaded on demand.
 *
 * Requests   GET and HEAD whose Host header is the printed address. Other hosts are refused, so that a foreign page whose name resolves to
 *            the loopback interface cannot send requests. 400: wrong method or host. 403: missing or wrong token.
 * Threads    None: serve_wait() answers requests one after the other.
 */
#ifndef HOODOO_LOOK_SERVE_H
#define HOODOO_LOOK_SERVE_H

#include <stddef.h>

#include "base/status.h"

struct serve;
struct serve_request;

/* A response. */
struct serve_answer {
    int code;         /* 200, 404, ... */
    const char *type; /* "text/html" */
    void *bytes;      /* freed with free() after sending */
    size_t n;
    char *note; /* value of the header X-Look, or NULL; freed likewise */
};
typedef void serve_handler(void *user, const struct serve_request *request, struct serve_answer *out);

/* The path ("/picture"), and the value of a parameter (?frame=1010) or NULL. */
const char *serve_path(const struct serve_request *request);
const char *serve_value(const struct serve_request *request, const char *name);

/* Starts listening; port 0 selects a free port. Release with serve_end(). E_USAGE: the port is in use. E_INPUT: libmicrohttpd is not
 * installed. */
MUST_USE status serve_begin(int port, serve_handler *handler, void *user, struct serve **out);
void serve_end(struct serve **serve);

/* "http://127.0.0.1:40123/?token=...", valid until serve_end(). */
const char *serve_address(const struct serve *serve);

/* Answers the requests that arrive within so many seconds. */
MUST_USE status serve_wait(struct serve *serve, double seconds);

#endif
