/* The steps of job_load(): bytes -> tree (yaml.h) -> --set -> struct job -> cross-checks. */
#ifndef HOODOO_JOB_PARSE_H
#define HOODOO_JOB_PARSE_H

#include "job/job.h"
#include "job/table.h"
#include "job/yaml.h"

/* Applies "key.path=value" to the document. List items go by index (strata.0.to_m or strata[0].to_m; the
 * index after the last one appends), and mappings that are not there yet are made. Keys are checked later,
 * with the rest. */
MUST_USE status job_set(struct yaml_tree *tree, struct yaml *root, const char *set);

/* Applies one item of an edit's `set`, whose key is a key path, in the same way. E_USAGE, at the item, for keys
 * that an edit cannot change. */
MUST_USE status job_set_edit(struct yaml_tree *tree, struct yaml *root, const struct yaml *value);

/* May an edit change what is under this key of the job? */
bool job_settable(const char *top);

/* The settings of an edit, as texts; and after the job is read and checked, the job from each edit on. */
MUST_USE status read_sets(const struct yaml *map, struct job_sets *out);
MUST_USE status read_edited_jobs(struct yaml_tree *tree, struct yaml *root, const char *folder,
                                 struct job *job);
void free_sets(struct job_sets *sets);

/* YAML text in double quotes. */
void put_quoted(struct text *t, const char *s);

/* Fills the struct of `section` from a mapping, defaults included. `name` is the mapping's own key where it
 * names the struct (MAP), else NULL. `folder` is where relative INPUT files are. */
MUST_USE status read_section(enum job_section_id section, const struct yaml *map, const char *name,
                             const char *folder, void *out);

/* One value of a simple type into the struct at `base`. */
MUST_USE status read_value(const struct job_key *key, const struct yaml *value, const char *folder,
                           void *base);

/* What an absent key is. `map` is the mapping that lacks it, `below` the path from there: for E_USAGE if
 * required. */
MUST_USE status read_default(const struct job_key *key, const struct yaml *map, const char *below,
                             void *base);

/* Where a frame is seconds, no years pass unless the job says so. */
void read_default_clock(const struct yaml *root, struct job *job);

/* The sides of a terrain's domain are walls unless the job says otherwise. */
void read_default_sides(const struct yaml *root, struct job *job);

/* Where beds and joints turn about the middle of the domain because the job does not say otherwise, puts that in. */
void read_default_pivot(const struct yaml *root, struct job *job);

/* Rock has at least one stratum: a job without any gets one of defaults. */
MUST_USE status read_default_layer(const struct yaml *root, struct job *job);

/* A job, section or node that was filled only partly is fine. */
void free_section(enum job_section_id section, void *base);

/* Fills job->wedge.over from job->wedge.csv, relative to `folder`. E_INPUT names the file and line. */
MUST_USE status read_wedge_csv(const char *folder, const char *behind, struct job *job);

/* The job's files that are not in the folder `link` or below it, where they are in or below `real`. */
MUST_USE status map_beside_link(struct job *job, const char *link, const char *real);

/* What one key's range cannot say. check_section() looks at one mapping, check_job() at all. */
MUST_USE status check_section(enum job_section_id section, const struct yaml *map, const void *base);
MUST_USE status check_job(const struct yaml *root, const struct job *job);

#endif
