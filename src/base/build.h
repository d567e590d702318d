/* Identifies the code that computes results. */
#ifndef HOODOO_BUILD_H
#define HOODOO_BUILD_H

/* 16 hex digits: a hash of the version and of the object code that computes the simulation and writes the frames' files (see
 * the Makefile). Builds with the same hash produce the same bytes on the same device. */
extern const char hoodoo_build[];

#endif
