/* A person of 1.75 m, of balls and limbs: by whom the size of a scene is seen. */
#ifndef HOODOO_PERSON_H
#define HOODOO_PERSON_H

/* Stands on z = 0 at the origin and faces +y, m. `rb` < 0: a ball around `a` with the radii ra times `stretch`; else a limb from `a` to
 * `b`, whose radius goes from ra to rb. */
struct person_part {
    double a[3], ra, b[3], rb, stretch[3], rgb[3]; /* scene-linear */
};

enum { PERSON_PARTS = 10 };
extern const struct person_part person_part[PERSON_PARTS];

#endif
