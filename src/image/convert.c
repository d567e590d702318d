#include "image/convert.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "reader/limits.h"
#include "reader/translate.h"
#include "system/beside.h"
#include "system/child.h"

/* Extensions that are raw values, or that a driver of GDAL reads from a single file. */
static const struct {
    const char *end, *form, *driver, *what;
} forms[] = {
    {".r16", "r16", NULL, NULL},
    {".r32", "r32", NULL, NULL},
    {".asc", "tiff", "AAIGrid", "an ESRI ASCII grid"},
    {".hgt", "tiff", "SRTMHGT", "a tile of SRTM heights"},
    {".ter", "tiff", "Terragen", "a Terragen terrain"},
    {".dem", "tiff", "USGSDEM", "a USGS DEM"},
    {".bt", "tiff", "BT", "a Binary Terrain"},
};

/* The last line that the program wrote to `fd`. */
static void last_line(int fd, char *out, size_t size)
{
    char said[1000];
    const off_t end = lseek(fd, 0, SEEK_END);
    const size_t n = end > (off_t)sizeof said - 1 ? sizeof said - 1 : (size_t)(end > 0 ? end : 0);
    const ssize_t got = pread(fd, said, n, end - (off_t)n);
    said[got > 0 ? got : 0] = '\0';
    char *tail = said + strlen(said);
    while (tail > said && tail[-1] == '\n')
        *--tail = '\0';
    const char *line = strrchr(said, '\n');
    snprintf(out, size, "%s", line ? line + 1 : said);
}

static status run(const char *file, size_t form, int out, int err)
{
    status st = OK;
    char program[BESIDE_PATH], last[300];
    struct child child = {0};
    struct stat info;
    int how = 0;
    if (!beside_find("hoodoo-read-image", program))
        return fail(E_INPUT, "%s: the program that reads it is missing: " BESIDE_HINT, file,
                    "hoodoo-read-image");
    if (stat(file, &info) != 0 || !S_ISREG(info.st_mode))
        return fail(E_INPUT, "%s: %s", file, errno ? strerror(errno) : "not a regular file");
    const char *const argv[] = {program, TRANSLATE_WORD, forms[form].driver, file, NULL};
    TRY(child_start(&(struct child_options){.argv = argv, .out = out, .err = err}, &child));
    const bool ended = child_wait(&child, 1, 4 * reader_cpu_seconds((uint64_t)info.st_size), &how) == 0;
    child_kill(&child);
    if (!ended)
        return fail(E_INPUT, "%s: converting it takes too long: the file is damaged or hostile", file);
    last_line(err, last, sizeof last);
    if (WIFEXITED(how) && WEXITSTATUS(how) == CHILD_NO_PROGRAM)
        return fail(
            E_INPUT,
            "%s: %s is read through gdal_translate, which is not installed (Debian: gdal-bin). Install it, or convert the file elsewhere: gdal_translate -if %s %s heights.tif",
            file, forms[form].what, forms[form].driver, file);
    if (!WIFEXITED(how) || WEXITSTATUS(how) != 0)
        return fail(E_INPUT, "%s: gdal_translate cannot read it as %s: %s", file, forms[form].what, last);
done:
    return st;
}

static status convert(const char *file, size_t form, struct converted *c)
{
    status st = OK;
    struct stat info = {0};
    const int out = memfd_create("hoodoo-converted", MFD_CLOEXEC),
              err = memfd_create("hoodoo-said", MFD_CLOEXEC);
    if (out < 0 || err < 0) {
        st = fail(E_MEMORY, "%s: no memory for converting it: %s", file, strerror(errno));
        goto done;
    }
    TRY(run(file, form, out, err));
    if (fstat(out, &info) != 0 || info.st_size <= 0) {
        st = fail(E_INPUT, "%s: gdal_translate wrote an empty TIFF", file);
        goto done;
    }
    void *bytes = mmap(NULL, (size_t)info.st_size, PROT_READ, MAP_PRIVATE, out, 0);
    if (bytes == MAP_FAILED) {
        st = fail(E_MEMORY, "%s: no memory for the converted TIFF of %lld bytes", file,
                  (long long)info.st_size);
        goto done;
    }
    c->bytes = bytes;
    c->size = (size_t)info.st_size;
done:
    if (out >= 0)
        close(out);
    if (err >= 0)
        close(err);
    return st;
}

status image_convert(const char *file, struct converted *c)
{
    const char *end = strrchr(file, '.');
    *c = (struct converted){.form = "file"};
    for (size_t i = 0; end && i < sizeof forms / sizeof *forms; i++)
        if (strcasecmp(end, forms[i].end) == 0) {
            c->form = forms[i].form;
            return forms[i].driver ? convert(file, i, c) : OK;
        }
    return OK;
}

void converted_free(struct converted *c)
{
    if (c->bytes)
        munmap(c->bytes, c->size);
    *c = (struct converted){0};
}
