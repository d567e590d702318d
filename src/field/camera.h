/* A job's camera, ready to shoot rays: where it stands and what its film spans. Simulator axes. */
#ifndef HOODOO_CAMERA_H
#define HOODOO_CAMERA_H

#include "job/job.h"

struct camera {
    double eye[3];
    double ahead[3];          /* unit */
    double right[3], down[3]; /* half the film's width and height, at distance 1 */
    int width, height;        /* px */
};

/* As it is in a frame, without overscan. */
struct camera camera_of(const struct job_camera *camera, double frame);

/* Around a target, as job cameras have it; `film` is half the film's width over the focal length. */
struct camera camera_orbit(const double target[3], double distance, double azimuth_deg, double elevation_deg,
                           double film, int width, int height);

/* The same with a margin of pixels on every side. */
struct camera camera_overscan(struct camera c, const int margin[2]);

/* EXR's matrices, row vectors times matrix, from file axes (up y or z): to camera space (x right, y up, z
 * ahead: left-handed) and to normalised device coordinates (0, 0 upper left to 1, 1 lower right, after
 * division by w). */
void camera_matrices(const struct camera *c, int up, double world_to_camera[16], double world_to_ndc[16]);

#endif
