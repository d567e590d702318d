/* AWS Deadline Cloud back end: a job bundle, which `deadline bundle submit FOLDER` hands to a queue.
 *
 *     OUT/NAME.bundle/template.json           the OpenJD template (openjd.h)
 *     OUT/NAME.bundle/parameter_values.json   its parameters for this folder and program; retries; the job starts at once
 *     OUT/NAME.bundle/asset_references.json   files the job reads, and the output folder
 */
#ifndef HOODOO_FARM_DEADLINE_H
#define HOODOO_FARM_DEADLINE_H

#include "farm/farm.h"
#include "text/text.h"

struct deadline_bundle {
    struct text template, parameter_values, asset_references; /* JSON */
};

/* deadline_bundle_free(), also after an error. E_USAGE as openjd_template(); E_INPUT: a file the job reads is missing. */
MUST_USE status deadline_bundle(const struct farm *f, const char *device, struct deadline_bundle *out);
void deadline_bundle_free(struct deadline_bundle *bundle);

/* Writes the three files; *folder is the bundle's. */
MUST_USE status deadline_write(const struct farm *f, const struct deadline_bundle *bundle,
                               struct path *folder);

#endif
