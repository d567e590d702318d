/* Pages from a template and data: the HTML in one place, what it shows in another.
 *
 * Tags       {{name}}              the value, escaped: fit for text and for attributes in double quotes
 *            {{%name}}             a path as an address: percent-encoded, slashes kept
 *            {{&name}}             the value as it is: HTML that this program made
 *            {{#name}}..{{/name}}  once if there is a value; of a list, once an item; of an object, with its members
 *            {{^name}}..{{/name}}  once if there is none
 * Values     Members of the data, of the innermost object that has one of that name; {{.}} is a list's own item. false,
 *            null, "" and empty lists are no values.
 * Spaces     The template's lines lose their indentation, and lines of nothing but a section's tag vanish.
 */
#ifndef HOODOO_TEMPLATE_H
#define HOODOO_TEMPLATE_H

#include "base/json.h"
#include "base/text.h"

/* Adds the page to `out`. `lines` end with NULL. A name that the data do not have is our mistake, and so is a section
 * that does not end: asserted. */
void template_fill(const char *const *lines, const struct json *data, struct text *out);

#endif
