/* Turntable video and contact sheets. */
#ifndef HOODOO_TURNTABLE_H
#define HOODOO_TURNTABLE_H

#include "render/picture.h"

enum { TURNTABLE_SECONDS = 6 };

/* Encodes NAME.turntable.mp4 from the views of picture_orbit(), a full turn in TURNTABLE_SECONDS: H.264, 4:2:0, Rec. 709, 24 frames per
 * second. E_INPUT: a view is missing. */
MUST_USE status turntable_video(struct preview *p, int frame, int views);

/* NAME.contact.png: the stills of n frames, with frame and age drawn on those without a slate; or, with views > 0, every third view of
 * an orbit. */
MUST_USE status turntable_contact(struct preview *p, const int *frames, size_t n, int views);

/* NAME.wedges.png in the folder of wedges p->root: the still of each wedge's last frame, labelled with its values. Wedges without a still
 * are omitted. E_INPUT: no wedge has a still. */
MUST_USE status turntable_wedges(struct preview *p, const struct job *const *wedge, size_t n);

#endif
