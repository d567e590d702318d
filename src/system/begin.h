/* Setup at the start of main() of each program. */
#ifndef HOODOO_BEGIN_H
#define HOODOO_BEGIN_H

/* Opens descriptors 0 to 2 on /dev/null if the parent process closed them, so that no other file takes their place; standard output is
 * then opened for reading, so that writes to it fail. A write beyond `ulimit -f` fails instead of killing the process. Under
 * `ulimit -v` a crash, of a driver without memory, ends with the exit code of E_MEMORY. */
void process_begin(void);

#endif
