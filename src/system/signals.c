#include "system/signals.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>

#include "base/status.h"

static const struct {
    int number;
    const char *name;
} stops[] = {{SIGTERM, "SIGTERM"}, {SIGINT, "SIGINT"},   {SIGHUP, "SIGHUP"},
             {SIGUSR1, "SIGUSR1"}, {SIGUSR2, "SIGUSR2"}, {SIGXCPU, "SIGXCPU"}};

/* The first signal received, or 0. Atomic because threads read it, and lock-free because a signal handler sets it. */
static atomic_int stop;

static void on_stop(int number)
{
    int none = 0;
    atomic_compare_exchange_strong(&stop, &none, number);
}

/* Only calls functions that are safe in signal handlers. */
static void on_end(int number)
{
    char line[128] = "hoodoo: stopped by ";
    for (size_t i = 0; i < sizeof stops / sizeof *stops; i++)
        if (stops[i].number == number)
            strcat(line, stops[i].name);
    strcat(line, "; to start over, run the same command again\n");
    const ssize_t written = write(STDERR_FILENO, line, strlen(line));
    (void)written;
    _exit(STOPPED);
}

/* Whether the parent process ignores SIGHUP, so that the program survives the end of a terminal session. */
static bool hangup_is_ignored(void)
{
    struct sigaction now;
    return sigaction(SIGHUP, NULL, &now) == 0 && now.sa_handler == SIG_IGN;
}

static void set(int number, void (*handler)(int))
{
    if (number == SIGHUP && hangup_is_ignored())
        return;
    struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, NULL);
}

void signals_install(void)
{
    for (size_t i = 0; i < sizeof stops / sizeof *stops; i++)
        set(stops[i].number, on_stop);
    set(SIGPIPE, SIG_IGN);
}

void signals_end(void)
{
    for (size_t i = 0; i < sizeof stops / sizeof *stops; i++)
        set(stops[i].number, on_end);
}

void signals_reset(void)
{
    for (size_t i = 0; i < sizeof stops / sizeof *stops; i++)
        set(stops[i].number, SIG_DFL);
    set(SIGPIPE, SIG_DFL);
    set(SIGXFSZ, SIG_DFL);
}

bool stop_requested(void)
{
    return atomic_load_explicit(&stop, memory_order_relaxed) != 0;
}

const char *stop_reason(void)
{
    int number = atomic_load(&stop);
    for (size_t i = 0; i < sizeof stops / sizeof *stops; i++)
        if (stops[i].number == number)
            return stops[i].name;
    return NULL;
}
