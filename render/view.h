/* What of a scene does not hang on a frame: the box it is about, how fine a camera sees it, and how low the ground has to stay. All of it
 * comes from the job, so that the stills of a sequence stand still. */
#ifndef HOODOO_VIEW_H
#define HOODOO_VIEW_H

#include "field/camera.h"
#include "job/job.h"

struct view {
    double size[3]; /* m: the domain's box, from the origin */
    double span;    /* its longest side */
    double pixel;   /* m: what a pixel covers where the box is nearest to the camera */
    double slope;   /* ground this far from the box (m) times slope stays below every camera of the job */
};

/* cameras: those of the picture. */
struct view view_of(const struct job *job, const struct camera *camera, size_t n_cameras);

/* What a pixel of a camera covers where the box is nearest to it, m. */
double view_pixel(const struct view *view, const struct camera *camera);

/* A camera at `azimuth` and `elevation` (deg, as job cameras have them) that holds the box from every azimuth; of turntables, 9 degrees
 * up. */
struct camera view_around(const struct job *job, double azimuth_deg, double elevation_deg, int width,
                          int height);
struct camera view_orbit(const struct job *job, double azimuth_deg, int width, int height);

/* Of a point on the level: how far outside the box it is; 0 within. */
double view_outside(const struct view *view, double x, double y);

/* May a thing stand there, this high above the level? Not where it would hide the box from a camera. */
bool view_leaves_open(const struct view *view, double x, double y, double top);

#endif
