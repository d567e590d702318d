/* The materials of stacks: air, bedrock, sand, rock, water and those that a job adds.
 *
 * Bedrock does not move. Loose materials slide where they are steeper than their angle of repose, and are stacked in a fixed order
 * (Arches 3.4): sand, rock, the job's own in their order, water.
 */
#ifndef HOODOO_MATERIAL_H
#define HOODOO_MATERIAL_H

#include <stdint.h>

#include "base/status.h"
#include "job/values.h"

enum { MATERIAL_AIR, MATERIAL_BEDROCK, MATERIAL_SAND, MATERIAL_ROCK, MATERIAL_WATER, MATERIALS_OWN };

/* The material whose share a value of values.def shows; MATERIAL_AIR: none. */
extern const int value_material[VALUES];

struct material {
    char name[65];
    double repose_deg;  /* angle of repose; 90 or more: it does not slide */
    double erodibility; /* share of the affected material that the tool erode breaks up, 0..1 */
    float color[3];     /* linear */
};

#endif
