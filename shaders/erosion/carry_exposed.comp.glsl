#version 460
#extension GL_GOOGLE_include_directive : require
// erosion/carry.comp.glsl for rock that stores how long it has been exposed.
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
WRITE_F(14, exposed)
WRITE_F(15, crust)
PARAMS(carry_params)
#define EXPOSED
#include "erosion/carry.glsl"
