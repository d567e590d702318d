#include "exr/hash.h"

#include <string.h>

#include "base/hash.h"

/* The start of the attribute in the file: its name, type and length. */
static const char HEAD[] = EXR_HASH_NAME "\0string\0\x10\0\0";
enum { DIGITS = 16, SEARCHED = 1 << 16 };

static char *find_digits(char *bytes, size_t size)
{
    char *head = memmem(bytes, size < SEARCHED ? size : SEARCHED, HEAD, sizeof HEAD);
    if (!head || size - (size_t)(head - bytes) < sizeof HEAD + DIGITS)
        return NULL;
    return head + sizeof HEAD;
}

void exr_hash_set(char *bytes, size_t size)
{
    char text[DIGITS + 1], *digits = find_digits(bytes, size);
    if (digits)
        memcpy(digits, hash_text(hash_bytes(bytes, size), text), DIGITS);
}

bool exr_hash_holds(char *bytes, size_t size)
{
    char text[DIGITS + 1], found[DIGITS], *digits = find_digits(bytes, size);
    if (!digits) /* intact if hoodoo is not mentioned: another program wrote it */
        return !memmem(bytes, size < SEARCHED ? size : SEARCHED, "hoodoo:", 7);
    memcpy(found, digits, DIGITS);
    memcpy(digits, EXR_HASH_NONE, DIGITS);
    return memcmp(found, hash_text(hash_bytes(bytes, size), text), DIGITS) == 0;
}
