/* hoodoo-vdb.so: the functions that need OpenVDB. Loading OpenVDB takes longer than most commands, so the library is loaded
 * (beside.h) when it is first needed.
 *
 * The library has its own copy of base/ with its own error message, which library_status() copies to this program.
 */
#ifndef HOODOO_LIBRARY_H
#define HOODOO_LIBRARY_H

#include "base/status.h"

/* Sets *function (a pointer to a function pointer) to the function of that name. E_OUTPUT: the library is missing or belongs to another
 * build. May be called from any thread. */
MUST_USE status library_find(const char *name, void *function);

/* Forwards the status that a function of the library returned to this thread, with its message. */
MUST_USE status library_status(status st);

#endif
