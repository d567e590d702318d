/* A person of 1.75 m in a picture, by whom the size of the rock is seen. */
#ifndef HOODOO_LOOK_FIGURE_H
#define HOODOO_LOOK_FIGURE_H

#include "look/shot.h"

/* Stands on the level ground where the camera sees it, before the rock and a little aside; nowhere if it sees none. */
void figure_draw(const struct job *job, int frame, struct shot *s);

#endif
