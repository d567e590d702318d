/* The farm that speaks OpenJobDescription: a template (jobtemplate-2023-09, with TASK_CHUNKING where there are
 * meshes or stills) of a step per block, chunked steps for meshes and stills, and the finishes.
 *
 * The template stands in the job's output folder and names farm/job.yaml and the folder itself as PATH
 * parameters, so that a farm maps both; --path-map maps what the job itself reads. What it runs is a list of
 * words: nothing a user wrote reaches a shell, or a format string.
 */
#ifndef HOODOO_FARM_OPENJD_H
#define HOODOO_FARM_OPENJD_H

#include "base/text.h"
#include "farm/farm.h"

/* The template, as JSON. */
MUST_USE status openjd_template(const struct farm *f, const char *device, struct text *out);

#endif
