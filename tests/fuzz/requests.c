/* Requests to the page of `hoodoo look --serve`, as bytes on a socket. "@H" and "@T" in the input stand for its own host and token, without
 * which no request comes far. */
#include "fuzz/fuzz.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/log.h"
#include "look/live.h"

static const char job[] = "hoodoo: 1\nname: n\nmodel: goblins\nframes: 1-3\nclock: {years_per_frame: 100}\n"
                          "domain: {size_m: [4, 4, 4], spacing_m: 1}\n"
                          "scene: {box: {min_m: [1, 1, 0], max_m: [3, 3, 3]}}\n"
                          "strata: [{weak_m_per_kyr: 0.1}]\n";

static struct serve *serve;
static struct live live;
static struct look_options options;

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc;
    (void)argv;
    log_silence(true);
    setenv("HOODOO_CACHE", fuzz_folder(), 1);
    options = (struct look_options){.folder = fuzz_folder(), .no_slate = true};
    options.sketch = (struct sketch_options){
        .path = strdup(fuzz_file("n.yaml", job, sizeof job - 1)), .width = 64, .samples = 1, .seconds = 1};
    live.options = &options;
    if (look_begin("cpu", 2, &live.look) != OK || serve_begin(0, live_answer, &live, &serve) != OK) {
        fprintf(stderr, "%s\n", status_message());
        abort();
    }
    return 0;
}

/* The input with the placeholders replaced. */
static char *request_of(const uint8_t *bytes, size_t n, size_t *size)
{
    const char *host = strstr(serve_address(serve), "//") + 2, *token = strstr(host, "token=") + 6;
    const size_t n_host = strcspn(host, "/"), n_token = strlen(token);
    char *out = malloc(n * (n_host + n_token) + 1);
    if (!out)
        abort();
    *size = 0;
    for (size_t i = 0; i < n; i++) {
        const bool is_host = bytes[i] == '@' && i + 1 < n && bytes[i + 1] == 'H';
        const bool is_token = bytes[i] == '@' && i + 1 < n && bytes[i + 1] == 'T';
        const char *with = is_host ? host : is_token ? token : (const char *)&bytes[i];
        const size_t n_with = is_host ? n_host : is_token ? n_token : 1;
        memcpy(out + *size, with, n_with);
        *size += n_with;
        i += is_host || is_token;
    }
    return out;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    char answer[4096];
    size_t size = 0;
    char *request = request_of(bytes, n, &size);
    const char *port = strrchr(serve_address(serve), ':') + 1;
    struct sockaddr_in at = {.sin_family = AF_INET, .sin_port = htons((uint16_t)atoi(port))};
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd < 0 || connect(fd, (struct sockaddr *)&at, sizeof at) != 0)
        abort();
    (void)!send(fd, request, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    ssize_t got = -1;
    for (int i = 0; i < 30 && got != 0;
         i++) { /* until it is closed, or quiet for a while: it may wait for more */
        if (serve_wait(serve, 0.001) != OK)
            abort();
        while ((got = recv(fd, answer, sizeof answer, MSG_DONTWAIT)) > 0)
            i = 0;
        if (got < 0 && errno == ECONNRESET)
            got = 0;
    }
    close(fd);
    free(request);
    return 0;
}
