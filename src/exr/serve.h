/* OpenEXR files in hoodoo-read: "exr.check" answers without parts, "exr.describe" with a text (reader/describe.h). */
#ifndef HOODOO_EXR_SERVE_H
#define HOODOO_EXR_SERVE_H

#include "reader/serve.h"

MUST_USE status exr_serve_check(const struct serve_question *question, struct serve_answer *answer);
MUST_USE status exr_serve_describe(const struct serve_question *question, struct serve_answer *answer);

#endif
