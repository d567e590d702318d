/* Checks a model's numbers at the end of every stage of a frame: all floats on the device that outlive the stage. Arrays that rarely
 * change are checked only after the stage that writes them and before the stage that reads them.
 *
 * A number that is not finite, or so large that it has run away, ends the run in that frame with E_NUMERIC; the message names the
 * stage, the particle and its position. Files and checkpoints written before are kept.
 */
#ifndef HOODOO_NUMBERS_H
#define HOODOO_NUMBERS_H

#include "particles/particles.h"

enum { WATCHED_MOST = 64 };

/* An array of floats or vectors on the device. */
struct watched {
    const char *name;
    struct gpu_buffer *buffer;
    size_t n; /* items to check; the buffer may have more */
};

struct watch_list {
    const char *stage, *next; /* the stage that has ended and the one that begins */
    size_t n;
    struct watched item[WATCHED_MOST];
    const struct particles *particles; /* NULL: no particle fields are watched */
    size_t n_particle_items;           /* the first items, which are fields of `particles` */
};

/* Adds a buffer, unless it is NULL or n is 0. */
void watch_add(struct watch_list *list, const char *name, struct gpu_buffer *buffer, size_t n);

/* Adds the fields of the particles; must be called before watch_add(). `particles` may be NULL. */
void watch_particles(struct watch_list *list, const struct particles *particles);

/* Creates the buffer in which the kernel stores, for each watched array, the index of its first bad item. */
MUST_USE status numbers_create(struct gpu *gpu, struct gpu_buffer **found);

/* Checks all watched arrays. Waits. E_NUMERIC. */
MUST_USE status numbers_check(struct gpu *gpu, struct gpu_buffer *found, const struct watch_list *list,
                              int frame);

/* A hook for tests, NULL in the program: called before the check, so that a test can plant bad numbers between two stages. */
extern void (*numbers_plant)(struct gpu *gpu, const struct watch_list *list);

#endif
