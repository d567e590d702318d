/* Error codes, and the one sentence that explains the last one.
 *
 * Whoever detects an error describes it with fail(): what, where (file, key path, frame), with numbers, and
 * what to do. Everyone above only forwards the code with TRY(). main() prints the sentence once; a status's
 * value is the exit code.
 *
 * Threads   The sentence is per thread. A worker that hands its status to another thread must carry the
 *           sentence with it: copy status_message(), and say it again there with fail(st, "%s", text).
 */
#ifndef HOODOO_STATUS_H
#define HOODOO_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

/*       name            exit  meaning */
#define STATUS_MAP(X)                                                                                        \
    X(OK, 0, "done")                                                                                         \
    X(E_USAGE, 2, "wrong usage or job file")                                                                 \
    X(E_INPUT, 3, "input file missing, damaged or hostile")                                                  \
    X(E_OUTPUT, 4, "output cannot be written")                                                               \
    X(E_MEMORY, 5, "out of memory")                                                                          \
    X(E_DEVICE, 6, "no such device, or device lost")                                                         \
    X(E_CHECKPOINT, 7, "checkpoint unusable, or of another job, build or device")                            \
    X(E_NUMERIC, 8, "numbers blew up")                                                                       \
    X(STOPPED, 85, "stopped after saving a checkpoint: run the same command again")

typedef enum status {
#define STATUS_ENUM(name, code, text) name = code,
    STATUS_MAP(STATUS_ENUM)
#undef STATUS_ENUM
} status;

#if defined(__GNUC__)
#define MUST_USE __attribute__((warn_unused_result))
#define PRINTF_LIKE(fmt, args) __attribute__((format(printf, fmt, args)))
#else
#define MUST_USE
#define PRINTF_LIKE(fmt, args)
#endif

/* Records the sentence and returns `st`, so that a detector can `return fail(E_INPUT, "...")`. */
status fail(status st, const char *format, ...) PRINTF_LIKE(2, 3);

/* The sentence of the last fail() on this thread; never NULL. */
const char *status_message(void);

/* Forward any error to the function's `done:` label. Needs a local `status st`. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if ((st = (call)) != OK)                                                                             \
            goto done;                                                                                       \
    } while (0)

#ifdef __cplusplus
}
#endif
#endif
