/* Fills an HTML template with data, much like Mustache.
 *
 * Tags       {{name}}              the value, escaped for text and for attributes in double quotes
 *            {{%name}}             a path as a URL: percent-encoded, with its slashes
 *            {{&name}}             the value unescaped: HTML that this program has made
 *            {{#name}}..{{/name}}  once if the value exists; for a list, once per item; for an object, with its members
 *            {{^name}}..{{/name}}  once if the value does not exist
 * Values     A name is looked up in the innermost object that has such a member; {{.}} is the item of a list. false, null, "" and
 *            empty lists count as missing.
 * Spaces     Lines lose their indentation, and lines with nothing but a section tag are removed.
 */
#ifndef HOODOO_TEMPLATE_H
#define HOODOO_TEMPLATE_H

#include "text/json.h"
#include "text/text.h"

/* Adds the page to `out`. The last of `lines` is NULL. Unknown names and unclosed sections are programming errors (asserted). */
void template_fill(const char *const *lines, const struct json *data, struct text *out);

#endif
