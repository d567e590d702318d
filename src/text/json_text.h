/* Escapes in JSON texts. */
#ifndef HOODOO_JSON_TEXT_H
#define HOODOO_JSON_TEXT_H

/* Decodes the text between *at and `end`, without its quotes, into `to`, which holds at least end - *at + 1 bytes. Returns NULL on
 * success; otherwise the error, at the position *at. */
const char *json_unescape(const char **at, const char *end, char *to);

#endif
