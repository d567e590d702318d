#include "run/branch.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/log.h"
#include "base/memory.h"
#include "model/resample.h"
#include "output/folder.h"
#include "system/atomic_file.h"

status branch_copy_path(struct path *out, const char *root, const char *name)
{
    return path_format(out, "%s/checkpoint/%s.from.ckpt", root, name);
}

static status set_from(struct job *job, const char *path)
{
    char *text = NULL;
    status st = memory_strdup(path, &text);
    if (st != OK)
        return st;
    free(job->from);
    job->from = text;
    return OK;
}

/* ---- --from */

/* Splits "out/arch@1040" at the last @. */
static status parse_from(const char *text, struct path *out, int *frame)
{
    const char *at = strrchr(text, '@');
    char *end = NULL;
    errno = 0;
    long number = at ? strtol(at + 1, &end, 10) : 0;
    if (!at || at == text || end == at + 1 || *end || errno || number < -999999 || number > 9999999 ||
        strspn(at + 1, "-0123456789") != strlen(at + 1))
        return fail(E_USAGE, "--from %.200s: write OUT@FRAME, such as out/arch@1040", text);
    *frame = (int)number;
    if (path_format(out, "%.*s", (int)(at - text), text) != OK)
        return fail(E_USAGE, "--from %s", status_message());
    return OK;
}

static status fail_no_checkpoint(const char *out, const char *name, int frame)
{
    status st = OK;
    int *frames = NULL;
    size_t n = 0, used = 0;
    char list[400] = "";
    TRY(checkpoint_list(out, name, &frames, &n));
    for (size_t i = n; i-- > 0 && used < sizeof list - 40;)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%d", used ? ", " : "", frames[i]);
    st = fail(
        E_CHECKPOINT,
        "%s has no checkpoint of frame %d (%s%s); to get one, run its job again with checkpoint.mark: [%d]",
        out, frame, n ? "its checkpoints are of frames " : "it has no checkpoints", list, frame);
done:
    free(frames);
    return st;
}

/* Whether the branch's own folder has a copy of that frame's checkpoint. */
static bool own_copy(const struct job *job, const char *root, int frame, struct path *path)
{
    struct checkpoint c;
    return branch_copy_path(path, root, job->name) == OK && access(path->text, F_OK) == 0 &&
           checkpoint_read_index(path->text, &c) == OK && c.frame == frame;
}

status branch_from(struct job *job, const char *text, const char *root)
{
    status st = OK;
    struct path out, path;
    char name[256], *whole = NULL;
    int frame = 0;
    TRY(parse_from(text, &out, &frame));
    st = folder_open(out.text, name);
    if (st == OK)
        st = folder_path(&path, out.text, name, FILE_CHECKPOINT, frame, NULL);
    if (st == OK && access(path.text, F_OK) != 0)
        st = fail_no_checkpoint(out.text, name, frame);
    if (st == E_MEMORY)
        return st;
    if (st != OK) {
        char message[1024];
        snprintf(message, sizeof message, "%s", status_message());
        if (!own_copy(job, root, frame, &path))
            return fail(st, "--from %.200s: %s", text, message);
        log_info("%s; using this folder's own copy of that checkpoint", message);
    }
    whole = realpath(path.text, NULL);
    if (!whole)
        return fail(E_INPUT, "--from %.200s: %s: %s", text, path.text, strerror(errno));
    TRY(set_from(job, whole));
done:
    free(whole);
    return st;
}

/* ---- the key */

static void set_first_frame(struct job *job, int frame)
{
    job->frames.first = frame;
    for (size_t i = 0; i < job->n_edits; i++)
        if (job->edits[i].set.job)
            job->edits[i].set.job->frames = job->frames;
}

status branch_prepare(struct job *job, const char *root)
{
    status st = OK;
    struct path path;
    char frames[48];
    struct checkpoint c;
    if (!*job->from)
        return OK;
    if (access(job->from, F_OK) != 0) {
        TRY(branch_copy_path(&path, root, job->name));
        if (access(path.text, F_OK) == 0)
            TRY(set_from(job, path.text));
    }
    TRY(checkpoint_read_index(job->from, &c));
    if (!range_holds(job->frames, c.frame)) {
        st = fail(
            E_USAGE,
            "%s is the checkpoint of frame %d, but the job's frames are %s; set frames to begin at %d or before",
            job->from, c.frame, range_text(job->frames, frames), c.frame);
        goto done;
    }
    set_first_frame(job, c.frame);
    for (size_t i = 0; i < job->n_edits; i++) {
        const struct job_edit *e = &job->edits[i];
        if (e->frame == c.frame && (e->carve || e->n_add || e->n_paint))
            log_info(
                "edit %zu of frame %d is not applied, because the branch starts from that frame's checkpoint; to apply it, move it to frame %d",
                i, c.frame, c.frame + 1);
    }
done:
    return st;
}

status branch_prepare_own(struct job *job, const char *root)
{
    status st = OK;
    struct path path;
    if (!*job->from)
        return OK;
    TRY(branch_copy_path(&path, root, job->name));
    if (access(path.text, F_OK) == 0)
        TRY(set_from(job, path.text));
done:
    return st;
}

status branch_load(const struct job *job, struct branch_state *out)
{
    status st = OK;
    *out = (struct branch_state){0};
    TRY(checkpoint_read(job->from, &out->at));
    TRY(model_resample(job, &out->at, &out->spacing_m));
done:
    if (st != OK)
        checkpoint_free(&out->at);
    return st;
}

status branch_read(const struct job *job, const char *root, struct branch_state *out)
{
    status st = OK;
    struct path path;
    char *bytes = NULL;
    size_t n;
    TRY(branch_load(job, out));
    TRY(branch_copy_path(&path, root, job->name));
    if (strcmp(path.text, job->from) != 0) {
        TRY(file_read(job->from, (size_t)1 << 40, &bytes, &n));
        TRY(atomic_file_write(path.text, bytes, n));
    }
done:
    free(bytes);
    if (st != OK)
        checkpoint_free(&out->at);
    return st;
}
