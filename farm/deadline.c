#include "farm/deadline.h"

#include <stdlib.h>

#include "farm/openjd.h"
#include "system/atomic_file.h"

static void put_value(struct text *t, const char *name, const char *value)
{
    json_object(t, NULL);
    json_text(t, "name", name);
    json_text(t, "value", value);
    json_end_object(t);
}

static status put_values(const struct farm *f, struct text *t)
{
    status st = OK;
    struct path job;
    TRY(path_join(&job, f->root.text, "farm/job.yaml"));
    json_object(t, NULL);
    json_array(t, "parameterValues");
    put_value(t, "JobFile", job.text);
    put_value(t, "OutDir", f->root.text);
    put_value(t, "deadline:targetTaskRunStatus", "READY");
    json_object(t, NULL);
    json_text(t, "name", "deadline:maxRetriesPerTask");
    json_integer(t, "value", f->base->farm.retries);
    json_end_object(t);
    json_end_array(t);
    json_end_object(t);
    TRY(text_status(t));
done:
    return st;
}

/* farm/job.yaml is not listed: the PATH parameter JobFile names it. A file that several wedges read is listed once for each;
 * readers take the list as a set. */
static status put_references(const struct farm *f, struct text *t)
{
    status st = OK;
    struct job_input *inputs = NULL;
    size_t n = 0;
    json_object(t, NULL);
    json_object(t, "assetReferences");
    json_object(t, "inputs");
    json_array(t, "filenames");
    for (size_t i = 0; i < f->n_wedges; i++) {
        TRY(job_inputs(f->wedge[i].job, &inputs, &n));
        for (size_t k = 0; k < n; k++)
            json_text(t, NULL, inputs[k].path);
        job_inputs_free(&inputs, n);
    }
    json_end_array(t);
    json_array(t, "directories");
    json_end_array(t);
    json_end_object(t);
    json_object(t, "outputs");
    json_array(t, "directories");
    json_text(t, NULL, f->root.text);
    json_end_array(t);
    json_end_object(t);
    json_array(t, "referencedPaths");
    json_end_array(t);
    json_end_object(t);
    json_end_object(t);
    TRY(text_status(t));
done:
    job_inputs_free(&inputs, n);
    return st;
}

status deadline_bundle(const struct farm *f, const char *device, struct deadline_bundle *out)
{
    status st = OK;
    *out = (struct deadline_bundle){0};
    TRY(openjd_template(f, device, &out->template));
    TRY(put_values(f, &out->parameter_values));
    TRY(put_references(f, &out->asset_references));
done:
    return st;
}

void deadline_bundle_free(struct deadline_bundle *b)
{
    text_free(&b->template);
    text_free(&b->parameter_values);
    text_free(&b->asset_references);
}

status deadline_write(const struct farm *f, const struct deadline_bundle *b, struct path *folder)
{
    status st = OK;
    struct path path;
    const struct {
        const char *name;
        const struct text *text;
    } files[] = {{"template.json", &b->template},
                 {"parameter_values.json", &b->parameter_values},
                 {"asset_references.json", &b->asset_references}};
    TRY(path_format(folder, "%s/%s.bundle", f->root.text, f->base->name));
    TRY(folder_make(folder->text));
    atomic_file_sweep(folder->text);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        TRY(path_join(&path, folder->text, files[i].name));
        TRY(atomic_file_write(path.text, files[i].text->data, files[i].text->size));
    }
done:
    return st;
}
