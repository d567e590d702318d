/* hoodoo verify OUT: checks every file against its manifest or record and with the reader of its format. Succeeds only if every
 * frame of the job (or of --frames) exists and is undamaged, and so are all products made from them; of a job with wedges, in every
 * wedge. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/log.h"
#include "base/memory.h"
#include "checkpoint/checkpoint.h"
#include "cli/answer.h"
#include "cli/cli.h"
#include "cli/verify.h"
#include "exr/exr.h"
#include "farm/farm.h"
#include "farm/status.h"
#include "run/branch.h"
#include "run/owner.h"
#include "vdb/vdb.h"

static void print_line(const char *line)
{
    /* Paths come from files of unknown origin, and farm managers interpret lines of stdout as commands. */
    for (const char *c = line; *c; c++)
        putchar((unsigned char)*c < 0x20 || *c == 0x7f ? ' ' : *c);
    putchar('\n');
    fflush(stdout);
}

void report_problem(struct search *s, bool missing, const char *path, const char *what)
{
    struct verdict *v = s->verdict;
    *(missing ? &v->n_missing : &v->n_damaged) += 1;
    s->n_problems++;
    const char *kind = missing ? "missing" : "damaged";
    /* Messages of the readers begin with the full path, which is redundant here. */
    size_t root = strlen(s->root), relative = strlen(path);
    if (strncmp(what, s->root, root) == 0 && what[root] == '/' &&
        strncmp(what + root + 1, path, relative) == 0 && strncmp(what + root + 1 + relative, ": ", 2) == 0)
        what += root + relative + 3;
    char line[1400];
    if (v->json) {
        snprintf(line, sizeof line, "%s%s", s->prefix, path);
        json_object(&v->answer, NULL);
        json_text(&v->answer, "kind", kind);
        json_text(&v->answer, "file", line);
        json_text(&v->answer, "what", what);
        json_end_object(&v->answer);
        return;
    }
    snprintf(line, sizeof line, "%s %s%s%s%s", kind, s->prefix, path, *what ? ": " : "", what);
    print_line(line);
}

static bool ends_with(const char *path, const char *end)
{
    size_t n = strlen(path), m = strlen(end);
    return n >= m && strcmp(path + n - m, end) == 0;
}

/* Only E_MEMORY ends the search; all other errors are reported as problems of the file. */
static status verify_file(struct search *s, const struct manifest_file *f)
{
    struct path path;
    char what[256] = "";
    uint64_t hash, size;
    status st = OK;
    s->verdict->n_files++;
    if ((st = path_join(&path, s->root, f->path)) != OK)
        return st;
    if (access(path.text, F_OK) != 0) {
        report_problem(s, true, f->path, "");
        return OK;
    }
    st = hash_file(path.text, &hash, &size);
    if (st == OK && size != f->size)
        snprintf(what, sizeof what, "%llu bytes; the manifest has %llu", (unsigned long long)size,
                 (unsigned long long)f->size);
    else if (st == OK && hash != f->hash)
        snprintf(what, sizeof what, "the content's hash differs from the manifest's");
    else if (st == OK && ends_with(path.text, ".vdb"))
        st = vdb_check(path.text);
    else if (st == OK && ends_with(path.text, ".exr"))
        st = exr_check(path.text);
    if (st == E_MEMORY)
        return st;
    if (st != OK || *what)
        report_problem(s, false, f->path, *what ? what : status_message());
    return OK;
}

static status verify_frame(struct search *s, int frame)
{
    struct manifest m = {0};
    struct path path;
    const char *relative = path.text + strlen(s->root) + 1;
    status st = OK;
    TRY(folder_path(&path, s->root, s->name, FILE_MANIFEST, frame, NULL));
    s->verdict->n_files++;
    if (access(path.text, F_OK) != 0) {
        report_problem(s, true, relative, "the frame is not complete");
        goto done;
    }
    s->verdict->n_frames++;
    st = manifest_read(s->root, s->name, frame, &m);
    if (st == E_MEMORY)
        goto done;
    if (st != OK || m.frame != frame) {
        report_problem(s, false, relative, st != OK ? status_message() : "it belongs to another frame");
        st = OK;
        goto done;
    }
    if (s->states.n && !job_states_hold(&s->states, frame, m.job_hash))
        report_problem(s, false, relative, "it belongs to another job");
    else if (s->files_hash && m.files_hash != s->files_hash)
        report_problem(
            s, false, relative,
            "it was written with settings of output, cameras, fps or colours that differ from job.yaml");
    const struct ledger *l = &m.ledger;
    if (l->start != l->rock + l->deposit + l->fallen + l->left)
        report_problem(s, false, relative, "its ledger does not add up");
    TRY(memory_grow(&s->sound, &s->sound_capacity, s->n_sound + 1, sizeof *s->sound, "the frames"));
    s->sound[s->n_sound++] = frame;
    for (size_t i = 0; i < m.n_files; i++) {
        TRY(product_list_add(&s->listed, m.file[i].path));
        TRY(verify_file(s, &m.file[i]));
    }
done:
    manifest_free(&m);
    return st;
}

/* Checks that job.yaml is the job of the frames, and takes from it the frames to expect unless --frames gives them. The job
 * cannot be compared if its input files are not available. */
static status verify_job(struct search *s)
{
    status st = OK;
    struct path path;
    struct job *job = NULL;
    bool edited;
    char why[600];
    TRY(path_join(&path, s->root, "job.yaml"));
    st = job_load(path.text, NULL, 0, &job);
    if (st != OK && st != E_MEMORY) {
        report_problem(s, false, "job.yaml", status_message());
        s->bad_job = true;
        st = OK;
        goto done;
    }
    TRY(st);
    if (!s->only_frames)
        s->frames = job->frames;
    TRY(job_files_hash(job, &s->files_hash));
    TRY(owner_states(s->root, &s->states, &edited, why));
    if (edited) {
        report_problem(s, false, "job.yaml", "it is not the job of the frames");
        s->bad_job = true;
    } else if (*why) {
        log_info("%s", why);
    }
done:
    job_destroy(&job);
    return st;
}

/* Checks every expected frame, and frames outside the job's range, as left by a job whose range was shortened. */
static status verify_frames(struct search *s)
{
    status st = OK;
    int *there = NULL;
    size_t n = 0;
    for (size_t i = 0; s->frames.step && i < range_count(s->frames); i++)
        TRY(verify_frame(s, s->frames.first + (int)i * s->frames.step));
    if (!s->only_frames)
        TRY(folder_frames(s->root, s->name, &there, &n));
    for (size_t i = 0; i < n; i++)
        if (!s->frames.step || !range_holds(s->frames, there[i]))
            TRY(verify_frame(s, there[i]));
done:
    free(there);
    return st;
}

static status verify_checkpoint(struct search *s, const char *path, const int *frame)
{
    struct checkpoint c;
    status st = checkpoint_read_index(path, &c);
    s->verdict->n_files++;
    s->verdict->n_checkpoints++;
    if (st == E_MEMORY)
        return st;
    if (st == OK && (!frame || c.frame == *frame))
        return OK;
    s->n_bad_checkpoints++;
    report_problem(s, false, path + strlen(s->root) + 1,
                   st != OK ? status_message() : "it belongs to another frame");
    return OK;
}

/* Checks all checkpoints, including the copy that a branch started from. */
static status verify_checkpoints(struct search *s)
{
    status st = OK;
    int *frames = NULL;
    size_t n;
    struct path path;
    TRY(checkpoint_list(s->root, s->name, &frames, &n));
    for (size_t i = 0; i < n; i++) {
        TRY(folder_path(&path, s->root, s->name, FILE_CHECKPOINT, frames[i], NULL));
        TRY(verify_checkpoint(s, path.text, &frames[i]));
    }
    TRY(branch_copy_path(&path, s->root, s->name));
    if (access(path.text, F_OK) == 0)
        TRY(verify_checkpoint(s, path.text, NULL));
done:
    free(frames);
    return st;
}

/* Searches one output folder. */
static status verify_folder(struct search *s)
{
    status st = OK;
    TRY(verify_job(s));
    TRY(verify_frames(s));
    if (!s->only_frames)
        TRY(verify_checkpoints(s));
    TRY(verify_products(s));
    TRY(remake_commands(s));
done:
    search_free(s);
    return st;
}

/* Searches the folder of each wedge, and the farm's own, which has products of all wedges. */
static status verify_farm(struct verdict *v, const char *root, struct frame_range frames)
{
    status st = OK;
    struct farm farm = {0};
    struct search own = {.verdict = v, .root = root, .prefix = "", .only_frames = frames.step > 0};
    TRY(farm_open(root, &farm));
    for (size_t i = 0; i < farm.n_wedges; i++) {
        struct path folder, prefix;
        struct search s = {.verdict = v,
                           .farm = root,
                           .wedge = (int)farm.wedge[i].job->wedge.index,
                           .frames = frames,
                           .only_frames = frames.step > 0};
        TRY(farm_root(&farm, s.wedge, &folder));
        TRY(path_format(&prefix, "%s/", path_last(folder.text)));
        s.root = folder.text;
        s.prefix = prefix.text;
        st = folder_open(s.root, s.name);
        if (st == E_MEMORY)
            goto done;
        if (st == OK) {
            TRY(verify_folder(&s));
            continue;
        }
        const char *what = status_message();
        TRY(path_join(&folder, s.root, "run.json"));
        report_problem(&s, access(folder.text, F_OK) != 0, "run.json", what);
        st = remake_commands(&s);
        search_free(&s);
        TRY(st);
    }
    if (!own.only_frames) {
        snprintf(own.name, sizeof own.name, "%s", farm.base->name);
        TRY(verify_products(&own));
        TRY(remake_commands(&own));
    }
done:
    search_free(&own);
    farm_free(&farm);
    return st;
}

/* ---- the answer */

/* `"hoodoo run" and then "hoodoo mesh OUT --missing"` */
static status sentence_of(const struct text *commands, struct text *out)
{
    for (const char *line = commands->data; line && *line;) {
        const size_t n = strcspn(line, "\n");
        text_add(out, "%s\"%.*s\"", out->size ? " and then " : "", (int)n, line);
        line += n + (line[n] == '\n');
    }
    return text_status(out);
}

static status list_of(const struct text *commands, struct text *json)
{
    status st = OK;
    struct text one = {0};
    json_array(json, "commands");
    for (const char *line = commands->data; line && *line;) {
        const size_t n = strcspn(line, "\n");
        text_add(&one, "%.*s", (int)n, line);
        TRY(text_status(&one));
        json_text(json, NULL, one.data);
        text_free(&one);
        line += n + (line[n] == '\n');
    }
    json_end_array(json);
done:
    text_free(&one);
    return st;
}

static status report(struct verdict *v, const char *root)
{
    status st = OK;
    struct text how = {0};
    TRY(text_status(&v->commands));
    if (v->json) {
        json_end_array(&v->answer);
        TRY(list_of(&v->commands, &v->answer));
        json_text(&v->answer, "checked", "contents");
        json_integer(&v->answer, "frames", (int64_t)v->n_frames);
        json_integer(&v->answer, "files", (int64_t)v->n_files);
        json_integer(&v->answer, "products", (int64_t)v->n_products);
        json_integer(&v->answer, "checkpoints", (int64_t)v->n_checkpoints);
        json_integer(&v->answer, "damaged", (int64_t)v->n_damaged);
        json_integer(&v->answer, "missing", (int64_t)v->n_missing);
        json_end_object(&v->answer);
        TRY(answer_print(&v->answer, true));
    } else {
        char line[200];
        snprintf(
            line, sizeof line,
            "%zu frames, %zu files, %zu products, %zu checkpoints, whose contents were read: %zu damaged, %zu missing",
            v->n_frames, v->n_files, v->n_products, v->n_checkpoints, v->n_damaged, v->n_missing);
        print_line(line);
    }
    TRY(sentence_of(&v->commands, &how));
    if (v->n_damaged + v->n_missing)
        st = fail(E_INPUT, "%s: %zu of %zu files damaged, %zu missing%s%s", root, v->n_damaged, v->n_files,
                  v->n_missing, how.size ? "; to make them again, run " : "", how.size ? how.data : "");
done:
    text_free(&how);
    return st;
}

status cli_verify(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct arguments operands = {0};
    struct verdict v = {0};
    bool help;
    const struct option options[] = {OPTION_FRAMES(&c), OPTION_JSON(&c)};
    TRY(options_parse(&usage_verify, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    const char *root = operands.item[0];
    bool wedges = false;
    TRY(farm_has_wedges(root, &wedges));
    struct search s = {
        .verdict = &v, .root = root, .prefix = "", .frames = c.frames, .only_frames = c.frames.step > 0};
    v.json = c.json;
    if (!wedges)
        TRY(folder_open(root, s.name));
    if (v.json) {
        answer_begin(&v.answer);
        json_text(&v.answer, "folder", root);
        if (!wedges)
            json_text(&v.answer, "name", s.name);
        json_array(&v.answer, "problems");
    }
    TRY(wedges ? verify_farm(&v, root, c.frames) : verify_folder(&s));
    TRY(report(&v, root));
done:
    text_free(&v.answer);
    text_free(&v.commands);
    arguments_free(&operands);
    return st;
}
