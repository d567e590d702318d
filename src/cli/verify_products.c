/* Checks products against their records, and collects the commands that make damaged ones again. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "cli/cli.h"
#include "cli/verify.h"

/* ---- commands */

static status add_remake(struct search *s, size_t n, const char *const *word, struct remake **out)
{
    status st = OK;
    TRY(memory_grow(&s->remake, &s->remake_capacity, s->n_remakes + 1, sizeof *s->remake, "the commands"));
    struct remake *r = &s->remake[s->n_remakes];
    *r = (struct remake){.first = ALL_FRAMES, .last = ALL_FRAMES};
    TRY(memory_alloc(n, sizeof *r->word, "the commands", &r->word));
    s->n_remakes++;
    for (; r->n_words < n; r->n_words++)
        if (!(r->word[r->n_words] = strdup(word[r->n_words]))) {
            st = fail(E_MEMORY, "no memory for the commands");
            goto done;
        }
    *out = r;
done:
    return st;
}

void search_free(struct search *s)
{
    for (size_t i = 0; i < s->n_remakes; i++) {
        for (size_t k = 0; k < s->remake[i].n_words; k++)
            free(s->remake[i].word[k]);
        free(s->remake[i].word);
    }
    free(s->remake);
    free(s->sound);
    product_list_free(&s->listed);
    job_states_free(&s->states);
    s->remake = NULL;
    s->sound = NULL;
    s->n_remakes = s->n_sound = 0;
}

static bool same_command(const struct remake *r, size_t n, const char *const *word, bool framed)
{
    bool same = r->n_words == n && framed == (r->first != ALL_FRAMES);
    for (size_t i = 0; same && i < n; i++)
        same = strcmp(r->word[i], word[i]) == 0;
    return same;
}

static bool is_run(const char *verb)
{
    return strcmp(verb, "run") == 0;
}

/* Adds the command that makes the product `path` of a frame, or of ALL_FRAMES. `run` is left to remake_run(). */
static status add_product_command(struct search *s, size_t n, const char *const *word, int frame,
                                  const char *path)
{
    status st = OK;
    struct remake *r = NULL;
    if (is_run(word[0]))
        return OK;
    s->n_others++;
    for (size_t i = 0; i < s->n_remakes && !r; i++)
        if (same_command(&s->remake[i], n, word, frame != ALL_FRAMES))
            r = &s->remake[i];
    if (!r) {
        TRY(add_remake(s, n, word, &r));
        r->first = r->last = frame;
        r->late = !strchr(path, '/') || strcmp(word[0], "report") == 0;
    }
    r->first = frame < r->first ? frame : r->first;
    r->last = frame > r->last ? frame : r->last;
done:
    return st;
}

/* The run makes the other problems' files. */
static status remake_run(struct search *s)
{
    static const char *const command[] = {"run", "--repair"};
    status st = OK;
    struct remake *r = NULL;
    if (s->n_problems > s->n_others)
        TRY(add_remake(s, s->n_bad_checkpoints ? 2 : 1, command, &r));
done:
    return st;
}

/* Order of the commands: run first, since the others read frames; sheets and videos after pictures; reports last. */
static int rank(const struct remake *r)
{
    return is_run(r->word[0]) ? 0 : !r->late ? 1 : strcmp(r->word[0], "report") != 0 ? 2 : 3;
}

/* Adds a word, quoted for a shell if necessary. */
static void add_word(struct text *t, const char *word)
{
    if (*word && strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@") ==
                     strlen(word)) {
        text_add(t, " %s", word);
        return;
    }
    text_add(t, " '");
    for (const char *c = word; *c; c++)
        text_add(t, *c == '\'' ? "'\\''" : "%c", *c);
    text_add(t, "'");
}

static void add_command(const struct search *s, const struct remake *r, struct text *t)
{
    char frames[48], words[PATH_BYTES + 64];
    text_add(t, "hoodoo");
    add_word(t, r->word[0]);
    if (!is_run(r->word[0])) { /* which takes a job */
        add_word(t, s->root);
    } else if (s->farm) {
        snprintf(words, sizeof words, "%s/farm/job.yaml", s->farm);
        add_word(t, words);
        snprintf(words, sizeof words, "--farm=%s", s->farm);
        add_word(t, words);
        text_add(t, " --wedge=%d", s->wedge);
    }
    for (size_t i = 1; i < r->n_words; i++)
        add_word(t, r->word[i]);
    if (r->first != ALL_FRAMES)
        text_add(t, " --frames=%s", range_text((struct frame_range){r->first, r->last, 1}, frames));
}

status remake_commands(struct search *s)
{
    status st = OK;
    TRY(remake_run(s));
    for (int k = 0; k <= 3; k++)
        for (size_t i = 0; i < s->n_remakes; i++)
            if (rank(&s->remake[i]) == k) {
                add_command(s, &s->remake[i], &s->verdict->commands);
                text_add(&s->verdict->commands, "\n");
            }
    TRY(text_status(&s->verdict->commands));
done:
    return st;
}

/* ---- products with a damaged record: the command is taken from a similar product, or guessed */

/* Whether two paths differ in numbers only. */
static bool differ_in_numbers_only(const char *a, const char *b)
{
    static const char digits[] = "0123456789";
    for (;;) {
        a += strspn(a, digits);
        b += strspn(b, digits);
        if (*a != *b)
            return false;
        if (!*a)
            return true;
        a++;
        b++;
    }
}

/* NAME.[PART.]FRAME.ENDING, or ALL_FRAMES. */
static int frame_in(const char *path)
{
    int frame;
    for (const char *dot = strchr(path_last(path), '.'); dot; dot = strchr(dot + 1, '.')) {
        const size_t n = strcspn(dot + 1, ".");
        if (dot[1 + n] == '.' && frame_parse(dot + 1, n, &frame))
            return frame;
    }
    return ALL_FRAMES;
}

static status guess_command(struct search *s, const struct product_list *all, const char *path)
{
    static const struct {
        const char *begin;
        size_t n;
        const char *word[3];
    } guess[] = {{"mesh/", 2, {"mesh", "--missing"}},
                 {"aov/", 2, {"aov", "--missing"}},
                 {"preview/", 2, {"preview", "--only=stills"}},
                 {"turntable/", 3, {"preview", "--only=views", "--turntable"}},
                 {"report/", 1, {"report"}}};
    static const struct {
        const char *ending, *word[2];
    } of_all[] = {{".wedges.png", {"preview", "--only=wedges"}},
                  {".png", {"preview", "--only=sheet"}},
                  {".mp4", {"preview", "--only=video"}}};
    status st = OK;
    struct product p = {0};
    const int frame = frame_in(path);
    bool known = false;
    for (size_t i = 0; i < all->n && !known; i++) {
        if (strcmp(all->path[i], path) == 0 || !differ_in_numbers_only(all->path[i], path))
            continue;
        product_free(&p);
        st = product_read(s->root, all->path[i], &p);
        known = st == OK && p.n_words > 0;
        if (st == E_MEMORY)
            goto done;
    }
    st = OK;
    if (known) {
        TRY(add_product_command(s, p.n_words, p.word, p.frame == ALL_FRAMES ? ALL_FRAMES : frame, path));
        goto done;
    }
    for (size_t i = 0; i < sizeof guess / sizeof *guess; i++)
        if (strncmp(path, guess[i].begin, strlen(guess[i].begin)) == 0) {
            return add_product_command(s, guess[i].n, guess[i].word,
                                       strcmp(guess[i].begin, "report/") == 0 ? ALL_FRAMES : frame, path);
        }
    for (size_t i = 0; i < sizeof of_all / sizeof *of_all; i++)
        if (strstr(path, of_all[i].ending))
            return add_product_command(s, 2, of_all[i].word, ALL_FRAMES, path);
done:
    product_free(&p);
    return st;
}

/* ---- each */

static status verify_product(struct search *s, const struct product_list *all, const char *path)
{
    struct product p;
    struct path full, record;
    status st = product_read(s->root, path, &p);
    if (st == E_MEMORY)
        return st;
    s->verdict->n_files++;
    s->verdict->n_products++;
    if (st != OK || p.n_words == 0) {
        char why[600];
        snprintf(why, sizeof why, "%s", st != OK ? status_message() : "the record names no command");
        TRY(product_record(&record, path));
        report_problem(s, false, record.text, why);
        TRY(guess_command(s, all, path));
        goto done;
    }
    if (s->only_frames && (p.frame == ALL_FRAMES || !range_holds(s->frames, p.frame)))
        goto done;
    st = product_check(s->root, s->name, &p, true);
    if (st == E_MEMORY || st == OK)
        goto done;
    if (s->bad_job && strcmp(path, "job.yaml") == 0) {
        st = OK;
        goto done;
    }
    char why[600];
    snprintf(why, sizeof why, "%s", status_message());
    TRY(path_join(&full, s->root, path));
    const bool missing = access(full.text, F_OK) != 0;
    report_problem(s, missing, path, missing ? "" : why);
    TRY(add_product_command(s, p.n_words, p.word, p.frame, path));
done:
    product_free(&p);
    return st;
}

/* ---- files that nothing lists */

static int in_order(const void *a, const void *b)
{
    return strcmp(a, b);
}

static bool has(const struct product_list *sorted, const char *path)
{
    return sorted->n && bsearch(path, sorted->path, sorted->n, sizeof *sorted->path, in_order);
}

static int by_number(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

static bool is_sound(const struct search *s, int frame)
{
    return s->n_sound && bsearch(&frame, s->sound, s->n_sound, sizeof frame, by_number);
}

/* Files with the job's name and an ending that hoodoo writes, and in report/ its pictures and page. Other files are the user's own. */
static bool is_ours(const struct search *s, const char *folder, const char *file)
{
    static const char *const endings[] = {".usda", ".png",  ".mp4", /* beside the folders only these */
                                          ".vdb",  ".usdc", ".exr", ".stacks", ".voxels",
                                          ".ply",  ".obj",  ".mtl", ".pov"};
    const size_t n = strlen(s->name), n_endings = *folder ? sizeof endings / sizeof *endings : 3;
    const char *dot = strrchr(file, '.');
    if (strcmp(folder, "report/") == 0)
        return strcmp(file, "index.html") == 0 ||
               (dot && strcmp(dot, ".jpg") == 0 &&
                (frame_in(file) != ALL_FRAMES || strncmp(file, "view.", 5) == 0));
    if (!dot || strncmp(file, s->name, n) != 0 || file[n] != '.')
        return false;
    for (size_t i = 0; i < n_endings; i++)
        if (strcmp(dot, endings[i]) == 0)
            return true;
    return false;
}

/* The folders of the files that hoodoo writes; the first ones hold files of frames only, which manifests list. */
enum { FRAME_FOLDERS = 6 };
static const char *const stray_folders[] = {"points/",  "volumes/",   "wind/",   "stacks/",
                                            "voxels/",  "rocks/",     "aov/",    "mesh/",
                                            "preview/", "turntable/", "report/", ""};

/* Frames of the job without a sound manifest are reported already, and are made again with all their files. */
static bool is_stray(const struct search *s, int frame)
{
    if (frame == ALL_FRAMES)
        return !s->only_frames;
    if (s->frames.step && !range_holds(s->frames, frame))
        return !s->only_frames;
    return is_sound(s, frame);
}

static status report_stray(struct search *s, const struct product_list *records, size_t folder,
                           const char *path)
{
    const int frame = frame_in(path);
    const bool outside = frame != ALL_FRAMES && s->frames.step && !range_holds(s->frames, frame);
    s->verdict->n_files++;
    report_problem(
        s, false, path,
        outside
            ? "the job has no such frame, and nothing tells whether the file is whole; an earlier run may have left it"
            : "neither a record nor a manifest lists it, so nothing tells whether it is whole; an earlier run may have left it");
    if (!outside && folder >= FRAME_FOLDERS)
        return guess_command(s, records, path);
    s->n_others++; /* to be deleted */
    return OK;
}

static status verify_strays(struct search *s, const struct product_list *records, size_t folder)
{
    status st = OK;
    const char *name = stray_folders[folder];
    struct path full, below;
    struct product_list strays = {0};
    TRY(path_join(&full, s->root, name));
    DIR *d = opendir(full.text);
    if (!d)
        return OK; /* not made yet */
    for (struct dirent *e; st == OK && (e = readdir(d));) {
        struct stat info;
        if (strstr(e->d_name, ".tmp-") || !is_ours(s, name, e->d_name))
            continue;
        st = path_format(&below, "%s%s", name, e->d_name);
        if (st == OK)
            st = path_join(&full, s->root, below.text);
        if (st == OK && stat(full.text, &info) == 0 && S_ISREG(info.st_mode) && !has(records, below.text) &&
            !has(&s->listed, below.text) && is_stray(s, frame_in(below.text)))
            st = product_list_add(&strays, below.text);
    }
    closedir(d);
    TRY(st);
    product_list_sort(&strays);
    for (size_t i = 0; i < strays.n; i++)
        TRY(report_stray(s, records, folder, strays.path[i]));
done:
    product_list_free(&strays);
    return st;
}

status verify_products(struct search *s)
{
    status st = OK;
    struct product_list list = {0};
    TRY(product_list(s->root, &list));
    for (size_t i = 0; i < list.n; i++)
        TRY(verify_product(s, &list, list.path[i]));
    product_list_sort(&s->listed);
    if (s->n_sound)
        qsort(s->sound, s->n_sound, sizeof *s->sound, by_number);
    for (size_t i = 0; i < sizeof stray_folders / sizeof *stray_folders; i++)
        TRY(verify_strays(s, &list, i));
done:
    product_list_free(&list);
    return st;
}
