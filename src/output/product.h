/* Records of what is made beside the frames: the stage, meshes, other cameras' pictures, previews, the report, run.json and job.yaml.
 *
 * What it is      records/PATH.json for the file PATH: its size and hash, the command that made it, and what of the frame it was made
 *                 of. It is written after the file is in place, and holds its own hash.
 * One a file      Any number of processes make products in one folder at the same time. Each record is one small file that is renamed
 *                 into place, so that there is nothing to lock and nothing to lose.
 * Done            A product is done when its file is what the record says, and was made of the frame that is there now. Who makes
 *                 products asks that (product_done()), and `hoodoo verify` (product_check()).
 */
#ifndef HOODOO_PRODUCT_H
#define HOODOO_PRODUCT_H

#include <limits.h>

#include "output/folder.h"

/* For what is of the whole sequence. */
enum { ALL_FRAMES = INT_MIN, PRODUCT_WORDS = 64 };

/* How a product is made. */
struct recipe {
    const char *root; /* the output folder */
    /* The command that makes it: its verb and the options that decide what it makes, without OUT and --frames. */
    const char *const *word;
    size_t n_words; /* at most PRODUCT_WORDS */
    int frame;      /* or ALL_FRAMES */
    uint64_t
        source; /* manifest_source() of the frame, or any other hash of what it is made of; 0: not known */
};

/* Fills in the frame and its source, which is not known where the frame has no sound manifest. `name`: the job's. E_MEMORY. */
MUST_USE status recipe_of_frame(struct recipe *recipe, const char *name, int frame);

/* The file `path` (relative to the output folder) and its record, each whole or absent. Makes the folders. */
MUST_USE status product_write(const struct recipe *recipe, const char *path, const void *bytes, size_t n);

/* The same for a file that another program wrote under a temporary name (atomic_file.h), relative too. */
MUST_USE status product_adopt(const struct recipe *recipe, const char *temporary, const char *path);

/* Is the product there, made of the recipe's source? `deep`: its content is compared, not only its size. With words in the recipe
 * it must also have been made by this command. E_MEMORY. */
MUST_USE status product_done(const struct recipe *recipe, const char *path, bool deep, bool *done);

/* ---- for who reads them all */

struct product {
    struct manifest_file file; /* its path is relative to the output folder */
    int frame;                 /* or ALL_FRAMES */
    uint64_t source;           /* 0: not known */
    size_t n_words;
    const char *word[PRODUCT_WORDS]; /* texts of json */
    struct json *json;               /* owned; product_free() */
};

/* Of the file `path`. E_INPUT: missing or damaged. */
MUST_USE status product_read(const char *root, const char *path, struct product *out);
void product_free(struct product *product);

/* Is the file what its record says, and made of the frame that is there? E_INPUT says why not. A frame that has no sound manifest has
 * nothing to compare with. */
MUST_USE status product_check(const char *root, const char *name, const struct product *product, bool deep);

/* The products that have a record: their paths, sorted. */
struct product_list {
    size_t n, capacity;
    char (*path)[512];
};
MUST_USE status product_list(const char *root, struct product_list *out);
void product_list_free(struct product_list *list);

/* Where the record of `path` is, relative to the output folder. */
MUST_USE status product_record(struct path *out, const char *path);

/* Removes all records: what they speak of was another run's. */
MUST_USE status product_forget(const char *root);

#endif
