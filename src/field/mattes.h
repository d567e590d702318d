/* Cryptomattes of strata and phases: for each pixel which of them its samples met, and how many did
 * (Friedman and Jones, Fully automatic ID mattes with support for motion blur and transparency, 2015; the
 * Cryptomatte specification 1.2). */
#ifndef HOODOO_MATTES_H
#define HOODOO_MATTES_H

#include "base/status.h"
#include "job/job.h"
#include "particles/frame.h"

enum { MATTE_KINDS = 2, MATTE_RANKS = 6, MATTE_CHANNELS = MATTE_KINDS * MATTE_RANKS * 2 };

struct mattes;
MUST_USE status mattes_create(const struct job *job, size_t n_pixels, struct mattes **out);
void mattes_destroy(struct mattes **mattes);

/* One sample of every pixel: ids [n][3] (layer, phase, unused), hit vec4 [n] whose last is negative where
 * nothing was met. */
void mattes_add(struct mattes *m, const uint32_t *ids, const float *hit);

/* MATTE_CHANNELS channels with their planes from `plane` on: CryptoStrata00.R and so on, pairs of an id's
 * float and its share of the samples, the largest first. */
void mattes_channels(const struct mattes *m, int samples, float *plane, struct aov_channel *out);

/* The attributes by which readers find them: name, hash, conversion and the manifest of names. */
MUST_USE status mattes_notes(const struct mattes *m, struct aov_image *out);

/* MurmurHash3_x86_32 of a name, with the bits of an ordinary float, as the specification wants. */
uint32_t matte_id(const char *name);

#endif
