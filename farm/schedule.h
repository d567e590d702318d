/* How long a job takes on a number of equal nodes, and which of its tasks decide that: list scheduling of the graph.
 *
 * Nodes      Each runs one task at a time. A task starts as soon as all that it waits for have ended and a node is idle; among
 *            several the one with the longest chain of tasks behind it, so that blocks of all wedges advance together and what is
 *            made of their frames fills the gaps. Of idle nodes the first is taken, so that the last ones can be given back.
 * Cost       A node is paid from the start of the job to the end of its last task, idle times between included.
 * Times      Estimates of the graph. Start-up of nodes and queueing are not part of it.
 *
 * Graham 1969, "Bounds on Multiprocessing Timing Anomalies": the time is less than twice the best possible.
 */
#ifndef HOODOO_FARM_SCHEDULE_H
#define HOODOO_FARM_SCHEDULE_H

#include "farm/graph.h"

struct schedule {
    double seconds;      /* from the start to the end of the last task */
    double node_seconds; /* paid, of all nodes */
    double busy_seconds; /* of which tasks run */
    size_t nodes_used;
    double *start; /* [graph->n], s; free with schedule_free() */
    size_t *node;  /* [graph->n] */
};

/* Schedules all tasks on `nodes` nodes, 1 or more. E_MEMORY. */
MUST_USE status schedule_make(const struct farm_graph *graph, size_t nodes, struct schedule *out);
void schedule_free(struct schedule *schedule);

/* The longest chain of tasks by their seconds: no number of nodes is faster. *path: the indices of its *n tasks in order, freed by the
 * caller. E_MEMORY. */
MUST_USE status schedule_critical_path(const struct farm_graph *graph, size_t **path, size_t *n,
                                       double *seconds);

/* All tasks, the most urgent first: the one with the longest chain of tasks behind it; of equal ones the first. A block whose time is not
 * known counts a second for each frame. *order: [graph->n], freed by the caller. E_MEMORY. */
MUST_USE status schedule_order(const struct farm_graph *graph, size_t **order);

#endif
