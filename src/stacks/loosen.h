/* Solid pieces that stand on nothing become rock, which then falls (stabilise.h).
 *
 * The paper's bedrock never moves, wherever tools have left it; crumbs of it hang in the air where noise has cut
 * them off. Here a piece is solid layers that overlap from stack to stack (four neighbours). It stands if one
 * of its layers begins at the floor, or lies on loose material that fills the room below it down to a piece
 * that stands. Air and water carry nothing.
 */
#ifndef HOODOO_LOOSEN_H
#define HOODOO_LOOSEN_H

#include "stacks/stacks.h"

/* `solid`: a bit each, as spaces_kinds() has it. lo..hi are the stacks that changed; lo[0] > hi[0]: none. On an
 * error nothing has changed. */
MUST_USE status loosen(struct stacks *s, uint32_t solid, int lo[2], int hi[2]);

#endif
