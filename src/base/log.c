#include "base/log.h"

#include <errno.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static FILE *file;
static void (*guard)(bool before);
static _Thread_local bool silenced;

status log_open(const char *path)
{
    FILE *opened = NULL;
    if (path && !(opened = fopen(path, "a")))
        return fail(E_OUTPUT, "%s: cannot open the log: %s", path, strerror(errno));
    pthread_mutex_lock(&lock);
    if (file)
        fclose(file);
    file = opened;
    if (file)
        setvbuf(file, NULL, _IOLBF, 0);
    pthread_mutex_unlock(&lock);
    return OK;
}

void log_set_guard(void (*g)(bool before))
{
    guard = g;
}

bool log_silence(bool silent)
{
    const bool before = silenced;
    silenced = silent;
    return before;
}

static void write_line(bool to_stderr, const char *prefix, const char *format, va_list args)
{
    char line[2300];
    if (silenced)
        return;
    vsnprintf(line, sizeof line, format, args);
    for (char *c = line; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = ' ';
    char stamp[32] = "";
    time_t now = time(NULL);
    struct tm tm;
    if (localtime_r(&now, &tm))
        strftime(stamp, sizeof stamp, "%Y-%m-%dT%H:%M:%S%z", &tm);
    pthread_mutex_lock(&lock);
    if (file)
        fprintf(file, "%s %s%s\n", stamp, prefix, line);
    if (to_stderr) {
        if (guard)
            guard(true);
        fprintf(stderr, "hoodoo: %s%s\n", prefix, line);
        if (guard)
            guard(false);
    }
    pthread_mutex_unlock(&lock);
}

void log_info(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    write_line(true, "", format, args);
    va_end(args);
}

void log_note(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    write_line(false, "", format, args);
    va_end(args);
}

void log_warn(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    write_line(true, "warning: ", format, args);
    va_end(args);
}

void log_error(const char *message)
{
    log_info("%s", message);
}
