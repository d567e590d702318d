#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>

static _Thread_local char message[2048] = "no error";

status fail(status st, const char *format, ...)
{
    /* Formatted into a buffer first, because an argument may be status_message() itself. */
    char text[sizeof message];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    /* A single line without control characters, which a terminal or a log parser might interpret. */
    size_t n = 0;
    for (const char *c = text; *c; c++)
        message[n++] = (unsigned char)*c < 0x20 || *c == 0x7f ? ' ' : *c;
    message[n] = '\0';
    return st;
}

const char *status_message(void)
{
    return message;
}
