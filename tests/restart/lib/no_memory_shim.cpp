// A library for LD_PRELOAD that makes hoodoo's Nth allocation fail. NO_MEMORY is "N FILE"; when the allocation fails, a line with
// N is written to FILE. With N = 0 none fails, and a line per allocation identifies its caller by a hash of the call stack.
// Only calls of malloc, calloc and realloc by hoodoo's own code count, in order of time. Shrinking, libraries, C++'s new, forked
// processes and other programs do not count: reader processes have a limit of their own, where a lack of memory means that
// the file is hostile.
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <malloc.h>
#include <unistd.h>

extern "C" {
void *__libc_malloc(size_t n);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *p, size_t size);
}

namespace
{
std::atomic<long> count{0};
thread_local bool busy;
long nth = -1;
const char *file;
pid_t process;
uintptr_t from, to; // hoodoo's code

int find_code(dl_phdr_info *program, size_t, void *)
{
    for (int i = 0; i < program->dlpi_phnum; ++i) {
        const ElfW(Phdr) &part = program->dlpi_phdr[i];
        if (part.p_type == PT_LOAD && (part.p_flags & PF_X) != 0) {
            from = program->dlpi_addr + part.p_vaddr;
            to = from + part.p_memsz;
        }
    }
    return 1; // the first is the program itself
}

void note(unsigned long number)
{
    char text[32];
    int n = std::snprintf(text, sizeof text, "%lu\n", number);
    int out = open(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    if (out < 0 || write(out, text, static_cast<size_t>(n)) != n)
        _exit(99);
    close(out);
}

unsigned long calls()
{
    void *at[64];
    unsigned long hash = 0;
    for (int i = 0, n = backtrace(at, 64); i < n; ++i) {
        uintptr_t here = reinterpret_cast<uintptr_t>(at[i]);
        if (here >= from && here < to)
            hash = (hash ^ (here - from)) * 0x100000001b3;
    }
    return hash;
}

__attribute__((constructor)) void begin()
{
    const char *said = std::getenv("NO_MEMORY"), *space = said ? std::strchr(said, ' ') : nullptr;
    if (!space || std::strcmp(program_invocation_short_name, "hoodoo") != 0)
        return;
    dl_iterate_phdr(find_code, nullptr);
    file = space + 1;
    process = getpid();
    nth = std::atol(said);
}

bool fails(const void *caller)
{
    uintptr_t at = reinterpret_cast<uintptr_t>(caller);
    if (nth < 0 || getpid() != process || at < from || at >= to || (++count != nth && nth != 0))
        return false;
    if (busy) // backtrace allocates the first time
        return false;
    busy = true;
    note(nth ? static_cast<unsigned long>(nth) : calls());
    busy = false;
    return nth != 0;
}
} // namespace

extern "C" void *malloc(size_t n)
{
    return fails(__builtin_return_address(0)) ? nullptr : __libc_malloc(n);
}

extern "C" void *calloc(size_t n, size_t size)
{
    return fails(__builtin_return_address(0)) ? nullptr : __libc_calloc(n, size);
}

extern "C" void *realloc(void *p, size_t size)
{
    bool grows = !p || malloc_usable_size(p) < size;
    return grows && fails(__builtin_return_address(0)) ? nullptr : __libc_realloc(p, size);
}
