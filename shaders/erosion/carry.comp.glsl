#version 460
#extension GL_GOOGLE_include_directive : require
// Per particle, one round of the carry: erodes it through the faces that particles which vanished in the
// previous round have bared, for what was left of the step when they vanished. Particles that vanish now pass
// their remainder on in the next round. So the retreat does not depend on the length of the step. Rock deeper
// than NEAR_REACH layers is left out (beyond.comp.glsl). A particle that was inside takes over normal and
// vegetation of those in front of it.
#include "shared/buffers.glsl"
#include "shared/params.h"

READ_V(0, position)
WRITE_V(1, normal)
READ_U(2, start)
READ_F(3, erodibility)
READ_F(4, unspent) // rest of the step of particles that vanished in the last round
WRITE_F(5, viability)
WRITE_U(6, shares) // of vanished particles: the processes' shares
WRITE_U(7, spent)  // quanta
WRITE_U(8, parts)  // the processes' shares
READ_U(9, words)
WRITE_F(10, next) // rest of the step of particles that vanish now
WRITE_U(11, counts)
WRITE_F(12, vegetation)
READ_U(13, phase)
PARAMS(carry_params)
#include "erosion/carry.glsl"
