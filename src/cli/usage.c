#include "cli/cli.h"

#define VERB_USAGE(verb, operands, summary) const struct usage usage_##verb = {#verb, operands, summary};
VERBS(VERB_USAGE)
