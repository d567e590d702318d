/* OpenJobDescription back end: a template (jobtemplate-2023-09, with TASK_CHUNKING if there are meshes, AOVs, stills or views) with a
 * step for each block, chunked steps for what is made of frames, and steps for the files of all frames.
 *
 * The template names farm/job.yaml and the output folder as PATH parameters, so that a farm can map both; --path-map maps the files
 * that the job reads. Commands are lists of arguments: nothing that a user wrote reaches a shell or a format string.
 */
#ifndef HOODOO_FARM_OPENJD_H
#define HOODOO_FARM_OPENJD_H

#include "farm/farm.h"
#include "text/text.h"

/* The template, as JSON, after openjd_check(). */
MUST_USE status openjd_template(const struct farm *f, const char *device, struct text *out);

/* Checks a template against the limits and cross-references of the specification (wiki/2023-09-Template-Schemas.md, sections 1 to 6, as far
 * as our templates use it), so that a farm does not refuse it later. E_USAGE names the place, the value and the limit. */
MUST_USE status openjd_check(const char *template, size_t n);

#endif
