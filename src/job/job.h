/* A job: what the user asked for, with every default filled in.
 *
 * The structs below are generated from keys.def; a member has the key's own name and unit (size_m,
 * interlock_MPa). Convert units where a value enters a computation, not here.
 */
#ifndef HOODOO_JOB_H
#define HOODOO_JOB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/choice.h"
#include "base/ranges.h"
#include "base/status.h"
#include "base/text.h"

enum curve_ease { EASE_LINEAR, EASE_SMOOTH, EASE_STEP };

/* A number, or a number that changes with the frame. Constant outside its first and last frame. A TRACK has
 * three numbers for each frame. */
struct curve {
    size_t n; /* >= 1 */
    double *frame, *value;
    enum curve_ease ease;
};

double curve_at(const struct curve *c, double frame);
double curve_max(const struct curve *c);
void track_at(const struct curve *c, double frame, double out[3]);

enum job_node_kind { NODE_UNION, NODE_INTERSECTION, NODE_DIFFERENCE, NODE_SHAPE };
enum job_shape {
    SHAPE_BOX,
    SHAPE_SPHERE,
    SHAPE_CYLINDER,
    SHAPE_PLANE,
    SHAPE_MESH,
    SHAPE_HEIGHTFIELD,
    SHAPE_JOINTMAP,
    SHAPE_STROKE,
    SHAPE_STACKS,
    SHAPE_VOLUME,
    SHAPE_FUNCTION
};

/* What an edit sets. */
struct job_set {
    char *path, *value; /* "wind.speed_m_s"; the value as one line of YAML */
};

struct job_sets {
    struct job_set *item;
    size_t n;
    struct job
        *job; /* the job as it is from this edit on, all earlier ones counted; NULL if it sets nothing */
};

/* The top section is the job itself: struct job, not struct job_job. */
#define job_job job

#define SECTION(section, meaning) struct job_##section {
#define END(section)                                                                                         \
    }                                                                                                        \
    ;
#define TEXT(section, key, use, preset, meaning, source) char *key;
#define NAME(section, key, use, preset, meaning, source) char *key;
#define INPUT(section, key, use, preset, meaning, source) char *key;
#define NUM(section, key, use, unit, preset, min, max, meaning, source) double key;
#define CURVE(section, key, use, unit, preset, min, max, meaning, source) struct curve key;
#define TRACK(section, key, use, unit, preset, min, max, meaning, source) struct curve key;
#define INT(section, key, use, unit, preset, min, max, meaning, source) int64_t key;
#define BOOL(section, key, use, preset, meaning, source) bool key;
#define CHOICE(section, key, use, preset, choices, meaning, source) int key;
#define VEC(section, key, use, unit, n, preset, min, max, meaning, source) double key[n];
#define RANGE(section, key, use, preset, meaning, source) struct frame_range key;
#define SUB(section, key, child, meaning) struct job_##child key;
#define LIST(section, key, child, meaning)                                                                   \
    struct job_##child *key;                                                                                 \
    size_t n_##key;
#define MAP(section, key, child, meaning) LIST(section, key, child, meaning)
#define MAYBE(section, key, child, meaning) struct job_##child *key;
#define NODE(section, key, meaning) struct job_node *key;
#define MAYBE_NODE(section, key, meaning) struct job_node *key;
#define RANGES(section, key, use, meaning)                                                                   \
    struct frame_range *key;                                                                                 \
    size_t n_##key;
#define SETS(section, key, meaning) struct job_sets key;
#define POINTS(section, key, use, unit, n, min, max, meaning, source)                                        \
    double(*key)[n];                                                                                         \
    size_t n_##key;
#define NAMES(section, key, use, meaning)                                                                    \
    char **key;                                                                                              \
    size_t n_##key;
#define TEXTS(section, key, use, meaning) NAMES(section, key, use, meaning)
#include "job/keys.def"

struct job_node {
    enum job_node_kind kind;
    struct job_node *
        *child; /* operators: n_child >= 1. A difference takes all later children from the first. */
    size_t n_child;
    enum job_shape shape; /* NODE_SHAPE only */
    union {
        struct job_box box;
        struct job_sphere sphere;
        struct job_cylinder cylinder;
        struct job_plane plane;
        struct job_mesh mesh;
        struct job_heightfield heightfield;
        struct job_jointmap jointmap;
        struct job_stroke stroke;
        struct job_stacks stacks;
        struct job_volume volume;
        struct job_function function;
        struct job_group group; /* operators */
    } u;
};

/* The choices' constants, an enum each. */
#define CHOICE(section, key, use, preset, choices, meaning, source) enum { CHOICE_CONSTANTS(choices) };
#include "job/keys.def"

/* The processes, a row of JOB_PROCESSES in keys.def each. */
#define PROCESS(constant, word, ...) PROCESS_##constant,
enum process { JOB_PROCESSES(PROCESS) PROCESSES };
#undef PROCESS

struct job_process {
    const char *name;           /* in manifests: "abrasion" */
    unsigned models;            /* OF_MODEL() of those whose frames it is in */
    const char *color, *legend; /* in the report */
    const char *meaning;
};
extern const struct job_process job_processes[PROCESSES];

/* Whether the job's frames report it; and any at all. A model without any counts in its ledger alone. */
bool job_has_process(const struct job *job, enum process process);
bool job_has_processes(const struct job *job);

/* Whether rock keeps how long it has been bare, from the first frame on: where the job or an edit of it asks for that or for
 * what follows from it. */
bool job_keeps_exposed(const struct job *job);

/* Whether rock ever has groundwater: by the job or an edit of it. */
bool job_seeps(const struct job *job);

/* Whether its frames may have what values need (HAS_* of values.h), as far as the keys say that rock keeps for them alone: exposed_kyr, seepage. */
bool job_may_have(const struct job *job, unsigned has);

/* Whether the job wants this layer of pictures (values.h). Left to itself it wants all but those of values that its frames cannot have. */
bool job_wants_layer(const struct job *job, const char *layer);

/* Reads and checks `path`, applying `sets` ("key.path=value", as --set gives them) over it. File names inside
 * are made absolute against the job file's folder. E_INPUT: the file cannot be read. E_USAGE: it is wrong;
 * the message has file:line:column (or --set), the key path, and the nearest known key or the allowed range.
 * *out is freed with job_destroy(). */
MUST_USE status job_load(const char *path, const char *const *sets, size_t n_sets, struct job **out);
void job_destroy(struct job **job);

/* Puts the job's input files where OpenJD's path mapping rules (the file of a session) say they are here.
 * E_INPUT: the file is missing or wrong. */
MUST_USE status job_map_paths(struct job *job, const char *file);

/* Wedges: the job with other values, side by side. How many there are; 0 if the job has none, or is one. */
size_t job_wedges(const struct job *job);

/* Wedge `index` (1..job_wedges(base)) of the job that job_load(path, sets) gave as `base`: named
 * NAME_w0001, with wedge.index and wedge.label filled in and no wedges of its own. E_USAGE: there is no such
 * wedge, or its values are wrong. */
MUST_USE status job_load_wedge(const char *path, const char *const *sets, size_t n_sets,
                               const struct job *base, int index, struct job **out);

/* The job as run: YAML with every key, its value and, as a comment, its unit and meaning. Loading it again
 * gives an equal job. */
MUST_USE status job_resolved(const struct job *job, struct text *out);

/* The job as it is in a frame: with what the edits up to it set. Lives as long as `job`. */
const struct job *job_at(const struct job *job, int frame);

/* Which of the domain's sides are walls: WALL_* of shared/params.h. */
unsigned job_walls(const struct job *job);

/* What differs between models beside what they compute: a row of JOB_MODELS in keys.def. */
struct job_model {
    const char *name;
    const char *samples; /* what its rock is counted in: "particles" */
    size_t piles; /* offset in struct job of the struct job_piles that its rocks come from; 0: it has none */
    bool seconds; /* it can run in real time: clock.seconds_per_frame */
    bool edits;   /* rock and parameters can be edited on the way */
    bool wind;    /* its pictures show wind */
    bool interlocks; /* stress above a layer's threshold slows its weathering */
    bool terrain;    /* it has materials besides the strata, and frames show their shares */
};
const struct job_model *job_model(const struct job *job);

/* The rocks that frames show: of arches.piles, or lying on deposits of deposition.piles, as the job begins.
 * NULL: none. */
const struct job_piles *job_piles(const struct job *job);

/* Whether checkpoint.mark holds the frame. */
bool job_marks(const struct job *job, int frame);

/* Whether a frame has files of this kind, by the keys that say every how many frames. Points are USD's too. */
enum job_files { JOB_VOLUMES, JOB_POINTS, JOB_PICTURES };
bool job_writes(const struct job *job, enum job_files kind, int frame);

/* Years that pass from frame `from` to frame `to`, >= it. */
double job_years(const struct job *job, int from, int to);

/* The index of the stratum at a height, m. */
size_t job_layer_at(const struct job *job, double z);

/* Whether the job says how large a heightfield is; else its file does, and whether its values are metres, by the file's word. */
bool job_sizes_heightfield(const struct job_heightfield *h);
bool job_heights_are_metres(const struct job_heightfield *h);

/* XXH3-64 of everything that changes the simulation (keys.def's SIM), in canonical form, input files'
 * contents included. */
MUST_USE status job_hash(const struct job *job, uint64_t *hash);

/* The same of everything else that the files of frames depend on (keys.def's FILES, and the cameras of output.aov.cameras). */
MUST_USE status job_files_hash(const struct job *job, uint64_t *hash);

/* hash[i]: of everything that the state in frame `first + i` depends on, up to `last`: what is steady, and the curves, edits and
 * operations of the frames up to it. Two jobs with the same hash of a frame have the same state there. Of one build of hoodoo: it is not
 * for files. */
MUST_USE status job_frame_hashes(const struct job *job, int last, uint64_t *hash);

/* The first key, in the table's order, in which two jobs differ: of those that are simulated, or that files have. "frames" if they
 * differ in nothing else. */
MUST_USE status job_differ(const struct job *one, const struct job *other, bool files, char path[256]);

/* Is this key of the job, a section or a list, what it is when it is left out? */
MUST_USE status job_is_default(const struct job *job, const char *key, bool *out);

/* Where a key of the job file stands, "cliff.yaml:12:5"; of one that is not written there, the nearest that holds it. Never fails: the
 * file's name alone. */
void job_key_place(const char *path, const char *key, char out[300]);

/* A file the job reads (mesh, heightfield, jointmap), with its content hash. */
struct job_input {
    const char *path; /* borrowed from the job */
    uint64_t hash, size;
};

/* All of them in order of appearance, in *out (freed with free()). E_INPUT if one cannot be read. */
MUST_USE status job_inputs(const struct job *job, struct job_input **out, size_t *n);

/* Keys for people, in lines of `width`: all sections (`what` NULL), the keys of one ("wind", "box"), one key ("wind.speed_m_s",
 * "strata.0.to_m"), or every key that has the word in its path, meaning or unit. E_USAGE: none has; the nearest is named. */
MUST_USE status job_keys(const char *what, int width, struct text *out);

/* The path of every key, a line each: "strata.N.to_m", "scene.box.min_m". */
MUST_USE status job_keys_list(struct text *out);

/* The keys as a JSON Schema. */
MUST_USE status job_schema(struct text *out);

/* The reference page jobs/README.md, as Markdown. */
MUST_USE status job_reference(struct text *out);

#endif
