/* PLY (Turk 1994): a text header declares elements and their properties; their values follow, as text or binary. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "meshinput/decode.h"

enum ply_type { PLY_NONE, PLY_I8, PLY_U8, PLY_I16, PLY_U16, PLY_I32, PLY_U32, PLY_F32, PLY_F64 };
enum ply_encoding { PLY_ASCII, PLY_LITTLE, PLY_BIG };
enum { PLY_X, PLY_Y, PLY_Z, PLY_CORNERS, PLY_VALUE, PLY_IGNORED };
enum { MAX_ELEMENTS = 16, MAX_PROPERTIES = 64 };

static const size_t type_size[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};

struct property {
    enum ply_type count, type; /* count: PLY_NONE unless a list */
    int role;
    double scale; /* PLY_VALUE: what its values are multiplied by */
};

struct element {
    size_t n;
    bool is_vertex, is_face;
    size_t n_properties;
    struct property property[MAX_PROPERTIES];
};

struct ply {
    struct cursor *r;
    struct mesh *mesh;
    enum ply_encoding encoding;
    size_t n_elements, n_vertices;
    struct element element[MAX_ELEMENTS];
    struct polygon face;
};

/* ---- header */

static enum ply_type type_named(const char *name)
{
    static const struct {
        const char *name;
        enum ply_type type;
    } names[] = {
        {"char", PLY_I8},   {"int8", PLY_I8},     {"uchar", PLY_U8},   {"uint8", PLY_U8},
        {"short", PLY_I16}, {"int16", PLY_I16},   {"ushort", PLY_U16}, {"uint16", PLY_U16},
        {"int", PLY_I32},   {"int32", PLY_I32},   {"uint", PLY_U32},   {"uint32", PLY_U32},
        {"float", PLY_F32}, {"float32", PLY_F32}, {"double", PLY_F64}, {"float64", PLY_F64},
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i].name) == 0)
            return names[i].type;
    return PLY_NONE;
}

/* The factor that makes colours of unsigned integers 0..1, as they are meant; other properties are read as stored. */
static double scale_of(enum ply_type type, const char *name)
{
    static const char *const colors[] = {"red", "green", "blue", "alpha"};
    for (size_t i = 0; i < sizeof colors / sizeof *colors; i++) {
        const size_t n = strlen(name), k = strlen(colors[i]);
        if (n >= k && strcmp(name + n - k, colors[i]) == 0)
            return type == PLY_U8 ? 1 / 255.0 : type == PLY_U16 ? 1 / 65535.0 : 1;
    }
    return 1;
}

static int role_of(const struct element *e, const struct property *p, const char *name,
                   struct attribute *attribute)
{
    if (e->is_vertex && p->count == PLY_NONE && name[0] >= 'x' && name[0] <= 'z' && name[1] == '\0')
        return name[0] - 'x';
    if (e->is_vertex && p->count == PLY_NONE)
        return attribute_is(attribute, name) ? PLY_VALUE : PLY_IGNORED;
    bool corners = strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0;
    return e->is_face && p->count != PLY_NONE && corners ? PLY_CORNERS : PLY_IGNORED;
}

static status read_element(struct ply *ply, const char *line)
{
    char name[64];
    unsigned long long n;
    int used = 0;
    if (sscanf(line, "element %63s %19llu%n", name, &n, &used) != 2 || line[used] != '\0' ||
        strchr(line, '-'))
        return cursor_fail(ply->r, "malformed element: expected 'element NAME COUNT'");
    if (ply->n_elements == MAX_ELEMENTS)
        return cursor_fail(ply->r, "the header has more than %d elements", MAX_ELEMENTS);
    struct element *e = &ply->element[ply->n_elements++];
    e->n = (size_t)n;
    e->is_vertex = strcmp(name, "vertex") == 0;
    e->is_face = strcmp(name, "face") == 0;
    if (e->is_vertex && ply->n_vertices > 0)
        return cursor_fail(ply->r, "the header declares the element vertex twice");
    if (e->is_vertex)
        ply->n_vertices = e->n;
    return OK;
}

static status read_property(struct ply *ply, const char *line)
{
    char type[64], count[64], name[64];
    struct property p = {PLY_NONE, PLY_NONE, PLY_IGNORED, 1};
    if (ply->n_elements == 0)
        return cursor_fail(ply->r, "a property is declared before any element");
    struct element *e = &ply->element[ply->n_elements - 1];
    if (e->n_properties == MAX_PROPERTIES)
        return cursor_fail(ply->r, "an element has more than %d properties", MAX_PROPERTIES);
    if (sscanf(line, "property list %63s %63s %63s", count, type, name) == 3) {
        p.count = type_named(count);
        if (p.count == PLY_NONE || p.count >= PLY_F32)
            return cursor_fail(ply->r, "a list's count must have an integer type, not '%s'", count);
    } else if (sscanf(line, "property %63s %63s", type, name) != 2) {
        return cursor_fail(
            ply->r, "malformed property: expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    }
    p.type = type_named(type);
    if (p.type == PLY_NONE)
        return cursor_fail(ply->r, "unknown type '%s'", type);
    p.role = role_of(e, &p, name, ply->r->attribute);
    p.scale = scale_of(p.type, name);
    for (size_t i = 0; p.role != PLY_IGNORED && i < e->n_properties; i++)
        if (e->property[i].role == p.role)
            return cursor_fail(ply->r, "the property '%s' is declared twice", name);
    e->property[e->n_properties++] = p;
    return OK;
}

static status read_header(struct ply *ply)
{
    struct cursor *r = ply->r;
    status st = OK;
    bool format = false;
    for (;;) {
        char line[256];
        cursor_next_line(r);
        const char *newline = memchr(r->at, '\n', (size_t)(r->end - r->at));
        if (!newline)
            return cursor_fail(r, "the file ends inside the header");
        size_t n = (size_t)(newline - r->at);
        bool comment = n >= 7 && (memcmp(r->at, "comment", 7) == 0 || memcmp(r->at, "obj_inf", 7) == 0);
        if (comment)
            continue;
        if (n >= sizeof line)
            return cursor_fail(r, "a header line is too long: %zu bytes", n);
        memcpy(line, r->at, n);
        while (n > 0 && (line[n - 1] == '\r' || line[n - 1] == ' '))
            n--;
        line[n] = '\0';
        if (strcmp(line, "end_header") == 0)
            break;
        if (strncmp(line, "element ", 8) == 0) {
            TRY(read_element(ply, line));
        } else if (strncmp(line, "property ", 9) == 0) {
            TRY(read_property(ply, line));
        } else if (strncmp(line, "format ", 7) == 0) {
            format = true;
            if (strcmp(line, "format ascii 1.0") == 0)
                ply->encoding = PLY_ASCII;
            else if (strcmp(line, "format binary_little_endian 1.0") == 0)
                ply->encoding = PLY_LITTLE;
            else if (strcmp(line, "format binary_big_endian 1.0") == 0)
                ply->encoding = PLY_BIG;
            else
                return cursor_fail(
                    r, "unknown format '%s': expected ascii, binary_little_endian or binary_big_endian 1.0",
                    line);
        } else if (n > 0) {
            return cursor_fail(r, "'%s' is not a header line of a PLY file", line);
        }
    }
    cursor_next_line(r);
    if (!format)
        st = cursor_fail(r, "the header has no format line");
done:
    return st;
}

/* Can the rest of the file hold what the header declares? Checked before anything is allocated. */
static status check_sizes(const struct ply *ply)
{
    const struct cursor *r = ply->r;
    size_t left = (size_t)(r->end - r->at);
    for (size_t i = 0; i < ply->n_elements; i++) {
        const struct element *e = &ply->element[i];
        size_t smallest = 0, roles = 0;
        for (size_t k = 0; k < e->n_properties; k++) {
            const struct property *p = &e->property[k];
            smallest += ply->encoding == PLY_ASCII ? 2 : type_size[p->count ? p->count : p->type];
            roles |= (size_t)1 << p->role;
        }
        /* The last value of a text file may lack its newline. */
        if (smallest > 0 && e->n > (left + 1) / smallest)
            return cursor_fail(
                r, "the header declares %zu items of at least %zu bytes, but only %zu bytes follow", e->n,
                smallest, left);
        left -= smallest * e->n < left ? smallest * e->n : left;
        if (e->is_vertex && (roles & 7) != 7)
            return cursor_fail(r, "the element vertex lacks x, y or z");
        if (e->is_face && !(roles >> PLY_CORNERS & 1))
            return cursor_fail(r, "the element face lacks vertex_indices");
    }
    return OK;
}

/* ---- values */

static status binary_fail(const struct cursor *r, const char *what)
{
    return fail(E_INPUT, "%s: byte %zu: %s", r->path, (size_t)(r->at - r->begin), what);
}

static status read_binary(struct ply *ply, enum ply_type type, double *out)
{
    struct cursor *r = ply->r;
    size_t n = type_size[type];
    uint64_t bits = 0;
    if ((size_t)(r->end - r->at) < n)
        return binary_fail(r, "the file is truncated");
    for (size_t i = 0; i < n; i++)
        bits |= (uint64_t)(unsigned char)r->at[ply->encoding == PLY_BIG ? n - 1 - i : i] << (8 * i);
    r->at += n;
    uint32_t low = (uint32_t)bits;
    float single;
    switch (type) {
    case PLY_I8:
        *out = (int8_t)bits;
        break;
    case PLY_I16:
        *out = (int16_t)bits;
        break;
    case PLY_I32:
        *out = (int32_t)low;
        break;
    case PLY_F32:
        memcpy(&single, &low, sizeof single);
        *out = (double)single;
        break;
    case PLY_F64:
        memcpy(out, &bits, sizeof bits);
        break;
    default:
        *out = (double)bits;
    }
    return OK;
}

static status read_value(struct ply *ply, enum ply_type type, double *out)
{
    if (ply->encoding != PLY_ASCII)
        return read_binary(ply, type, out);
    while (ply->r->at < ply->r->end && cursor_at_line_end(ply->r))
        cursor_next_line(ply->r);
    return cursor_number(ply->r, out);
}

static status value_fail(const struct ply *ply, const char *what)
{
    return ply->encoding == PLY_ASCII ? cursor_fail(ply->r, "%s", what) : binary_fail(ply->r, what);
}

static status read_list(struct ply *ply, const struct property *p)
{
    status st = OK;
    double n, value;
    ply->face.n = 0;
    TRY(read_value(ply, p->count, &n));
    if (!(n >= 0) || n != floor(n))
        return value_fail(ply, "a list's count is negative or not an integer");
    if (p->role == PLY_CORNERS && n < 3)
        return value_fail(ply, "a face has fewer than 3 corners");
    if (n > (double)(ply->r->end - ply->r->at))
        return value_fail(ply, "a list is longer than the rest of the file");
    for (size_t i = 0; i < (size_t)n; i++) {
        TRY(read_value(ply, p->type, &value));
        if (p->role != PLY_CORNERS)
            continue;
        if (!(value >= 0 && value < (double)ply->n_vertices) || value != floor(value))
            return value_fail(ply, "a face refers to a vertex that does not exist");
        TRY(polygon_add(&ply->face, (uint32_t)value));
    }
    if (p->role == PLY_CORNERS)
        TRY(mesh_add_polygon(ply->mesh, &ply->face));
done:
    return st;
}

static status read_item(struct ply *ply, const struct element *e)
{
    status st = OK;
    double x[3] = {0}, attribute = 0, value;
    bool has = false;
    for (size_t k = 0; k < e->n_properties; k++) {
        const struct property *p = &e->property[k];
        if (p->count != PLY_NONE) {
            TRY(read_list(ply, p));
            continue;
        }
        TRY(read_value(ply, p->type, &value));
        if (p->role == PLY_VALUE && !(fabs(value) <= 1e30))
            return value_fail(ply, "the attribute is not finite or larger than 1e30");
        if (p->role == PLY_VALUE) {
            attribute = value * p->scale;
            has = true;
        }
        if (p->role > PLY_Z)
            continue;
        if (!(fabs(value) <= 1e30))
            return value_fail(ply, "a coordinate is not finite or larger than 1e30");
        x[p->role] = value;
    }
    if (e->is_vertex)
        TRY(mesh_add_vertex(ply->mesh, x));
    if (has)
        TRY(mesh_add_value(ply->mesh, attribute));
done:
    return st;
}

status ply_read(struct cursor *r, struct mesh *mesh)
{
    status st = OK;
    struct ply ply = {.r = r, .mesh = mesh};
    TRY(read_header(&ply));
    TRY(check_sizes(&ply));
    if (ply.n_vertices > UINT32_MAX)
        return cursor_fail(r, "the header declares %zu vertices, more than 2^32 - 1", ply.n_vertices);
    for (size_t i = 0; i < ply.n_elements; i++)
        for (size_t k = 0; k < ply.element[i].n && ply.element[i].n_properties > 0; k++)
            TRY(read_item(&ply, &ply.element[i]));
done:
    polygon_free(&ply.face);
    return st;
}
