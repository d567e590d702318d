/* hoodoo-read-mesh, which decodes mesh files (decode.h). reader/mesh_part.h has its answer. */
#ifndef HOODOO_MESHINPUT_SERVE_H
#define HOODOO_MESHINPUT_SERVE_H

/* The main() of hoodoo-read-mesh. */
int mesh_serve_main(int argc, char **argv);

#endif
