/* cmocka, with its fail() out of the way of ours. Include first. */
#ifndef HOODOO_CHECK_H
#define HOODOO_CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#undef fail

#include "base/status.h"

/* The call succeeds; otherwise the test fails with its sentence. */
#define assert_ok(call)                                                                                      \
    do {                                                                                                     \
        if ((call) != OK) {                                                                                  \
            print_error("%s: %s\n", #call, status_message());                                                \
            _fail(__FILE__, __LINE__);                                                                       \
        }                                                                                                    \
    } while (0)

#endif
