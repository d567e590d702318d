/* A mesh as files have it, made fit to tell inside from outside. */
#ifndef HOODOO_MESHINPUT_REPAIR_H
#define HOODOO_MESHINPUT_REPAIR_H

#include "meshinput/edges.h"

/* Joins corners at the same place, and of open edges those within `tolerance`, m; drops faces that are there twice, once for
 * either side; turns faces as their neighbours are, and closed parts outwards. Says in the log what it did. *open: where the
 * surface ends after that, freed by the caller, on failure too. E_INPUT: nothing is left. */
MUST_USE status mesh_tidy(struct mesh *mesh, const char *path, double tolerance, struct mesh_open *open);

#endif
