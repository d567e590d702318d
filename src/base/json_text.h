/* What stands between the quotes of a JSON text. */
#ifndef HOODOO_JSON_TEXT_H
#define HOODOO_JSON_TEXT_H

/* Undoes the escapes between *at and `end`; `to` has room for end - *at + 1 bytes. Returns NULL,
 * or what is wrong, and *at is where. */
const char *json_unescape(const char **at, const char *end, char *to);

#endif
