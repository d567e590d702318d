/* A person of 1.75 m in a picture, which shows the size of the rock. */
#ifndef HOODOO_LOOK_FIGURE_H
#define HOODOO_LOOK_FIGURE_H

#include "look/shot.h"

/* Draws the person on level ground that the camera sees, in front of the rock and slightly to the side. Draws nothing if the camera sees no
 * level ground. */
void figure_draw(const struct job *job, int frame, struct shot *s);

#endif
