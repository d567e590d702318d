/* What a supervisor looks at: the turntable as a video, and the contact sheet. */
#ifndef HOODOO_TURNTABLE_H
#define HOODOO_TURNTABLE_H

#include "render/picture.h"

enum { TURNTABLE_SECONDS = 6 };

/* NAME.turntable.mp4 from the views of picture_orbit(), once around in TURNTABLE_SECONDS. H.264, 4:2:0, Rec. 709, 24 frames a
 * second. E_INPUT if a view is missing. */
MUST_USE status turntable_video(struct preview *p, int frame, int views);

/* NAME.contact.png: the frames' stills, with number and age on those that have no slate; or, with views > 0, every third view of
 * an orbit. */
MUST_USE status turntable_contact(struct preview *p, const int *frames, size_t n, int views);

/* NAME.wedges.png under the farm's folder p->root: the still of each wedge's last frame, with its values.
 * Wedges without one are left out; E_INPUT if none has. */
MUST_USE status turntable_wedges(struct preview *p, const struct job *const *wedge, size_t n);

#endif
