/* The light of a job in a frame: what pictures, previews and USD have in common. Simulator axes. */
#ifndef HOODOO_LIGHT_H
#define HOODOO_LIGHT_H

#include <stdbool.h>

#include "field/sky.h"
#include "job/job.h"

/* Colours are scene-linear Rec. 709: what a white surface sends back. */
struct light {
    double sun[3];     /* unit, towards it */
    double sun_rgb[3]; /* on a surface that faces it */
    struct sky sky;
    double sky_rgb[3];    /* the open sky on level ground */
    double bounce_rgb[3]; /* what sunlit ground throws up, on a surface that faces down */
    double exposure;      /* factor of previews' view */
};

/* Without a sun in the job: raking over the first camera's view at the first frame, from the side that the wind comes from, so that it
 * stays where it is in the world. */
struct light light_of(const struct job *job, double frame);

/* Is it another one in some frame? */
bool light_changes(const struct job *job);

/* The same towards a sun that somebody else has set up; `azimuth_deg` as a camera's. */
void light_direction(double azimuth_deg, double elevation_deg, double out[3]);

/* Where the sun stands: `day` of the year (1: January 1st), `hour` of solar time, north +y, east +x. Cooper's declination. */
void light_solar(double latitude_deg, double day, double hour, double out[3]);

#endif
