#include "meshinput/serve.h"

#include <stdlib.h>

#include "base/atomic_file.h"

#define MEMORY ((uint64_t)1 << 30)
#define MAX_FILE ((size_t)8 << 30)

static status read_mesh(const struct serve_question *question, struct serve_answer *answer)
{
    status st = OK;
    char *bytes = NULL;
    size_t size = 0;
    if (question->n_arguments != 1)
        return fail(E_INPUT,
                    "%s: hoodoo-read-mesh got %zu arguments: hoodoo and its readers are of different builds",
                    question->path, question->n_arguments);
    TRY(file_read(question->path, MAX_FILE, &bytes, &size));
    TRY(mesh_import(question->path, question->argument[0], bytes, size, answer));
done:
    free(bytes);
    return st;
}

int mesh_serve_main(int argc, char **argv)
{
    static const struct serve_kind kinds[] = {{"mesh", MEMORY, read_mesh}};
    return serve(argc, argv, kinds, sizeof kinds / sizeof *kinds);
}
