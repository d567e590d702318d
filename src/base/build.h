/* Which code this is. */
#ifndef HOODOO_BUILD_H
#define HOODOO_BUILD_H

/* 16 hex digits: a hash of the version and of the object code that computes the state and the frames' files (Makefile).
 * Builds with the same hash give the same bytes on the same device. */
extern const char hoodoo_build[];

#endif
