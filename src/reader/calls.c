#include "reader/calls.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <stddef.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* Allowed with any arguments. The only descriptors open for writing are the answer and /dev/null. */
static const int plain[] = {
    /* content of files */
    SCMP_SYS(read), SCMP_SYS(readv), SCMP_SYS(pread64), SCMP_SYS(preadv), SCMP_SYS(lseek), SCMP_SYS(close),
    SCMP_SYS(write), SCMP_SYS(writev), SCMP_SYS(pwrite64), SCMP_SYS(getdents64), SCMP_SYS(fadvise64),
    /* existence and attributes of files */
    SCMP_SYS(stat), SCMP_SYS(lstat), SCMP_SYS(fstat), SCMP_SYS(newfstatat), SCMP_SYS(statx), SCMP_SYS(statfs),
    SCMP_SYS(fstatfs), SCMP_SYS(access), SCMP_SYS(faccessat), SCMP_SYS(faccessat2), SCMP_SYS(readlink),
    SCMP_SYS(readlinkat), SCMP_SYS(getcwd),
    /* memory */
    SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise),
    /* time and properties of the machine */
    SCMP_SYS(clock_gettime), SCMP_SYS(clock_getres), SCMP_SYS(gettimeofday), SCMP_SYS(time),
    SCMP_SYS(nanosleep), SCMP_SYS(clock_nanosleep), SCMP_SYS(sysinfo), SCMP_SYS(uname), SCMP_SYS(getrandom),
    SCMP_SYS(sched_getaffinity), SCMP_SYS(sched_yield), SCMP_SYS(getcpu), SCMP_SYS(getrlimit),
    SCMP_SYS(getrusage),
    /* identity */
    SCMP_SYS(getpid), SCMP_SYS(gettid), SCMP_SYS(getuid), SCMP_SYS(geteuid), SCMP_SYS(getgid),
    SCMP_SYS(getegid),
    /* locks, signals, exit */
    SCMP_SYS(futex), SCMP_SYS(set_robust_list), SCMP_SYS(rseq), SCMP_SYS(restart_syscall),
    SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn), SCMP_SYS(sigaltstack),
    SCMP_SYS(exit), SCMP_SYS(exit_group)};

/* Also allowed for a process that executes another program. */
static const int to_execute[] = {SCMP_SYS(execve), SCMP_SYS(arch_prctl), SCMP_SYS(set_tid_address)};

/* Allows `call` if its argument `arg` has none of the bits of `never`. */
static int allow_without(scmp_filter_ctx filter, int call, unsigned arg, uint64_t never)
{
    return seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 1, SCMP_CMP(arg, SCMP_CMP_MASKED_EQ, never, 0));
}

static int fill(scmp_filter_ctx filter, bool executes)
{
    const uint64_t for_more_than_reading = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND;
    int bad = 0;
    for (size_t i = 0; i < sizeof plain / sizeof *plain; i++)
        bad |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, plain[i], 0);
    bad |= allow_without(filter, SCMP_SYS(open), 1, for_more_than_reading);
    bad |= allow_without(filter, SCMP_SYS(openat), 2, for_more_than_reading);
    bad |= allow_without(filter, SCMP_SYS(mmap), 2, executes ? 0 : PROT_EXEC);
    bad |= allow_without(filter, SCMP_SYS(mprotect), 2, executes ? 0 : PROT_EXEC);
    for (size_t i = 0; executes && i < sizeof to_execute / sizeof *to_execute; i++)
        bad |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, to_execute[i], 0);
    /* Threads are allowed, because some libraries need them, but processes are not. A filter cannot see the arguments of clone3(), so
     * it is reported as missing, and the C library falls back to clone(). */
    bad |= seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
    bad |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(clone), 1,
                            SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD));
    const int harmless[] = {F_GETFD, F_SETFD, F_GETFL};
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++)
        bad |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(fcntl), 1,
                                SCMP_A1(SCMP_CMP_EQ, (scmp_datum_t)harmless[i], 0));
    /* Limits may be read but not set. Signals may only be sent to this process, for abort(). */
    bad |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(prlimit64), 1, SCMP_A2(SCMP_CMP_EQ, 0, 0));
    bad |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1,
                            SCMP_A0(SCMP_CMP_EQ, (scmp_datum_t)getpid(), 0));
    return bad;
}

status calls_limit(bool executes)
{
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
    if (!filter)
        return fail(E_MEMORY, "out of memory for the filter of system calls");
    int bad = fill(filter, executes), error = bad ? bad : seccomp_load(filter);
    seccomp_release(filter);
    if (error)
        return fail(
            E_INPUT,
            "files cannot be read safely here: the kernel does not accept a filter of system calls: %s",
            strerror(-error));
    return OK;
}
