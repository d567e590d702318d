/* gdal_translate under limits: `hoodoo-read-image translate DRIVER PATH` restricts itself, then executes gdal_translate. The TIFF is
 * written to stdout, errors to stderr.
 *
 * Limits    As for a reader (serve.h): CPU time, memory, size of the output.
 * Calls     As for a reader, and the two that starting a program needs: execve() and executable memory. Files cannot be opened for
 *           writing; there are no sockets and no further processes.
 */
#ifndef HOODOO_READER_TRANSLATE_H
#define HOODOO_READER_TRANSLATE_H

#define TRANSLATE_WORD "translate"

/* Returns an exit code only if it fails: 127 if gdal_translate is not installed. */
int translate(const char *driver, const char *path);

#endif
