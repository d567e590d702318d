/* Products: files that are made beside the frames (the USD stage, meshes, pictures of other cameras, previews, the report, run.json and
 * job.yaml), each with a record.
 *
 * Record     records/PATH.json for the file PATH: its size and hash, the command that made it, and a hash of the frame it was made from.
 *            It is written after the file is in place, and contains its own hash (sealed.h).
 * No locks   Any number of processes may make products in one folder at the same time. Each product has its own small record, which is
 *            renamed into place, so there is no shared file to lock.
 * Done       A product is done if its file matches its record and it was made from the frame as it is now. product_done() asks this
 *            before making a product, product_check() for `hoodoo verify`.
 */
#ifndef HOODOO_PRODUCT_H
#define HOODOO_PRODUCT_H

#include <limits.h>

#include "output/folder.h"

/* ALL_FRAMES: the frame number of products of the whole sequence. */
enum { ALL_FRAMES = INT_MIN, PRODUCT_WORDS = 64 };

/* A product that another one shows, such as a still on a contact sheet: its path relative to the output folder, and its hash. */
struct shown_product {
    const char *path;
    uint64_t hash;
};

/* How a product is made. */
struct recipe {
    const char *root; /* the output folder */
    /* The command line that makes it: the verb and the options that affect the result, without OUT and --frames. */
    const char *const *word;
    size_t n_words; /* at most PRODUCT_WORDS */
    int frame;      /* or ALL_FRAMES */
    uint64_t
        source; /* manifest_source() of the frame, or another hash of what it is made from; 0: not known */
    const struct shown_product *shows;
    size_t n_shows;
};

/* Fills in the frame and its source. The source is 0 if the frame has no sound manifest. `name`: the job's name. E_MEMORY. */
MUST_USE status recipe_of_frame(struct recipe *recipe, const char *name, int frame);

/* Writes the file `path` (relative to the output folder) and its record, creating folders as needed. Each of the two files is complete or
 * absent. */
MUST_USE status product_write(const struct recipe *recipe, const char *path, const void *bytes, size_t n);

/* The same for a file that another program wrote under a temporary name (atomic_file.h), which is relative as well. */
MUST_USE status product_adopt(const struct recipe *recipe, const char *temporary, const char *path);

/* *done: the product exists, matches its record, and was made from the recipe's source; if the recipe has words, also by the same
 * command. `deep`: compares the content, not only the size. E_MEMORY. */
MUST_USE status product_done(const struct recipe *recipe, const char *path, bool deep, bool *done);

/* ---- reading the records */

struct product {
    struct manifest_file file; /* its path is relative to the output folder */
    int frame;                 /* or ALL_FRAMES */
    uint64_t source;           /* 0: not known */
    size_t n_words;
    const char *word[PRODUCT_WORDS]; /* strings owned by `json` */
    const struct json *shows;        /* owned by `json`; product_shows() */
    struct json *json;               /* owned; product_free() */
};

/* Reads the record of the file `path`. E_INPUT: it is missing or damaged. */
MUST_USE status product_read(const char *root, const char *path, struct product *out);
void product_free(struct product *product);

/* E_INPUT, with the reason, unless the file matches its record and was made from the frame as it is now. If the frame has no sound
 * manifest, the source is not compared. */
MUST_USE status product_check(const char *root, const char *name, const struct product *product, bool deep);

/* Was this product made from the file `path` when that had this hash? */
bool product_shows(const struct product *product, const char *path, uint64_t hash);

/* The paths of all products that have a record, sorted. */
struct product_list {
    size_t n, capacity;
    char (*path)[512];
};
MUST_USE status product_list(const char *root, struct product_list *out);
MUST_USE status product_list_add(struct product_list *list, const char *path);
void product_list_sort(struct product_list *list);
void product_list_free(struct product_list *list);

/* The path of the record of `path`, relative to the output folder. */
MUST_USE status product_record(struct path *out, const char *path);

/* Removes all records, when a run starts over and existing products no longer belong to it. */
MUST_USE status product_remove_records(const char *root);

#endif
