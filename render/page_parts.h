/* report.html, style.css, script.js and look.html of this folder, embedded as lines; the last line is NULL. */
#ifndef HOODOO_PAGE_PARTS_H
#define HOODOO_PAGE_PARTS_H

#include <stddef.h>

extern const char *const page_report[];
extern const char *const page_style[];
extern const char *const page_script[];
extern const char *const page_look[];

#endif
