/* Repairs a mesh as files have it so that inside and outside can be told apart. */
#ifndef HOODOO_MESHINPUT_REPAIR_H
#define HOODOO_MESHINPUT_REPAIR_H

#include "meshinput/edges.h"

/* Joins vertices at the same position, and those of open edges within `tolerance`, m; drops duplicate faces; orients faces like their
 * neighbours and closed parts outwards. Logs what it changed; `path` is for messages. *open: the edges that are open after that; the
 * caller frees open->edge, also on error. E_INPUT: no face with an area, or no volume, is left. E_MEMORY. */
MUST_USE status mesh_repair(struct mesh *mesh, const char *path, double tolerance, struct mesh_open *open);

#endif
