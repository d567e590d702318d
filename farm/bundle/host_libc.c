/* Succeeds if the machine's C library is at least as new as the one it was compiled with (launch.c). */
#include <gnu/libc-version.h>
#include <stdlib.h>

int main(void)
{
    char *minor;
    const unsigned long major = strtoul(gnu_get_libc_version(), &minor, 10);
    return !(major > __GLIBC__ || (major == __GLIBC__ && strtoul(minor + 1, NULL, 10) >= __GLIBC_MINOR__));
}
