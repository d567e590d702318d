/* gdal_translate under limits: hoodoo-read-image TRANSLATE_WORD DRIVER PATH sets them, on itself, and becomes it. The TIFF goes to
 * stdout, what is wrong to stderr.
 *
 * Limits    As a reader's (serve.h): CPU time, memory, the size of what is written.
 * Calls     As a reader's, and the two that starting a program takes: execve(), and memory that becomes code. No file is opened for
 *           writing, there are no sockets and no further processes.
 */
#ifndef HOODOO_READER_TRANSLATE_H
#define HOODOO_READER_TRANSLATE_H

#define TRANSLATE_WORD "translate"

/* Returns an exit code where it fails: 127 if there is no gdal_translate. */
int translate(const char *driver, const char *path);

#endif
