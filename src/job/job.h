/* A job: the content of a job file, with every default filled in.
 *
 * The structs below are generated from keys.def; a member has the name and the unit of its key (size_m, interlock_MPa). Units
 * are converted where a value enters a computation.
 */
#ifndef HOODOO_JOB_H
#define HOODOO_JOB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/choice.h"
#include "base/status.h"
#include "text/ranges.h"
#include "text/text.h"

enum curve_ease { EASE_LINEAR, EASE_SMOOTH, EASE_STEP };

/* A number, or a number that varies with the frame; constant before its first and after its last frame. A TRACK has three numbers
 * per frame. */
struct curve {
    size_t n; /* >= 1 */
    double *frame, *value;
    enum curve_ease ease;
};

double curve_at(const struct curve *c, double frame);
double curve_min(const struct curve *c);
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
    SHAPE_VOXELS,
    SHAPE_VOLUME,
    SHAPE_FUNCTION
};

/* Parameters changed by an edit. */
struct job_set {
    char *path, *value; /* "wind.speed_m_s"; the value as one line of YAML */
};

struct job_sets {
    struct job_set *item;
    size_t n;
    struct job *job; /* the job from this edit on, with all earlier edits applied; NULL if it sets nothing */
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
        *child; /* operators: n_child >= 1. A difference is the first child without all later ones. */
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
        struct job_voxels voxels;
        struct job_volume volume;
        struct job_function function;
        struct job_group group; /* operators */
    } u;
};

/* The constants of the choices, one enum per choice. */
#define CHOICE(section, key, use, preset, choices, meaning, source) enum { CHOICE_CONSTANTS(choices) };
#include "job/keys.def"

/* The processes: rows of JOB_PROCESSES in keys.def. */
#define PROCESS(constant, word, ...) PROCESS_##constant,
enum process { JOB_PROCESSES(PROCESS) PROCESSES };
#undef PROCESS

struct job_process {
    const char *name;           /* in manifests: "abrasion" */
    unsigned models;            /* OF_MODEL() of the models that have it */
    const char *color, *legend; /* in the report */
    const char *meaning;
};
extern const struct job_process job_processes[PROCESSES];

/* Whether the job's frames report this process, or any process. A model without processes only keeps the ledger. */
bool job_has_process(const struct job *job, enum process process);
bool job_has_processes(const struct job *job);

/* Whether rock records how long it has been exposed: if the job or any of its edits enables this, or crust or damp. */
bool job_keeps_exposed(const struct job *job);

/* Whether the job or any of its edits has groundwater. */
bool job_seeps(const struct job *job);

/* Whether frames of the job may have the features `has` (HAS_* of values.h). Only HAS_EXPOSED and HAS_SEEPAGE are decided by keys;
 * all others count as possible. */
bool job_may_have(const struct job *job, unsigned has);

/* Whether pictures of the job have this layer (values.h). If the job lists no layers, it has all except those of values that its
 * frames cannot have. */
bool job_wants_layer(const struct job *job, const char *layer);

/* Reads and checks the job file `path`, with `sets` ("key.path=value", as given to --set) applied. Relative file names in it are made
 * absolute from the folder of the job file. E_INPUT: the file cannot be read. E_USAGE: it is invalid; the message has
 * file:line:column (or --set), the key path, and the closest known key or the allowed range. *out is released with
 * job_destroy(). */
MUST_USE status job_load(const char *path, const char *const *sets, size_t n_sets, struct job **out);
void job_destroy(struct job **job);

/* Applies the path mapping rules of an OpenJD session, stored in `file`, to the job's input files. E_INPUT: the file is missing or
 * invalid. */
MUST_USE status job_map_paths(struct job *job, const char *file);

/* The number of wedges of the job; 0 if it has none, or is a wedge itself. */
size_t job_wedges(const struct job *job);

/* Loads wedge `index` (1..job_wedges(base)) of the job that job_load(path, sets) returned as `base`. It is named NAME_w0001, has
 * wedge.index and wedge.label filled in, and has no wedges of its own. E_USAGE: there is no such wedge, or its values are
 * invalid. */
MUST_USE status job_load_wedge(const char *path, const char *const *sets, size_t n_sets,
                               const struct job *base, int index, struct job **out);

/* The complete job as YAML: every key with its value and, as a comment, its unit and meaning. Loading it gives an equal job. */
MUST_USE status job_resolved(const struct job *job, struct text *out);

/* The job in a frame, with the parameters set by edits up to that frame. Owned by `job`. */
const struct job *job_at(const struct job *job, int frame);

/* The sides of the domain that are walls: WALL_* of shared/params.h. */
unsigned job_walls(const struct job *job);

/* Properties of a model: a row of JOB_MODELS in keys.def. */
struct job_model {
    const char *name;
    const char *samples; /* what its rock consists of: "particles" or "voxels" */
    bool centred;        /* they are at the centres of voxels, without a jitter */
    size_t piles;        /* offset in struct job of the struct job_piles that describes its rocks; 0: none */
    bool seconds;        /* supports shots in real time: clock.seconds_per_frame */
    bool edits;          /* supports edits */
    bool wind;           /* its pictures show wind */
    double step_seconds; /* per sample and step, about, measured with lavapipe on two cores */
    bool interlocks;     /* stress above the threshold of a stratum slows its weathering */
    bool terrain;        /* has materials besides the strata, and its frames show their shares */
};
const struct job_model *job_model(const struct job *job);

/* The rocks that frames show: arches.piles, or deposition.piles for rocks on deposits, as set at the start of the job. NULL: none. */
const struct job_piles *job_piles(const struct job *job);

/* Whether checkpoint.mark lists the frame. */
bool job_marks(const struct job *job, int frame);

/* Whether a frame has files of this kind, by the keys `every` of the kind. Points include those for USD. */
enum job_files { JOB_VOLUMES, JOB_POINTS, JOB_PICTURES };
bool job_writes(const struct job *job, enum job_files kind, int frame);

/* Years that pass from frame `from` to frame `to` >= from. */
double job_years(const struct job *job, int from, int to);

/* Rates and interlocking stress of stratum i in a frame: those of the stratum times strata_scale. */
double job_weak(const struct job *job, size_t i, double frame);
double job_strong(const struct job *job, size_t i, double frame);
double job_interlock(const struct job *job, size_t i, double frame);

/* The index of the stratum at a height, m. */
size_t job_layer_at(const struct job *job, double z);

/* Whether the job, rather than the file, determines the size of a heightfield; and whether the file's values are metres. */
bool job_sizes_heightfield(const struct job_heightfield *h);
bool job_heights_are_metres(const struct job_heightfield *h);

/* XXH3-64 of everything that affects the simulation (SIM and LATER in keys.def) in canonical form, including the content of input
 * files. */
MUST_USE status job_hash(const struct job *job, uint64_t *hash);

/* The same of everything else that affects the files of frames (FILES in keys.def, and with output.aov.cameras those cameras and the
 * light). */
MUST_USE status job_files_hash(const struct job *job, uint64_t *hash);

/* Hashes of frames: hash[i] covers everything that the state in frame `first + i` <= `last` depends on, which is all constant
 * values, and the curves, edits and operations up to that frame. Two jobs with the same hash of a frame have the same state
 * there. Like job_hash(), they do not change with releases of hoodoo. */
MUST_USE status job_frame_hashes(const struct job *job, int last, uint64_t *hash);

/* What identifies the frames of a job in manifests and checkpoints: the hashes of all its frames. Releases before 0.2 wrote the hash
 * of the whole job instead, which remains valid. */
struct job_states {
    uint64_t job;    /* job_hash() */
    int first;       /* the frame of hash[0] */
    size_t n;        /* frames */
    uint64_t *frame; /* owned; job_states_free() */
};
MUST_USE status job_states(const struct job *job, struct job_states *out);
void job_states_free(struct job_states *states);

/* The hash of a frame; that of the job for frames outside of it. */
uint64_t job_state(const struct job_states *states, int frame);

/* Whether a manifest or checkpoint of the frame with this hash belongs to the job. */
bool job_states_hold(const struct job_states *states, int frame, uint64_t hash);

/* The first frame in which the states of two jobs with the same first frame differ; if there is none, the frame after the last that
 * both have. */
int job_states_differ(const struct job_states *one, const struct job_states *other);

/* The path of the first key, in the table's order, in which two jobs differ, among the keys that affect the simulation or, with `files`,
 * the files of frames. "frames" if no other key differs. */
MUST_USE status job_differ(const struct job *one, const struct job *other, bool files, char path[256]);

/* Whether a key of the job, which may be a section or a list, has its default value. */
MUST_USE status job_is_default(const struct job *job, const char *key, bool *out);

/* The position of a key in the job file, such as "cliff.yaml:12:5"; for a key that the file does not contain, that of the innermost
 * section around it. Never fails: if no position is known, the result is the file name. */
void job_key_place(const char *path, const char *key, char out[300]);

/* A file that the job reads (mesh, heightfield, jointmap ...) or that such a file refers to (gltf/gltf.h), with the hash of its content. */
struct job_input {
    char *path;
    uint64_t hash, size;
};

/* Lists the input files in order of appearance. Free *out with job_inputs_free(). E_INPUT if one cannot be read. */
MUST_USE status job_inputs(const struct job *job, struct job_input **out, size_t *n);
void job_inputs_free(struct job_input **inputs, size_t n);

/* Describes keys as text, wrapped to `width` columns: all sections (`what` is NULL), the keys of a section ("wind", "box"), one key
 * ("wind.speed_m_s", "strata.0.to_m"), or every key with the word in its path, meaning or unit. E_USAGE: there is none; the
 * message suggests the closest key. */
MUST_USE status job_keys(const char *what, int width, struct text *out);

/* The path of every key, one per line: "strata.N.to_m", "scene.box.min_m". */
MUST_USE status job_keys_list(struct text *out);

/* The keys as a JSON Schema. */
MUST_USE status job_schema(struct text *out);

/* The reference page jobs/README.md, as Markdown. */
MUST_USE status job_reference(struct text *out);

#endif
