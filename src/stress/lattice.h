/* Sparse storage of the stress grid's nodes and cells: only where there is rock, in runs of STRESS_RUN along x.
 *
 * Runs       A run is kept if it holds a node of a filled cell or a node next to one in its row. Kept runs are stored in the
 *            order of the whole grid; a table over all runs finds them (shaders/stress/grid.glsl). A cell is stored in the
 *            slot of its first node. Buffers of values have lattice_items() items: all kept runs, and three runs of zeros
 *            that stand for everything outside.
 * Calling sequence   for each new shape: mark the runs; lattice_choose() computes the new layout; copy values from the old
 *            layout; lattice_table() switches the table to the new one; compute the fill; lattice_activate().
 */
#ifndef HOODOO_STRESS_LATTICE_H
#define HOODOO_STRESS_LATTICE_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"

struct stress_lattice {
    int cells[3];             /* with the margin: two more than the domain's */
    unsigned walls;           /* WALL_*, set by the caller */
    size_t n_table;           /* runs of the whole grid */
    size_t n, capacity;       /* runs kept, and runs allocated */
    size_t n_active;          /* nodes that move: the unknowns are three for each */
    struct gpu_buffer *table; /* uint [n_table]: first slot of each run */
    struct gpu_buffer *run;   /* uint [runs allocated + 3]: the run stored there, or STRESS_NO_RUN */
    struct gpu_buffer *
        fill; /* float [items], by cell: share of rock or, negative and on coarser levels, of the stiffness */
    struct gpu_buffer *list;          /* uint [n_active]: slots of the nodes that move, ascending */
    struct gpu_buffer *flags, *place; /* uint [items]: scratch */
};

/* Number of runs of the whole grid. */
size_t lattice_runs(const int cells[3]);

/* Number of items of each buffer of values, and its maximum for a grid. */
size_t lattice_items(const struct stress_lattice *l);
size_t lattice_items_most(const int cells[3]);

/* Estimated extent of the rock: filled cells, bare faces of these, and bare faces that end a row along x. */
struct rock_size {
    uint64_t inside, bare, ends;
};

/* Estimated bytes on the device for such rock, including `others` bytes per item for the caller's own buffers. */
uint64_t lattice_bytes(const int cells[3], const struct rock_size *rock, uint64_t others);

/* An empty lattice. */
MUST_USE status lattice_create(struct gpu *gpu, const int cells[3], struct stress_lattice *out);
void lattice_destroy(struct gpu *gpu, struct stress_lattice *l);

/* Lays out the runs whose mark is 1 (marks: uint [n_table + 1], overwritten). They are found by the table only after
 * lattice_table(). Buffers whose capacity changes are created again and lose their values. Waits for the device. */
MUST_USE status lattice_choose(struct gpu *gpu, struct gpu_work *work, struct stress_lattice *l,
                               struct gpu_buffer *marks);
void lattice_table(struct gpu *gpu, struct stress_lattice *l);

/* Lists the nodes that move, from the fill. Waits for the device. */
MUST_USE status lattice_activate(struct gpu *gpu, struct gpu_work *work, struct stress_lattice *l);

/* Kernel parameters for n invocations, with the grid's layout only: material and load are 0. */
struct stress_params lattice_params(const struct stress_lattice *l, size_t n);

/* Makes *buffer one of lattice_items() items of `item` bytes: kept if its size is right, else destroyed and created again,
 * filled with zeros. */
MUST_USE status lattice_buffer(struct gpu *gpu, const struct stress_lattice *l, const char *name, size_t item,
                               struct gpu_buffer **buffer);

#endif
