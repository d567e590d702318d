/* Linked into what the sanitizers watch: a library that was loaded stays. What Mesa keeps when its driver is unloaded would
 * otherwise be reported when nobody knows any more whose code it was, and no suppression could name it. */
#include <dlfcn.h>

int dlclose(void *library)
{
    (void)library;
    return 0;
}
