/* The parts of a scene that do not depend on the frame: its box, the resolution at which cameras see it, and the maximum height of the ground.
 * All of it comes from the job, so that the background of a sequence does not change. */
#ifndef HOODOO_VIEW_H
#define HOODOO_VIEW_H

#include "field/camera.h"
#include "job/job.h"

struct view {
    double size[3]; /* m: the domain's box, from the origin */
    double span;    /* its longest side */
    double pixel;   /* m: size of a pixel at the point of the box that is nearest to the camera */
    double
        slope; /* ground at distance d (m) from the box must stay below d times slope, so that no camera's view is blocked */
};

/* camera: [n_cameras], those of the picture. */
struct view view_of(const struct job *job, const struct camera *camera, size_t n_cameras);

/* The size (m) of a pixel of a camera at the point of the box that is nearest to it. */
double view_pixel(const struct view *view, const struct camera *camera);

/* A camera at an azimuth and elevation (deg, as in cameras of jobs), at a distance from which the box fits into the picture at every azimuth.
 * view_orbit() is that of turntables, at an elevation of 9 degrees. */
struct camera view_around(const struct job *job, double azimuth_deg, double elevation_deg, int width,
                          int height);
struct camera view_orbit(const struct job *job, double azimuth_deg, int width, int height);

/* The horizontal distance (m) of a point from the box; 0 inside. */
double view_outside(const struct view *view, double x, double y);

/* May an object whose top is at height `top` (m) stand there without hiding the box from a camera? */
bool view_leaves_open(const struct view *view, double x, double y, double top);

#endif
