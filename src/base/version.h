/* Version and commit of this build. */
#ifndef HOODOO_VERSION_H
#define HOODOO_VERSION_H

extern const char hoodoo_version[]; /* "0.1.0" */
extern const char hoodoo_commit[];  /* short commit hash, or "unknown" */

#endif
