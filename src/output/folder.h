/* The output folder's layout, and frame manifests: what says that a frame is done. */
#ifndef HOODOO_FOLDER_H
#define HOODOO_FOLDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/path.h"
#include "base/status.h"
#include "base/text.h"
#include "particles/frame.h"

enum folder_file { /* VDBs hold a hash of theirs: new ones come last */
                   FILE_POINTS,
                   FILE_VOLUMES,
                   FILE_AOV,
                   FILE_MANIFEST,
                   FILE_CHECKPOINT,
                   FILE_MESH, /* the PLY */
                   FILE_USD,  /* the surface's points */
                   FILE_ROCKS,
                   FILE_ROCKS_USD,
                   FILE_STACKS,
                   FILE_KEEP, /* beside a checkpoint that is never pruned */
                   FILE_OBJ,
                   FILE_STILL,
                   FILE_STILL_SCENE, /* POV-Ray's */
                   FILE_ORBIT_SCENE,
                   FILE_SHEET, /* of all frames, as are those that follow */
                   FILE_VIDEO,
                   FILE_WEDGES, /* the sheet across a farm's wedges */
                   FILE_STAGE,
                   FILE_WIND,
                   FILE_MESH_USD
};

/* points/NAME.1001.vdb and so on, relative to the output folder: `name` is the job's. `part`: put in the name
 * (NAME.PART.1001.exr), or NULL: the camera of an AOV when the job has more than one AOV camera, the value
 * that a picture shows. A file of all frames has no number: NAME.contact.png. E_OUTPUT if it is too long. */
MUST_USE status folder_name(struct path *out, const char *name, enum folder_file kind, int frame,
                            const char *part);

/* turntable/NAME.1001.000.png: a view of an orbit. */
MUST_USE status folder_view(struct path *out, const char *name, const char *part, int frame, int view);

/* All views of an orbit, as programs want them that read sequences: turntable/NAME.1001.%03d.png. */
MUST_USE status folder_views(struct path *out, const char *name, const char *part, int frame);

/* root/points/NAME.1001.vdb: `root` is the output folder, the rest is folder_name()'s. E_OUTPUT if the path is
 * too long. */
MUST_USE status folder_path(struct path *out, const char *root, const char *name, enum folder_file kind,
                            int frame, const char *part);

/* Has the output folder `root` room below it for the longest path of any file there? E_OUTPUT if not. */
MUST_USE status folder_room(const char *root);

/* Removes the temporary files that killed processes left anywhere in the output folder: for who is about to write
 * there. Those of living processes stay. Never fails. */
void folder_sweep(const char *root);

/* Makes root and its subfolders, and sweeps them. */
MUST_USE status folder_prepare(const char *root);

/* A file a manifest vouches for. */
struct manifest_file {
    char path[512]; /* relative to root */
    uint64_t size, hash;
};

/* What a process changed of the rock since the frame before; negative: taken. */
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

/* frames/NAME.1001.json. Written last. */
MUST_USE status manifest_write(const char *root, const char *name, const struct manifest *manifest);
/* E_INPUT: missing, damaged (it holds its own hash), or not the manifest of this frame. */
MUST_USE status manifest_read(const char *root, const char *name, int frame, struct manifest *out);
void manifest_free(struct manifest *manifest);

/* Is a file of that folder ("points/") and extension (".vdb") among its files? */
bool manifest_lists(const struct manifest *manifest, const char *folder, const char *extension);

/* Does every file the manifest lists stand there with its size (and, if `deep`, its hash)? *bad names the
 * first that does not (a text in the manifest, or "" if all are well); status_message() then says what is
 * wrong with it. OK either way. */
MUST_USE status manifest_check(const char *root, const struct manifest *manifest, bool deep,
                               const char **bad);

/* Does one file stand there as listed? E_INPUT says why not. */
MUST_USE status listed_check(const char *root, const struct manifest_file *file, bool deep);

/* A hash of what is derived from a frame is made of: its points, volumes and rocks, as its manifest lists them. E_INPUT as
 * manifest_read(). */
MUST_USE status manifest_source(const char *root, const char *name, int frame, uint64_t *hash);

/* The frames of `name` that have a file of this kind (named as folder_name() does, with no part), ascending;
 * *frames freed with free(). A folder that is not there has none. */
MUST_USE status folder_list(const char *root, const char *name, enum folder_file kind, int **frames,
                            size_t *n);

/* Those that have an orbit: its first view. */
MUST_USE status folder_orbits(const char *root, const char *name, int **frames, size_t *n);

/* Those that have a manifest. */
MUST_USE status folder_frames(const char *root, const char *name, int **frames, size_t *n);

/* The job's name of an output folder, from root/run.json. E_INPUT if `root` is not a hoodoo output folder: no
 * run.json with a name, or no job.yaml. */
MUST_USE status folder_open(const char *root, char name[256]);

/* job_hash() of the job that its frames are of, from root/run.json. E_INPUT. */
MUST_USE status folder_job_hash(const char *root, uint64_t *hash);

#endif
