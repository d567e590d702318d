/* Error codes, and the message that explains the last error.
 *
 * The function that detects an error describes it with fail(): what is wrong, where (file, key path, frame), the numbers
 * involved, and what to do. All callers forward the code with TRY(). main() prints the message once; the value of a status
 * is the exit code.
 *
 * Threads   Each thread has its own message. A thread that passes a status to another one must pass the message too: copy
 *           status_message(), and record it there with fail(st, "%s", text).
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
    X(E_CHECKPOINT, 7, "checkpoint unusable, or from another job, build or device")                          \
    X(E_NUMERIC, 8, "the computation became unstable")                                                       \
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

/* Records the message and returns `st`, for `return fail(E_INPUT, "...")`. Control characters are replaced by spaces. */
status fail(status st, const char *format, ...) PRINTF_LIKE(2, 3);

/* The message of the last fail() on this thread; never NULL. */
const char *status_message(void);

/* On an error, jumps to the label `done:` of the enclosing function with the code in its local `status st`. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if ((st = (call)) != OK)                                                                             \
            goto done;                                                                                       \
    } while (0)

#ifdef __cplusplus
}
#endif
#endif
