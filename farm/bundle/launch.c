/* Starts a program of a bundle: bin/hoodoo and libexec/hoodoo/hoodoo-read... are copies of this, statically linked.
 *
 * The program of the same name in lib/programs is executed by a loader, with the bundle's libraries. If the machine's C library is as new as
 * the one in the bundle, the machine's own is used, as the machine's Vulkan driver may need it; otherwise the bundle's, which runs the
 * drivers of older machines. The same holds for the C++ library, of which drivers have one. Both questions are answered by small programs
 * that start only if the library is new enough.
 *
 * Libraries are passed by the loader's arguments, so that programs which hoodoo starts (POV-Ray, sbatch) do not inherit them. */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define LOADER "ld-linux-x86-64.so.2"

static void stop(const char *what, const char *why)
{
    fprintf(stderr, "hoodoo: %s: %s\n", what, why);
    _exit(errno == ENOENT ? 127 : 126);
}

static char *joined(const char *a, const char *b, const char *c)
{
    const size_t n = strlen(a) + strlen(b) + strlen(c) + 1;
    char *text = malloc(n);
    if (!text)
        stop("launcher", "out of memory");
    snprintf(text, n, "%s%s%s", a, b, c);
    return text;
}

/* Sets `self` to this file's path. The bundle's folder is one or two levels above its own. */
static char *find_root(char self[PATH_MAX])
{
    const ssize_t n = readlink("/proc/self/exe", self, PATH_MAX - 1);
    char *root;
    if (n <= 0)
        stop("/proc/self/exe", strerror(errno));
    self[n] = '\0';
    root = joined(self, "", "");
    for (int level = 0; level < 3; level++) {
        char *end = strrchr(root, '/'), *programs;
        if (!end)
            break;
        *end = '\0';
        programs = joined(root, "/lib/programs", "");
        if (access(programs, X_OK) == 0)
            return root;
        free(programs);
    }
    errno = ENOENT;
    stop(self, "its bundle is incomplete: lib/programs is missing; unpack it again");
    return NULL;
}

/* Whether a program starts on this machine as it is, and succeeds. */
static int succeeds(char *program)
{
    extern char **environ;
    char *argv[] = {program, NULL};
    posix_spawn_file_actions_t quiet;
    pid_t pid;
    int how = 1;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    if (posix_spawn(&pid, program, &quiet, NULL, argv, environ) != 0)
        return 0;
    while (waitpid(pid, &how, 0) < 0)
        if (errno != EINTR)
            return 0;
    return WIFEXITED(how) && WEXITSTATUS(how) == 0;
}

int main(int argc, char **argv)
{
    enum { BEFORE = 6 };
    static char self[PATH_MAX];
    const char *const user = getenv("LD_LIBRARY_PATH");
    char *const root = find_root(self), *const name = strrchr(self, '/');
    char *const program = joined(root, "/lib/programs", name);
    char *loader = "/lib64/" LOADER, *libraries = joined(root, "/lib", "");
    char **args = calloc((size_t)argc + BEFORE, sizeof *args);
    if (!args)
        stop("launcher", "out of memory");
    if (!succeeds(joined(root, "/lib/programs/host-libc", ""))) {
        loader = joined(root, "/lib/glibc/" LOADER, "");
        libraries = joined(joined(root, "/lib/glibc:", libraries), ":", joined(root, "/lib/gcc", ""));
    } else if (!succeeds(joined(root, "/lib/programs/host-libstdc++", ""))) {
        libraries = joined(libraries, ":", joined(root, "/lib/gcc", ""));
    }
    if (user && *user)
        libraries = joined(libraries, ":", user);
    char *const before[BEFORE] = {loader, "--argv0", self, "--library-path", libraries, program};
    memcpy(args, before, sizeof before);
    if (argc > 1)
        memcpy(args + BEFORE, argv + 1, (size_t)(argc - 1) * sizeof *args);
    execv(loader, args);
    stop(loader, strerror(errno));
}
