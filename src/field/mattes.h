/* Cryptomattes of strata and phases: the ids that the samples of each pixel have hit, with their coverage (Friedman and Jones, Fully
 * Automatic ID Mattes with Support for Motion Blur and Transparency, SIGGRAPH 2015; Cryptomatte specification 1.2). */
#ifndef HOODOO_MATTES_H
#define HOODOO_MATTES_H

#include "base/status.h"
#include "job/job.h"
#include "particles/frame.h"

enum { MATTE_KINDS = 2, MATTE_RANKS = 6, MATTE_CHANNELS = MATTE_KINDS * MATTE_RANKS * 2 };

struct mattes;
MUST_USE status mattes_create(const struct job *job, size_t n_pixels, struct mattes **out);
void mattes_destroy(struct mattes **mattes);

/* Adds one sample of each pixel: ids[n][3] (layer, phase, unused), hit vec4 [n], w negative where the ray hit nothing. */
void mattes_add(struct mattes *m, const uint32_t *ids, const float *hit);

/* Sets MATTE_CHANNELS channels and their planes, which start at `plane`: CryptoStrata00.R and so on, pairs of an id as float and its share of
 * the samples, the largest share first. */
void mattes_channels(const struct mattes *m, int samples, float *plane, struct aov_channel *out);

/* Adds the attributes of the specification: name, hash, conversion and the manifest of names. */
MUST_USE status mattes_notes(const struct mattes *m, struct aov_image *out);

/* MurmurHash3_x86_32 of a name, changed to the bits of a normal float as the specification demands. */
uint32_t matte_id(const char *name);

#endif
