/* A clear sky, and the sun through it.
 *
 * Radiance     Preetham, Shirley and Smits, A Practical Analytic Model for Daylight, SIGGRAPH 1999: the sky's luminance and
 *              chromaticity over the dome (their appendix A.2), and what Rayleigh scattering and aerosols leave of sunlight (A.1,
 *              eqs. 1 and 2), here at one wavelength each for red, green and blue, without ozone and gases.
 * Units        Scene-linear, Rec. 709: what a white surface that faces the light sends back. One kcd/m2 is SKY_PER_KCD,
 *              so that white in the afternoon's sun and sky is near 1.
 * Strength     The model's skies are brighter than measured ones (Zotti, Wilkie and Purgathofer, A Critical Review of the Preetham
 *              Skylight Model, WSCG 2007): they are taken at SKY_MEASURED, with which level ground has a third as much of the sky
 *              as of a sun 30 degrees high.
 * Low sun      The model is made for a sun that is up. Below the horizon there is no sun, and the sky is that of the
 *              horizon, ten times darker every six degrees.
 */
#ifndef HOODOO_SKY_H
#define HOODOO_SKY_H

#define SKY_PER_KCD 0.042
#define SKY_MEASURED 0.7

struct sky {
    double sun[3];   /* unit, towards it */
    double lift;     /* the sun's elevation, rad, where the model uses it: not below half a degree */
    double strength; /* factor on radiance */
    double perez[3][5],
        zenith
            [3]; /* of luminance Y (kcd/m2) and of chromaticity x, y: coefficients A to E, and values overhead */
};

/* turbidity: 1.7 in clean mountain air to 10 in haze. */
struct sky sky_make(const double sun[3], double turbidity, double strength);

/* Radiance from a unit direction; below the horizon as at it. */
void sky_radiance(const struct sky *sky, const double direction[3], double rgb[3]);

/* What the half of the dome that a surface of this unit normal faces sends it, over pi: the radiance of a white one. Without the
 * ground. */
void sky_light(const struct sky *sky, const double normal[3], double rgb[3]);

/* Of the sun at normal incidence, the same; 0 below the horizon. */
void sky_sun(const double sun[3], double turbidity, double rgb[3]);

#endif
