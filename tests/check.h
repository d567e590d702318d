/* Includes cmocka without its macro fail(), which conflicts with ours. Include this first. */
#ifndef HOODOO_CHECK_H
#define HOODOO_CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#undef fail

#include "base/status.h"

/* Fails the test with the error message unless the call succeeds. */
#define assert_ok(call)                                                                                      \
    do {                                                                                                     \
        if ((call) != OK) {                                                                                  \
            print_error("%s: %s\n", #call, status_message());                                                \
            _fail(__FILE__, __LINE__);                                                                       \
        }                                                                                                    \
    } while (0)

#endif
