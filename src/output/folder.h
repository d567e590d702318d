/* The layout of the output folder, and manifests: the files that mark frames as done. */
#ifndef HOODOO_FOLDER_H
#define HOODOO_FOLDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/path.h"
#include "base/status.h"
#include "particles/frame.h"
#include "text/text.h"

enum folder_file { /* the identity of a VDB depends on these numbers: add new kinds at the end */
                   FILE_POINTS,
                   FILE_VOLUMES,
                   FILE_AOV,
                   FILE_MANIFEST,
                   FILE_CHECKPOINT,
                   FILE_MESH, /* PLY */
                   FILE_USD,  /* points of the surface */
                   FILE_ROCKS,
                   FILE_ROCKS_USD,
                   FILE_STACKS,
                   FILE_KEEP, /* marks a checkpoint that is never pruned */
                   FILE_OBJ,
                   FILE_STILL,
                   FILE_STILL_SCENE, /* POV-Ray scene */
                   FILE_ORBIT_SCENE,
                   FILE_SHEET, /* contact sheet; this and the next three are of all frames */
                   FILE_VIDEO,
                   FILE_WEDGES, /* contact sheet of a farm's wedges */
                   FILE_STAGE,
                   FILE_WIND,
                   FILE_MESH_USD,
                   FILE_VOXELS
};

/* The path of a file relative to the output folder, such as points/NAME.1001.vdb; `name` is the job's. `part`, unless NULL, becomes part
 * of the name (NAME.PART.1001.exr): the camera of an AOV if the job has several, or the value that a picture shows. Files of all frames
 * have no number: NAME.contact.png. E_OUTPUT: the path is too long. */
MUST_USE status folder_name(struct path *out, const char *name, enum folder_file kind, int frame,
                            const char *part);

/* turntable/NAME.1001.000.png: one view of an orbit. */
MUST_USE status folder_view(struct path *out, const char *name, const char *part, int frame, int view);

/* All views of an orbit, as a printf pattern for programs that read image sequences: turntable/NAME.1001.%03d.png. */
MUST_USE status folder_views(struct path *out, const char *name, const char *part, int frame);

/* The path of a file below the output folder `root`: root/points/NAME.1001.vdb. Otherwise as folder_name(). */
MUST_USE status folder_path(struct path *out, const char *root, const char *name, enum folder_file kind,
                            int frame, const char *part);

/* E_OUTPUT if `root` is so long that paths of files below it would exceed the limit. */
MUST_USE status folder_check_length(const char *root);

/* Removes temporary files that killed processes left in the output folder; those of running processes stay. To be called before
 * writing there. Never fails. */
void folder_sweep(const char *root);

/* Creates root and its subfolders, and calls folder_sweep(). */
MUST_USE status folder_prepare(const char *root);

/* A file listed in a manifest. */
struct manifest_file {
    char path[512]; /* relative to root */
    uint64_t size, hash;
};

/* The volume that a process added since the frame before; negative if it removed rock. */
struct manifest_change {
    char process[24];
    double m3;
};

struct manifest {
    int frame;
    uint64_t job_hash, files_hash; /* job_hash(), job_files_hash() */
    size_t n_files;
    struct manifest_file *file; /* owned; manifest_free() */
    double years, volume_m3, start_volume_m3, max_stress_Pa;
    int stress_iterations;
    struct ledger ledger;
    size_t n_changes;
    struct manifest_change change[PROCESSES];
};

/* Writes frames/NAME.1001.json; must be the last file of the frame. */
MUST_USE status manifest_write(const char *root, const char *name, const struct manifest *manifest);
/* E_INPUT: the manifest is missing, damaged (it contains its own hash), or belongs to another frame. */
MUST_USE status manifest_read(const char *root, const char *name, int frame, struct manifest *out);
void manifest_free(struct manifest *manifest);

/* Whether it lists a file in that folder ("points/") with that extension (".vdb"). */
bool manifest_lists(const struct manifest *manifest, const char *folder, const char *extension);

/* Checks that every listed file exists with its size and, if `deep`, its hash. *bad is the path of the first that does not (owned by the
 * manifest) or "", and status_message() then says what is wrong. Returns OK in both cases. */
MUST_USE status manifest_check(const char *root, const struct manifest *manifest, bool deep,
                               const char **bad);

/* The same for one file. E_INPUT, with the reason, if it does not match. */
MUST_USE status listed_check(const char *root, const struct manifest_file *file, bool deep);

/* A hash of what products are made from: the frame's points, volumes and rocks, as listed in its manifest. E_INPUT as manifest_read(). */
MUST_USE status manifest_source(const char *root, const char *name, int frame, uint64_t *hash);

/* The frames of `name` that have a file of this kind without a part, ascending; *frames is freed with free(). None if the folder does not
 * exist. */
MUST_USE status folder_list(const char *root, const char *name, enum folder_file kind, int **frames,
                            size_t *n);

/* The frames that have an orbit, known by its first view. */
MUST_USE status folder_orbits(const char *root, const char *name, int **frames, size_t *n);

/* The frames that have a manifest. */
MUST_USE status folder_frames(const char *root, const char *name, int **frames, size_t *n);

/* The job's name, from root/run.json. E_INPUT if `root` is not an output folder of hoodoo: run.json has no name, or job.yaml is
 * missing. */
MUST_USE status folder_open(const char *root, char name[256]);

/* The job_hash() of the frames in the folder, from root/run.json. E_INPUT. */
MUST_USE status folder_job_hash(const char *root, uint64_t *hash);

#endif
