/* The output folder's layout, and frame manifests: what says that a frame is done. */
#ifndef HOODOO_FOLDER_H
#define HOODOO_FOLDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "base/text.h"
#include "particles/frame.h"

enum folder_file {
    FILE_POINTS,
    FILE_VOLUMES,
    FILE_AOV,
    FILE_MANIFEST,
    FILE_CHECKPOINT,
    FILE_MESH,
    FILE_USD,
    FILE_ROCKS,
    FILE_ROCKS_USD,
    FILE_STACKS
};

/* root/points/NAME.1001.vdb and so on: `root` is the output folder, `name` the job's. Frames are written with
 * at least four digits. `camera`: FILE_AOV only, put in the name (NAME.CAMERA.1001.exr) when the job has more
 * than one AOV camera, else NULL. FILE_MESH is the PLY, FILE_USD the
 * surface's points. E_OUTPUT if the path is too long. */
MUST_USE status folder_path(char out[4096], const char *root, const char *name, enum folder_file kind,
                            int frame, const char *camera);

/* Makes root and its subfolders, and sweeps temporary files out of them. */
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
    uint64_t job_hash;
    size_t n_files;
    struct manifest_file *file; /* owned; manifest_free() */
    double years, volume_m3, start_volume_m3, max_stress_Pa;
    int stress_iterations;
    struct ledger ledger;
    size_t n_changes;
    struct manifest_change change[FRAME_CHANGES];
};

/* frames/NAME.1001.json. Written last. */
MUST_USE status manifest_write(const char *root, const char *name, const struct manifest *manifest);
/* E_INPUT: missing, damaged (it holds its own hash), or not the manifest of this frame. */
MUST_USE status manifest_read(const char *root, const char *name, int frame, struct manifest *out);
void manifest_free(struct manifest *manifest);

/* Does every file the manifest lists stand there with its size (and, if `deep`, its hash)? *bad names the
 * first that does not (a text in the manifest, or "" if all are well); status_message() then says what is
 * wrong with it. OK either way. */
MUST_USE status manifest_check(const char *root, const struct manifest *manifest, bool deep,
                               const char **bad);

/* The frames of `name` that have a manifest, ascending; *frames freed with free(). A folder that is not there
 * has none. */
MUST_USE status folder_frames(const char *root, const char *name, int **frames, size_t *n);

/* The job's name of an output folder, from root/run.json. E_INPUT if `root` is not a hoodoo output folder: no
 * run.json with a name, or no job.yaml. */
MUST_USE status folder_open(const char *root, char name[256]);

#endif
