/* The steps of job_load(): bytes -> tree (yaml.h) -> --set -> struct job -> checks across keys. */
#ifndef HOODOO_JOB_PARSE_H
#define HOODOO_JOB_PARSE_H

#include "job/job.h"
#include "job/table.h"
#include "job/yaml.h"

/* Applies "key.path=value" to the document. Items of lists are addressed by index (strata.0.to_m or strata[0].to_m; the index after
 * the last item appends one), and missing mappings are created. Keys are checked later, with those of the document. */
MUST_USE status job_set(struct yaml_tree *tree, struct yaml *root, const char *set);

/* Applies one item of an edit's `set`, whose key is a key path, in the same manner. E_USAGE, with the item's position, for keys that an
 * edit cannot change. */
MUST_USE status job_set_edit(struct yaml_tree *tree, struct yaml *root, const struct yaml *value);

/* Whether an edit can change values under this top-level key of the job. */
bool job_settable(const char *top);

/* Reads the settings of an edit as texts; and, after the job is read and checked, builds the job from each edit on. */
MUST_USE status read_sets(const struct yaml *map, struct job_sets *out);
MUST_USE status read_edited_jobs(struct yaml_tree *tree, struct yaml *root, const char *folder,
                                 struct job *job);
void free_sets(struct job_sets *sets);

/* Adds YAML text in double quotes. */
void put_quoted(struct text *t, const char *s);

/* Fills the struct of `section` from a mapping, including defaults. `name` is the mapping's key for items of a MAP, else NULL.
 * Relative names of INPUT files refer to `folder`. */
MUST_USE status read_section(enum job_section_id section, const struct yaml *map, const char *name,
                             const char *folder, void *out);

/* Reads one value of a simple type into the struct at `base`. */
MUST_USE status read_value(const struct job_key *key, const struct yaml *value, const char *folder,
                           void *base);

/* Sets an absent key to its default. E_USAGE if it is required; `map` is the mapping that lacks it and `below` the path from there, for
 * the message. */
MUST_USE status read_default(const struct job_key *key, const struct yaml *map, const char *below,
                             void *base);

/* With seconds_per_frame, years_per_frame defaults to 0. */
void read_default_clock(const struct yaml *root, struct job *job);

/* With model arches, the sides of the domain default to walls. */
void read_default_sides(const struct yaml *root, struct job *job);

/* Sets attitude.pivot_m to the middle of the domain if something turns about it and the job does not give it. */
void read_default_pivot(const struct yaml *root, struct job *job);

/* Gives a job without strata one stratum with default values. */
MUST_USE status read_default_layer(const struct yaml *root, struct job *job);

/* Releases what a section owns; it may be only partly filled. */
void free_section(enum job_section_id section, void *base);

/* Fills job->wedge.over from job->wedge.csv, relative to `folder`. E_INPUT: the message has file and line. */
MUST_USE status read_wedge_csv(const char *folder, const char *behind, struct job *job);

/* For a job loaded through a symbolic link: replaces input files that are missing in the folder `link` by those in `real`, the folder of
 * the link's target. */
MUST_USE status map_beside_link(struct job *job, const char *link, const char *real);

/* Checks that involve several keys: check_section() within one mapping, check_job() across the job. */
MUST_USE status check_section(enum job_section_id section, const struct yaml *map, const void *base);
MUST_USE status check_job(const struct yaml *root, const struct job *job);

#endif
