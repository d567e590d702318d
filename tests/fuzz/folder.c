/* The small files of an output folder that somebody else has written: `verify`, `status` and `report` read them, and so do the farm's verbs.
 * Each part of the input begins with the byte RECORD and a letter that chooses its file; files that contain their own hash get the right one. */
#include "fuzz/fuzz.h"

#include <unistd.h>

#include "base/hash.h"
#include "base/log.h"
#include "cli/cli.h"
#include "farm/end.h"
#include "farm/slurm_jobs.h"
#include "farm/submission.h"
#include "farm/tries.h"

enum { RECORD = 0x1e };

static const struct {
    const char *name;
    bool sealed;
} files[] = {
    {"job.yaml", false},
    {"run.json", false},
    {"frames/n.1001.json", true},
    {"frames/n.1002.json", true},
    {"records/n.usda.json", true},
    {"records/job.yaml.json", true},
    {"records/run.json.json", true},
    {"records/preview/n.1001.png.json", true},
    {"records/report/index.html.json", true},
    {"log/timing.jsonl", false},
    {"log/run.log", false},
    {"farm/job.yaml", false},
    {"farm/submission.json", false},
    {"farm/slurm.json", false},
    {"farm/end.json", false},
    {"log/farm/sim.1001-1002.jsonl", false},
    {"points/n.1001.vdb", false},
    {"preview/n.1001.png", false},
};
enum { FILES = sizeof files / sizeof *files };

static const char *path_of(const char *name)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", fuzz_folder(), name);
    return path;
}

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    static const char *const folders[] = {
        "frames",   "records", "records/preview", "records/report", "log",
        "log/farm", "farm",    "points",          "preview",        "report"};
    (void)argc;
    (void)argv;
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        mkdir(path_of(folders[i]), 0777);
    if (!freopen("/dev/null", "w", stdout))
        abort();
    setenv("PATH", "/nowhere", 1); /* no squeue */
    log_silence(true);
    return 0;
}

/* Writes the file, sealed with its own hash where hoodoo would. */
static void put(size_t which, const uint8_t *bytes, size_t n)
{
    static const char self[] = ",\n  \"self_xxh3\": \"";
    char digits[17];
    const uint8_t *old = files[which].sealed ? memmem(bytes, n, self, sizeof self - 1) : NULL;
    n = old ? (size_t)(old - bytes) : n;
    char *sealed = malloc(n + sizeof self + 24);
    if (!sealed)
        abort();
    memcpy(sealed, bytes, n);
    hash_text(hash_bytes(bytes, n), digits);
    const size_t more = files[which].sealed ? (size_t)sprintf(sealed + n, "%s%s\"\n}\n", self, digits) : 0;
    fuzz_file(files[which].name, sealed, n + more);
    free(sealed);
}

static void verb(status (*call)(int, char **), const char *name, const char *option)
{
    char word[3][512];
    snprintf(word[0], sizeof word[0], "%s", name);
    snprintf(word[1], sizeof word[1], "%s", fuzz_folder());
    snprintf(word[2], sizeof word[2], "%s", option);
    char *argv[] = {word[0], word[1], word[2], NULL};
    fuzz_refused(call(*option ? 3 : 2, argv));
}

static void read_farm(void)
{
    struct farm f = {0};
    struct submission s = {0};
    char(*job)[SLURM_ID] = NULL;
    status st = submission_read(fuzz_folder(), &s);
    fuzz_refused(st);
    submission_free(&s);
    st = farm_open(fuzz_folder(), &f);
    fuzz_refused(st);
    for (size_t i = 0; st == OK && i < f.graph.n && i < 8; i++) {
        struct farm_tries tries;
        fuzz_refused(tries_read(&f, &f.graph.task[i], &tries));
    }
    if (st == OK && f.graph.n && (job = calloc(f.graph.n, sizeof *job)))
        fuzz_refused(slurm_active(&f, job));
    free(job);
    farm_free(&f);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    for (size_t i = 0; i < FILES; i++)
        unlink(path_of(files[i].name));
    for (size_t at = 0; at < n;) {
        const uint8_t *next = memchr(bytes + at + 1, RECORD, n - at - 1);
        const size_t end = next ? (size_t)(next - bytes) : n;
        if (bytes[at] == RECORD && end - at >= 2)
            put((size_t)(bytes[at + 1] - 'a') % FILES, bytes + at + 2, end - at - 2);
        at = end;
    }
    verb(cli_verify, "verify", "");
    verb(cli_status, "status", "--json");
    verb(cli_report, "report", "--no-pictures");
    read_farm();
    return 0;
}
