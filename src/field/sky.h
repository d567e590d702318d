/* A clear sky and the sunlight through it.
 *
 * Radiance     Preetham, Shirley and Smits, A Practical Analytic Model for Daylight, SIGGRAPH 1999: luminance and
 *              chromaticity of the sky (appendix A.2), and the transmission of sunlight through Rayleigh scattering and aerosols
 *              (A.1, eqs. 1 and 2), here at one wavelength each for red, green and blue, without ozone and gases.
 * Units        Scene-linear Rec. 709: the radiance of a white surface that faces the light. 1 kcd/m2 is SKY_PER_KCD, so that white in
 *              afternoon sun and sky is near 1.
 * Strength     The model's skies are brighter than measured ones (Zotti, Wilkie and Purgathofer, A Critical Review of the Preetham
 *              Skylight Model, WSCG 2007) and are multiplied by SKY_MEASURED. Level ground then gets a third as much light from the
 *              sky as from a sun 30 degrees high.
 * Low sun      The model is made for a sun above the horizon. Below it there is no sunlight, and the sky is that of a sun at the
 *              horizon, ten times darker every six degrees.
 */
#ifndef HOODOO_SKY_H
#define HOODOO_SKY_H

#define SKY_PER_KCD 0.042
#define SKY_MEASURED 0.7

struct sky {
    double sun[3];   /* unit, towards it */
    double lift;     /* the sun's elevation used by the model, rad: at least half a degree */
    double strength; /* factor on radiance */
    /* Luminance Y (kcd/m2) and chromaticity x, y: Perez coefficients A to E, and values at the zenith. */
    double perez[3][5], zenith[3];
};

/* turbidity: from 1.7 in clean mountain air to 10 in haze. */
struct sky sky_make(const double sun[3], double turbidity, double strength);

/* Radiance from a unit direction; below the horizon that of the horizon. */
void sky_radiance(const struct sky *sky, const double direction[3], double rgb[3]);

/* The irradiance from the sky on a surface with this unit normal divided by pi, the radiance of a white surface. Excludes the ground. */
void sky_light(const struct sky *sky, const double normal[3], double rgb[3]);

/* The same from the sun at normal incidence; 0 if it is below the horizon. */
void sky_sun(const double sun[3], double turbidity, double rgb[3]);

#endif
