/* A person of 1.75 m made of balls and limbs, which shows the scale of a scene. */
#ifndef HOODOO_PERSON_H
#define HOODOO_PERSON_H

/* Lengths in m. The person stands on z = 0 at the origin and faces +y. If rb < 0, the part is an ellipsoid around `a` with the radii ra
 * times `stretch`; otherwise it is a limb from `a` to `b` whose radius changes from ra to rb. */
struct person_part {
    double a[3], ra, b[3], rb, stretch[3], rgb[3]; /* scene-linear */
};

enum { PERSON_PARTS = 10 };
extern const struct person_part person_part[PERSON_PARTS];

#endif
