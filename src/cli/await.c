#include "cli/await.h"

#include <unistd.h>

#include "base/clock.h"
#include "base/log.h"
#include "base/visible.h"
#include "cli/cli.h"
#include "farm/graph.h"
#include "output/folder.h"
#include "system/signals.h"

static void await(bool (*ready)(const void *user), const void *user, const char *where, const char *what)
{
    const double until = clock_seconds() + visible_delay();
    for (bool said = false; !ready(user); said = true) {
        if (clock_seconds() >= until || stop_requested())
            return;
        if (!said)
            log_info("%s: not all %s are there yet; looking again for %.0f s", where, what, visible_delay());
        usleep(500000);
    }
}

struct frames_wanted {
    const char *root;
    struct frame_range frames; /* step 0: the job's last frame */
};

static bool has_frame(const char *root, const char *name, int frame)
{
    struct manifest m = {0};
    const char *bad = "";
    const bool there =
        manifest_read(root, name, frame, &m) == OK && manifest_check(root, &m, false, &bad) == OK && !*bad;
    manifest_free(&m);
    return there;
}

static bool has_frames(const void *user)
{
    const struct frames_wanted *w = user;
    struct frame_range job, wanted = w->frames;
    char name[256];
    if (folder_open(w->root, name) != OK || job_frames(w->root, &job) != OK)
        return false;
    if (!wanted.step)
        wanted = (struct frame_range){job.last, job.last, 1};
    for (int frame = job.first; frame <= job.last; frame += job.step)
        if (range_holds(wanted, frame) && !has_frame(w->root, name, frame))
            return false;
    return true;
}

status frames_folder(const char *root, struct frame_range frames, char name[256])
{
    const struct frames_wanted wanted = {root, frames};
    if (visible_delay() > 0)
        await(has_frames, &wanted, root, "frames");
    return folder_open(root, name);
}

/* The stills that the job's farm makes, of which the sheet's task is to show all. */
static bool has_stills(const void *user)
{
    const struct preview *p = user;
    const struct frame_range all = p->job->frames;
    struct path path;
    for (int frame = all.first; frame <= all.last; frame += all.step)
        if (graph_has_still(p->job, frame) &&
            (picture_still_path(p, frame, &path) != OK || path_join(&path, p->root, path.text) != OK ||
             access(path.text, R_OK) != 0))
            return false;
    return true;
}

void await_stills(const struct preview *p)
{
    await(has_stills, p, p->root, "stills");
}

struct views_wanted {
    const struct preview *preview;
    int frame, views;
};

static bool has_views(const void *user)
{
    const struct views_wanted *w = user;
    struct path path;
    for (int view = 0; view < w->views; view++)
        if (picture_view_path(w->preview, w->frame, view, &path) != OK ||
            path_join(&path, w->preview->root, path.text) != OK || access(path.text, R_OK) != 0)
            return false;
    return true;
}

void await_views(const struct preview *p, int frame, int views)
{
    await(has_views, &(struct views_wanted){p, frame, views}, p->root, "views");
}

struct wedges_wanted {
    const char *root;
    const struct job *const *wedge;
    size_t n;
};

static bool has_all_wedges(const void *user)
{
    const struct wedges_wanted *w = user;
    struct path root, path;
    char number[FRAME_TEXT];
    for (size_t i = 0; i < w->n; i++) {
        const struct job *job = w->wedge[i];
        if (path_join(&root, w->root, wedge_text((int)job->wedge.index, number)) != OK ||
            folder_path(&path, root.text, job->name, FILE_STILL, job->frames.last, NULL) != OK ||
            access(path.text, R_OK) != 0)
            return false;
    }
    return true;
}

void await_wedges(const char *root, const struct job *const *wedge, size_t n)
{
    await(has_all_wedges, &(struct wedges_wanted){root, wedge, n}, root, "stills of the wedges");
}
