/* The functions of hoodoo-vdb.so behind sdf.h, which loads it when they are first called. */
#ifndef HOODOO_MESHINPUT_SDF_MAKE_H
#define HOODOO_MESHINPUT_SDF_MAKE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "meshinput/sdf.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef status sdf_make_function(const struct sdf_request *question, struct vdb_sdf **out);
typedef status sdf_from_samples_function(const struct sdf_samples *samples, struct vdb_sdf **out);
typedef void sdf_destroy_function(struct vdb_sdf **sdf);
typedef double sdf_at_function(const struct vdb_sdf *sdf, const double x[3]);
typedef struct sdf_gap sdf_gap_function(const struct vdb_sdf *sdf);
typedef status sdf_caps_function(const struct vdb_sdf *sdf, struct sdf_caps *out);

sdf_make_function sdf_make;
sdf_from_samples_function sdf_from_samples;
sdf_destroy_function sdf_destroy;
sdf_at_function sdf_at;
sdf_gap_function sdf_gap;
sdf_caps_function sdf_caps;

#ifdef __cplusplus
}
#endif
#endif
