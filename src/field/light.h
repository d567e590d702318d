/* The light of a job in a frame, the same for AOVs, previews and USD. Simulator axes. */
#ifndef HOODOO_LIGHT_H
#define HOODOO_LIGHT_H

#include <stdbool.h>

#include "field/sky.h"
#include "job/job.h"

/* Colours are scene-linear Rec. 709: the radiance of a white surface. */
struct light {
    double sun[3];     /* unit, towards it */
    double sun_rgb[3]; /* on a surface that faces it */
    struct sky sky;
    double sky_rgb[3];    /* the open sky on level ground */
    double bounce_rgb[3]; /* light from sunlit ground, on a surface that faces down */
    double exposure;      /* factor for the view of previews */
};

/* Without a sun in the job, it rakes across the first camera's view of the first frame, from the side of the wind, and stays there in world
 * space. */
struct light light_of(const struct job *job, double frame);

/* Does the light change between frames? */
bool light_changes(const struct job *job);

/* The unit direction towards a sun; azimuth_deg as for cameras: from +x counter-clockwise. */
void light_direction(double azimuth_deg, double elevation_deg, double out[3]);

/* The unit direction towards the sun on `day` of the year (1: January 1st), at `hour` of solar time; north is +y, east +x. Declination by
 * Cooper (1969). */
void light_solar(double latitude_deg, double day, double hour, double out[3]);

#endif
