/* Are a model's numbers sound? Asked at the end of every stage of a frame, of all that is on the device and lasts longer than the stage.
 *
 * What hardly changes between two stages is looked at where it was made and before it is used.
 *
 * A number that is not finite, or so large that it has run away, ends the run in the frame in which it appears (E_NUMERIC), with the
 * stage after which it was there, the particle and its place. What was saved before stays.
 */
#ifndef HOODOO_NUMBERS_H
#define HOODOO_NUMBERS_H

#include "particles/particles.h"

enum { WATCHED_MOST = 64 };

/* Floats or vectors on the device. */
struct watched {
    const char *name;
    struct gpu_buffer *buffer;
    size_t n; /* items; what is behind them may be anything */
};

struct watch_list {
    const char *stage, *next; /* that has ended, and that will begin */
    size_t n;
    struct watched item[WATCHED_MOST];
    const struct particles *particles; /* whose fields those of n_particle_items are; NULL: none */
    size_t n_particle_items;           /* the first ones */
};

/* Adds a buffer, unless it is not there or n is 0. */
void watch_add(struct watch_list *list, const char *name, struct gpu_buffer *buffer, size_t n);

/* Adds the particles' own fields; before all else. NULL: there are none at present. */
void watch_particles(struct watch_list *list, const struct particles *particles);

/* A word for each that is watched: the first bad item. */
MUST_USE status numbers_create(struct gpu *gpu, struct gpu_buffer **found);

/* Waits. E_NUMERIC. */
MUST_USE status numbers_check(struct gpu *gpu, struct gpu_buffer *found, const struct watch_list *list,
                              int frame);

/* NULL but in tests, which plant numbers here: it is called before they are looked at. A test has no other way between two stages, and
 * the program none at all. */
extern void (*numbers_plant)(struct gpu *gpu, const struct watch_list *list);

#endif
