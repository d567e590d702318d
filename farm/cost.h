/* What a job takes and costs on some numbers of nodes: hoodoo plan --nodes 1,4,16 --price 2.5/h. */
#ifndef HOODOO_FARM_COST_H
#define HOODOO_FARM_COST_H

#include "farm/graph.h"
#include "text/text.h"

enum { COST_ROWS = 32, COST_NODES = 100000 };

struct cost_asked {
    size_t n, nodes[COST_ROWS];
    double price_h; /* of a node, for an hour; negative: none given */
};

/* `nodes`: "1,4,16". `price`: "2.5/h", or NULL. E_USAGE. */
MUST_USE status cost_parse(const char *nodes, const char *price, struct cost_asked *out);

/* Adds members "nodes" (a row for each number of nodes), "critical_path" (names of tasks) and "shortest_seconds", its time, to the open JSON
 * object. `words`: for people. E_USAGE: the time of a
 * frame is not known. E_MEMORY. */
MUST_USE status cost_describe(const struct farm_graph *graph, const struct cost_asked *asked, bool words,
                              struct text *out);

#endif
