/* A camera of a job: its position and film in simulator axes, for casting rays. */
#ifndef HOODOO_CAMERA_H
#define HOODOO_CAMERA_H

#include <stdbool.h>

#include "job/job.h"

struct camera {
    double eye[3];
    double ahead[3];          /* unit */
    double right[3], down[3]; /* half the film's width and height, at distance 1 */
    int width, height;        /* px */
};

/* The camera in a frame, without overscan. */
struct camera camera_of(const struct job_camera *camera, double frame);

/* A camera on a sphere around a target; `film` is half the film's width divided by the focal length. */
struct camera camera_orbit(const double target[3], double distance, double azimuth_deg, double elevation_deg,
                           double film, int width, int height);

/* The camera with a margin of pixels on each side, in x and y. */
struct camera camera_overscan(struct camera c, const int margin[2]);

/* The position of a point in the image: px from the upper left corner, x to the right, y down. False: it is not in front of the camera. */
bool camera_project(const struct camera *c, const double x[3], double px[2]);

/* The matrices of EXR, for row vectors, from file axes (`up` y or z) to camera space (x right, y up, z ahead: left-handed) and to normalised
 * device coordinates ((0, 0) upper left to (1, 1) lower right, after division by w). */
void camera_matrices(const struct camera *c, int up, double world_to_camera[16], double world_to_ndc[16]);

#endif
