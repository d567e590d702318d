/* How water pulls on floors, in plain C over cells of one voxel: water/wide and water/pull. */
#ifndef HOODOO_TESTS_STREAM_REF_H
#define HOODOO_TESTS_STREAM_REF_H

#include "job/job.h"
#include "tests/ref/flow_ref.h"

struct stream_ref {
    double stream, beside; /* Pa: in the stream, and beside it */
    double share;          /* of the floor that is stream */
    double shown;          /* m3/yr */
    double drop;           /* m: to the floors below by which its slope is */
};

/* By cell, for those that are floors. rain, spring: m3/yr through each cell, split by `level` and along the receivers. The
 * caller's to free. */
struct stream_ref *stream_ref_pull(const struct flow_ref *f, const struct job_rain *how, double h,
                                   const uint32_t *level, const double *rain, const double *spring);

#endif
