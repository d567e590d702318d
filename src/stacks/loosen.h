/* Solid pieces without support become rock, which then falls (stabilise.h).
 *
 * In the paper bedrock never moves, so that fragments that the tools have cut off hang in the air. Here a piece is a set of solid layers
 * that overlap between neighbouring stacks (four neighbours). A piece is supported if one of its layers starts at the floor, or rests on
 * loose material that fills the space below it down to a supported piece. Air and water support nothing.
 */
#ifndef HOODOO_LOOSEN_H
#define HOODOO_LOOSEN_H

#include "stacks/stacks.h"

/* Turns unsupported pieces into rock. `solid`: the set of solid materials (spaces_kinds()). lo..hi: the stacks that changed; lo[0] > hi[0]:
 * none. On an error s is unchanged. E_MEMORY. */
MUST_USE status loosen(struct stacks *s, uint32_t solid, int lo[2], int hi[2]);

#endif
