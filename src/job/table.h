/* The keys as data, from keys.def: used by the parser, the resolved file, the hash and the reference page. */
#ifndef HOODOO_JOB_TABLE_H
#define HOODOO_JOB_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "job/job.h"

enum job_section_id {
#define SECTION(section, meaning) SECTION_##section,
#include "job/keys.def"
    JOB_SECTIONS
};

/* The shapes of CSG nodes are the sections before `group`, so that the values of job_shape are those of their sections. */
enum { SHAPES = SECTION_group };
_Static_assert((int)SHAPE_BOX == (int)SECTION_box && (int)SHAPE_FUNCTION == (int)SECTION_group - 1,
               "enum job_shape and keys.def differ");

enum key_type {
    KEY_TEXT,
    KEY_NAME,
    KEY_INPUT,
    KEY_NUM,
    KEY_CURVE,
    KEY_TRACK,
    KEY_INT,
    KEY_BOOL,
    KEY_CHOICE,
    KEY_VEC,
    KEY_RANGE,
    KEY_SUB,
    KEY_LIST,
    KEY_MAP,
    KEY_NODE,
    KEY_POINTS,
    KEY_NAMES,
    KEY_MAYBE,
    KEY_RANGES,
    KEY_SETS,
    KEY_TEXTS
};

enum key_use { OUT, FILES, SIM, LATER };

struct job_key {
    enum key_type type;
    enum key_use use; /* SIM for SUB, MAYBE, LIST, MAP and NODE, whose own keys decide */
    const char *name, *unit, *meaning, *source;
    size_t offset;       /* of the member in its struct */
    size_t offset_n;     /* LIST, MAP, POINTS, NAMES, RANGES, TEXTS: of the member n_<key> */
    size_t n;            /* VEC, TRACK, POINTS: numbers per item; TEXT: 1 if a number is accepted; else 0 */
    const char *preset;  /* TEXT, NAME, INPUT, CHOICE, VEC, TRACK, RANGE; NULL: required */
    double number;       /* NUM, CURVE, INT, BOOL: default; NaN: required */
    double min, max;     /* NUM, CURVE, INT, VEC, TRACK, POINTS */
    const char *choices; /* CHOICE: "a|b|c" */
    int child;           /* SUB, MAYBE, LIST, MAP: its section */
};

struct job_section {
    const char *name, *meaning;
    size_t size; /* of struct job_<name> */
    const struct job_key *key;
    size_t n;
};

extern const struct job_section job_sections[JOB_SECTIONS];

/* "union", "intersection", "difference" by job_node_kind. */
extern const char *const node_operators[NODE_SHAPE];

/* The section of the struct in node->u. */
enum job_section_id node_section(const struct job_node *node);

/* NULL if the section has no such key. */
const struct job_key *table_find(enum job_section_id section, const char *name);

bool key_required(const struct job_key *key);

/* Whether the key, or any key inside it, affects the simulation. Cameras, for example, do not. */
bool key_simulates(const struct job_key *key);

/* The same for the files of frames. */
bool key_files(const struct job_key *key);

/* Whether all of these keys are LATER, so that the hash omits those with default values. */
bool key_later(const struct job_key *key);

/* Whether every node has this key (PLACE in keys.def), whatever its shape. */
bool key_places(const char *name);

/* Item `i` of "a|b|c" in *n bytes; NULL past the last. */
const char *choice_item(const char *choices, int i, size_t *n);

/* The allowed values: "0..1000 m/s", "blosc, zip, none"; returns out. */
const char *key_allowed(const struct job_key *key, char out[256]);

/* The shortest exact decimal, with exponents written as in 1e6; returns out. */
const char *key_number(double value, char out[32]);

/* The member of `key` in the struct at `base`. Pointers of lists are read and written with memcpy, because their types differ. */
void *key_member(const struct job_key *key, const void *base);
void *key_items(const struct job_key *key, const void *base, size_t *n);
void key_set_items(const struct job_key *key, void *base, void *items, size_t n);

#endif
