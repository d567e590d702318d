/* hoodoo-vdb.so: what needs OpenVDB in this process. Loading OpenVDB costs more than most of what hoodoo is asked, so it is
 * loaded (beside.h) when it is first needed.
 *
 * The library has its own copy of base/, so what it fails of has to be fetched: library_said().
 */
#ifndef HOODOO_LIBRARY_H
#define HOODOO_LIBRARY_H

#include "base/status.h"

/* The function of that name, in *function (a pointer to a function pointer). E_OUTPUT: the library is missing, or is none of
 * this build. From any thread. */
MUST_USE status library_find(const char *name, void *function);

/* `st`, which a function of the library returned to this thread, with its sentence. */
MUST_USE status library_said(status st);

#endif
