#include "look/serve.h"

#include <arpa/inet.h>
#include <dlfcn.h>
#include <errno.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

#include "base/log.h"
#include "base/memory.h"

/* Loaded on demand, since libmicrohttpd depends on a TLS library that takes longer to load than most verbs run. */
#define LIBRARY "libmicrohttpd.so.12"
#define FUNCTIONS(X)                                                                                         \
    X(MHD_start_daemon)                                                                                      \
    X(MHD_stop_daemon)                                                                                       \
    X(MHD_run_wait)                                                                                          \
    X(MHD_get_daemon_info)                                                                                   \
    X(MHD_lookup_connection_value)                                                                           \
    X(MHD_create_response_from_buffer)                                                                       \
    X(MHD_add_response_header)                                                                               \
    X(MHD_queue_response)                                                                                    \
    X(MHD_destroy_response)

struct library {
    void *handle;
#define MEMBER(name) __typeof__(name) *name;
    FUNCTIONS(MEMBER)
#undef MEMBER
};

enum { TOKEN_BYTES = 16, CONNECTIONS = 16, SECONDS_IDLE = 30 };

struct serve {
    struct library mhd;
    struct MHD_Daemon *daemon;
    serve_handler *handler;
    void *user;
    char token[2 * TOKEN_BYTES + 1], host[2][32], address[96];
};

struct serve_request {
    struct serve *serve;
    struct MHD_Connection *connection;
    const char *path;
};

static status load(struct library *l)
{
    l->handle = dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (!l->handle)
        return fail(
            E_INPUT,
            "--serve needs libmicrohttpd, which cannot be loaded (Debian package libmicrohttpd12): %s",
            dlerror());
    void *at;
#define FIND(name)                                                                                           \
    if (!(at = dlsym(l->handle, #name)))                                                                     \
        return fail(E_INPUT, "%s has no function %s; is it another version?", LIBRARY, #name);               \
    memcpy(&l->name, &at, sizeof at);
    FUNCTIONS(FIND)
#undef FIND
    return OK;
}

/* ---- requests */

const char *serve_path(const struct serve_request *request)
{
    return request->path;
}

const char *serve_value(const struct serve_request *r, const char *name)
{
    return r->serve->mhd.MHD_lookup_connection_value(r->connection, MHD_GET_ARGUMENT_KIND, name);
}

static bool is_token(const struct serve *s, const char *given)
{
    unsigned differ = 0;
    if (!given || strlen(given) != sizeof s->token - 1)
        return false;
    for (size_t i = 0; i + 1 < sizeof s->token; i++) /* constant time: compares all characters */
        differ |= (unsigned)(unsigned char)given[i] ^ (unsigned char)s->token[i];
    return differ == 0;
}

static status say(struct serve_answer *a, int code, const char *sentence)
{
    char *text = NULL;
    status st = memory_strdup(sentence, &text);
    *a = (struct serve_answer){.code = code, .type = "text/plain; charset=utf-8", .bytes = text};
    a->n = text ? strlen(text) : 0;
    return st;
}

static enum MHD_Result send_answer(struct serve *s, struct MHD_Connection *connection, struct serve_answer *a)
{
    struct MHD_Response *r = s->mhd.MHD_create_response_from_buffer(
        a->n, a->n ? a->bytes : (void *)"", a->n ? MHD_RESPMEM_MUST_FREE : MHD_RESPMEM_PERSISTENT);
    enum MHD_Result sent = MHD_NO;
    if (!r || !a->n)
        free(a->bytes);
    if (r) {
        s->mhd.MHD_add_response_header(r, "Content-Type", a->type);
        s->mhd.MHD_add_response_header(r, "Cache-Control", "no-store");
        s->mhd.MHD_add_response_header(r, "Referrer-Policy", "no-referrer");
        s->mhd.MHD_add_response_header(r, "X-Content-Type-Options", "nosniff");
        s->mhd.MHD_add_response_header(r, "Content-Security-Policy",
                                       "default-src 'self' blob: 'unsafe-inline'; frame-ancestors 'none'");
        if (a->note)
            s->mhd.MHD_add_response_header(r, "X-Look", a->note);
        sent = s->mhd.MHD_queue_response(connection, (unsigned)a->code, r);
        s->mhd.MHD_destroy_response(r);
    }
    free(a->note);
    return sent;
}

static enum MHD_Result answer(void *user, struct MHD_Connection *connection, const char *path,
                              const char *method, const char *version, const char *upload, size_t *n_upload,
                              void **state)
{
    static char seen;
    struct serve *s = user;
    struct serve_request request = {s, connection, path};
    struct serve_answer a = {.code = 404};
    status st = OK;
    (void)version;
    (void)upload;
    const bool asks = strcmp(method, "GET") == 0 || strcmp(method, "HEAD") == 0;
    if (!*state && asks) { /* headers have arrived, but not the end of the request */
        *state = &seen;
        return MHD_YES;
    }
    const char *host = s->mhd.MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Host");
    if (!asks || *n_upload)
        st = say(&a, 400, "only GET and HEAD are supported\n");
    else if (!host || (strcmp(host, s->host[0]) != 0 && strcmp(host, s->host[1]) != 0))
        st = say(&a, 400, "wrong host name: open the address that hoodoo look --serve has printed\n");
    else if (!is_token(s, serve_value(&request, "token")))
        st = say(&a, 403, "missing or wrong token: open the address that hoodoo look --serve has printed\n");
    else
        s->handler(s->user, &request, &a);
    if (st == OK && a.code == 404 && !a.bytes)
        st = say(&a, 404, "there is no such page\n");
    return st == OK ? send_answer(s, connection, &a) : MHD_NO;
}

/* ---- start and end */

static status make_token(struct serve *s)
{
    unsigned char bytes[TOKEN_BYTES];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return fail(E_OUTPUT, "the token of the page cannot be made, there are no random numbers: %s",
                    strerror(errno));
    for (size_t i = 0; i < sizeof bytes; i++)
        snprintf(s->token + 2 * i, 3, "%02x", bytes[i]);
    return OK;
}

static status listen_on(struct serve *s, int port)
{
    struct sockaddr_in at = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    s->daemon =
        s->mhd.MHD_start_daemon(MHD_USE_AUTO, (uint16_t)port, NULL, NULL, answer, s, MHD_OPTION_SOCK_ADDR,
                                &at, MHD_OPTION_CONNECTION_LIMIT, (unsigned)CONNECTIONS,
                                MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)SECONDS_IDLE, MHD_OPTION_END);
    const union MHD_DaemonInfo *info =
        s->daemon ? s->mhd.MHD_get_daemon_info(s->daemon, MHD_DAEMON_INFO_BIND_PORT) : NULL;
    if (!info)
        return fail(E_USAGE,
                    "--port %d: the port cannot be opened: %s; choose another port, or leave the option out",
                    port, strerror(errno));
    snprintf(s->host[0], sizeof s->host[0], "127.0.0.1:%u", info->port);
    snprintf(s->host[1], sizeof s->host[1], "localhost:%u", info->port);
    snprintf(s->address, sizeof s->address, "http://%s/?token=%s", s->host[0], s->token);
    return OK;
}

status serve_begin(int port, serve_handler *handler, void *user, struct serve **out)
{
    status st = OK;
    struct serve *s = NULL;
    if (port < 0 || port > 65535)
        return fail(E_USAGE, "--port %d: ports are 0 to 65535", port);
    TRY(memory_alloc(1, sizeof *s, "a server", &s));
    s->handler = handler;
    s->user = user;
    TRY(load(&s->mhd));
    TRY(make_token(s));
    TRY(listen_on(s, port));
    *out = s;
    s = NULL;
done:
    serve_end(&s);
    return st;
}

void serve_end(struct serve **serve)
{
    struct serve *s = *serve;
    if (!s)
        return;
    if (s->daemon)
        s->mhd.MHD_stop_daemon(s->daemon);
    if (s->mhd.handle)
        dlclose(s->mhd.handle);
    free(s);
    *serve = NULL;
}

const char *serve_address(const struct serve *serve)
{
    return serve->address;
}

status serve_wait(struct serve *s, double seconds)
{
    if (s->mhd.MHD_run_wait(s->daemon, (int32_t)(1000 * seconds)) != MHD_YES)
        return fail(E_OUTPUT, "the server of the page has failed: %s", strerror(errno));
    return OK;
}
