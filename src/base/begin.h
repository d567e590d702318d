/* The first thing in main() of each of our programs. */
#ifndef HOODOO_BEGIN_H
#define HOODOO_BEGIN_H

/* What whoever starts us may have left undone: descriptors 0 to 2 are open from here on, so that no file of ours becomes
 * standard output or error; those that were closed are /dev/null, the second so that writing fails. A write past `ulimit -f`
 * fails instead of ending the process. */
void process_begin(void);

#endif
