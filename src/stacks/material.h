/* What stacks are made of: air, bedrock, sand, rock and water, and what a job adds.
 *
 * Bedrock stays where it is. Loose materials slide where they are steeper than their angle of repose, and lie
 * over each other in the table's order (Arches 3.4): sand, then rock, then what the job adds, then water.
 */
#ifndef HOODOO_MATERIAL_H
#define HOODOO_MATERIAL_H

#include <stdint.h>

#include "base/status.h"
#include "job/values.h"

enum { MATERIAL_AIR, MATERIAL_BEDROCK, MATERIAL_SAND, MATERIAL_ROCK, MATERIAL_WATER, MATERIALS_OWN };

/* The material whose share a value of values.def is; MATERIAL_AIR: none's. */
extern const int value_material[VALUES];

struct material {
    char name[65];
    double repose_deg;  /* steepest slope it rests at; 90 and more: it does not slide */
    double erodibility; /* of what local erosion asks for, the share that is taken */
    float color[3];     /* linear */
};

#endif
