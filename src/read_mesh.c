/* hoodoo-read-mesh: reads one mesh in a sandbox, on behalf of hoodoo (meshinput/serve.h). */
#include "meshinput/serve.h"
#include "system/begin.h"

int main(int argc, char **argv)
{
    process_begin();
    return mesh_serve_main(argc, argv);
}
