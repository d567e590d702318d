/* What a task runs: a command line as a list of words, never a line for a shell. */
#ifndef HOODOO_FARM_COMMAND_H
#define HOODOO_FARM_COMMAND_H

#include "base/text.h"
#include "farm/farm.h"

struct farm_command {
    const char *argv[16]; /* ends with NULL; points into `word` or at constants */
    size_t n;
    char word[8][FARM_PATH + 64];
    size_t n_words;
};

/* `device`: for --device of tasks that need one (graph_needs_device()), or NULL for none. */
void farm_command(const struct farm *f, const struct farm_task *t, const char *device,
                  struct farm_command *out);

/* One word for a POSIX shell, whatever is in it. */
void farm_quote(struct text *out, const char *word);

/* Is trying the task again of no use? Wrong usage, another job's checkpoint, numbers that blew up. */
bool farm_final(int exit_code);

#endif
