/* hoodoo-read-mesh: one glTF mesh for hoodoo (scene/mesh_serve.h). */
#include "base/begin.h"
#include "scene/mesh_serve.h"

int main(int argc, char **argv)
{
    process_begin();
    return mesh_serve_main(argc, argv);
}
