#include "usd/crate.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "job/job.h"
#include "text/text.h"

/* ---- the container */

enum { BOOTSTRAP = 88, SECTION_NAME = 16 };
enum value_type { TOKEN_VECTOR = 41, SPECIFIER = 42, TIME_SAMPLES = 46, DOUBLE_VECTOR = 48 };
enum spec_type { SPEC_ATTRIBUTE = 1, SPEC_PRIM = 6, SPEC_ROOT = 7 };
static const uint64_t ARRAY = 1ULL << 63, INLINED = 1ULL << 62;

enum {
    MAX_TOKENS = 32 + 2 * USD_ATTRIBUTES_MAX,
    MAX_FIELDS = 32 + 3 * USD_ATTRIBUTES_MAX,
    MAX_SPECS = 2 + USD_ATTRIBUTES_MAX
};

struct crate {
    const struct usd_prim *prim;
    struct draft *out;
    status st; /* the first error */
    const char *token[MAX_TOKENS];
    uint32_t n_tokens, n_fields, n_set, n_specs;
    uint32_t field_token[MAX_FIELDS];
    uint64_t field_value[MAX_FIELDS];
    uint32_t set[MAX_FIELDS + MAX_SPECS]; /* fields of a spec, ended by END_OF_SET */
    uint32_t spec[MAX_SPECS][3];          /* path, index of its field set, type */
};
static const uint32_t END_OF_SET = UINT32_MAX;

static void add(struct crate *c, const void *bytes, size_t n)
{
    if (c->st == OK)
        c->st = draft_append(c->out, bytes, n);
}

static void add_u64(struct crate *c, uint64_t value)
{
    add(c, &value, sizeof value);
}

static void align(struct crate *c)
{
    static const char zero[8] = {0};
    add(c, zero, (8 - c->out->size % 8) % 8);
}

static uint32_t token(struct crate *c, const char *text)
{
    for (uint32_t i = 0; i < c->n_tokens; i++)
        if (strcmp(c->token[i], text) == 0)
            return i;
    assert(c->n_tokens < MAX_TOKENS);
    c->token[c->n_tokens] = text;
    return c->n_tokens++;
}

/* A value: its type, and its offset or, if inlined, the value itself. */
static uint64_t value(enum value_type type, uint64_t payload)
{
    return (uint64_t)type << 48 | payload;
}

static uint64_t token_value(struct crate *c, const char *text)
{
    return INLINED | value((enum value_type)USD_TOKEN, token(c, text));
}

static uint64_t double_value(struct crate *c, double number)
{
    align(c);
    const uint64_t at = c->out->size;
    add(c, &number, sizeof number);
    return value((enum value_type)USD_DOUBLE, at);
}

static uint64_t tokens_value(struct crate *c, const char *const *text, size_t n)
{
    align(c);
    const uint64_t at = c->out->size;
    add_u64(c, n);
    for (size_t i = 0; i < n; i++) {
        const uint32_t t = token(c, text[i]);
        add(c, &t, sizeof t);
    }
    return value(TOKEN_VECTOR, at);
}

/* Adds items that are made a few at a time. */
static void add_made(struct crate *c, const struct usd_items *items, size_t size)
{
    enum { TOGETHER = 1 << 16 };
    char *some = NULL;
    if (c->st == OK)
        c->st = memory_alloc(items->n < TOGETHER ? items->n : TOGETHER, size, "a file's values", &some);
    for (size_t first = 0; first < items->n && c->st == OK; first += TOGETHER) {
        const size_t n = items->n - first < TOGETHER ? items->n - first : TOGETHER;
        items->make(items->user, first, n, some);
        add(c, some, n * size);
    }
    free(some);
}

/* Adds an array: the number of items, then the items, aligned to 8 bytes, so that USD can map them. */
static uint64_t array_value(struct crate *c, enum usd_type type, const struct usd_items *items, size_t size)
{
    if (items->n == 0)
        return ARRAY | value((enum value_type)type, 0);
    align(c);
    const uint64_t at = c->out->size;
    add_u64(c, items->n);
    if (items->make)
        add_made(c, items, size);
    else
        add(c, items->at, items->n * size);
    return ARRAY | value((enum value_type)type, at);
}

/* Adds one time sample. Both of its parts begin with the distance to what follows them. */
static uint64_t sample_value(struct crate *c, double time, uint64_t sample)
{
    align(c);
    const uint64_t times = c->out->size;
    add_u64(c, 1);
    add(c, &time, sizeof time);
    const uint64_t at = c->out->size;
    add_u64(c, 8);
    add_u64(c, value(DOUBLE_VECTOR, times));
    add_u64(c, 8);
    add_u64(c, 1);
    add_u64(c, sample);
    return value(TIME_SAMPLES, at);
}

static void spec(struct crate *c, uint32_t path, enum spec_type type)
{
    const uint32_t row[3] = {path, c->n_set, type};
    assert(c->n_specs < MAX_SPECS);
    memcpy(c->spec[c->n_specs++], row, sizeof row);
}

static void field(struct crate *c, const char *name, uint64_t value_of)
{
    assert(c->n_fields < MAX_FIELDS);
    c->field_token[c->n_fields] = token(c, name);
    c->field_value[c->n_fields] = value_of;
    c->set[c->n_set++] = c->n_fields++;
}

static void end_spec(struct crate *c)
{
    c->set[c->n_set++] = END_OF_SET;
}

/* ---- sections */

/* Adds bytes as an LZ4 block of literals only: its size, a byte that says there is one block, and the block. */
static void add_packed(struct crate *c, const void *bytes, size_t n)
{
    static const unsigned char more = 255;
    const unsigned char head[2] = {0, (unsigned char)((n < 15 ? n : 15) << 4)};
    const size_t lengths = n < 15 ? 0 : (n - 15) / 255 + 1;
    add_u64(c, sizeof head + lengths + n);
    add(c, head, sizeof head);
    for (size_t i = 0; i + 1 < lengths; i++)
        add(c, &more, 1);
    if (lengths) {
        const unsigned char rest = (unsigned char)((n - 15) % 255);
        add(c, &rest, 1);
    }
    add(c, bytes, n);
}

/* Adds every stride-th of the words in USD's integer coding, as differences of 32 bits each: the most common difference (not used here),
 * two bits per difference (3: 32 bits), then the differences. */
static void add_integers(struct crate *c, const uint32_t *word, uint32_t n, size_t stride)
{
    enum { MOST = 2 * MAX_FIELDS };
    uint32_t packed[1 + MOST / 16 + 1 + MOST], before = 0;
    const size_t codes = (n * 2 + 7) / 8;
    unsigned char *at = (unsigned char *)packed;
    assert(n <= MOST);
    memset(packed, 0, 4);
    memset(at + 4, 0xff, codes);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t difference = word[i * stride] - before;
        before = word[i * stride];
        memcpy(at + 4 + codes + 4 * (size_t)i, &difference, 4);
    }
    add_packed(c, packed, 4 + codes + 4 * (size_t)n);
}

static void add_tokens(struct crate *c)
{
    struct text names = {0};
    for (uint32_t i = 0; i < c->n_tokens; i++)
        text_add_bytes(&names, c->token[i], strlen(c->token[i]) + 1);
    add_u64(c, c->n_tokens);
    add_u64(c, names.size);
    add_packed(c, names.data, names.size);
    if (c->st == OK)
        c->st = text_status(&names);
    text_free(&names);
}

static void add_strings(struct crate *c)
{
    add_u64(c, 0);
}

static void add_fields(struct crate *c)
{
    add_u64(c, c->n_fields);
    add_integers(c, c->field_token, c->n_fields, 1);
    add_packed(c, c->field_value, c->n_fields * sizeof *c->field_value);
}

static void add_fieldsets(struct crate *c)
{
    add_u64(c, c->n_set);
    add_integers(c, c->set, c->n_set, 1);
}

/* Adds the tree of paths, depth first: the root, its only prim, and the prim's attributes. Names of properties are negative. A jump tells
 * what follows: -1 a child, 0 a sibling, -2 neither. */
static void add_paths(struct crate *c)
{
    uint32_t row[MAX_SPECS][3];
    for (uint32_t i = 0; i < c->n_specs; i++) {
        const bool property = i >= 2;
        const uint32_t name =
            i == 0 ? 0 : token(c, property ? c->prim->attribute[i - 2].name : c->prim->name);
        row[i][0] = i;
        row[i][1] = property ? 0 - name : name;
        row[i][2] = (uint32_t)(!property ? -1 : i + 1 < c->n_specs ? 0 : -2);
    }
    add_u64(c, c->n_specs); /* number of paths, and of paths in the tree */
    add_u64(c, c->n_specs);
    for (int column = 0; column < 3; column++)
        add_integers(c, &row[0][column], c->n_specs, 3);
}

static void add_specs(struct crate *c)
{
    add_u64(c, c->n_specs);
    for (int column = 0; column < 3; column++)
        add_integers(c, &c->spec[0][column], c->n_specs, 3);
}

static void add_sections(struct crate *c)
{
    static const struct {
        const char *name;
        void (*add)(struct crate *c);
    } sections[] = {{"TOKENS", add_tokens},       {"STRINGS", add_strings}, {"FIELDS", add_fields},
                    {"FIELDSETS", add_fieldsets}, {"PATHS", add_paths},     {"SPECS", add_specs}};
    enum { N = sizeof sections / sizeof *sections };
    struct {
        char name[SECTION_NAME];
        uint64_t start, size;
    } table[N] = {0};
    for (size_t i = 0; i < N; i++) {
        align(c);
        memcpy(table[i].name, sections[i].name, strlen(sections[i].name));
        table[i].start = c->out->size;
        sections[i].add(c);
        table[i].size = c->out->size - table[i].start;
    }
    align(c);
    const uint64_t at = c->out->size;
    add_u64(c, N);
    add(c, table, sizeof table);
    if (c->st == OK)
        c->st = draft_replace(c->out, 16, &at, sizeof at);
}

/* ---- the prim */

static void add_attribute(struct crate *c, uint32_t which, const struct usd_items *items, int frame)
{
    const struct usd_attribute *a = &c->prim->attribute[which];
    const uint64_t array = array_value(c, a->value, items, a->size);
    spec(c, which + 2, SPEC_ATTRIBUTE);
    field(c, "typeName", token_value(c, a->type));
    if (*a->interpolation)
        field(c, "interpolation", token_value(c, a->interpolation));
    field(c, "timeSamples", sample_value(c, frame, array));
    end_spec(c);
}

static void add_prims(struct crate *c, int up, int frame, double fps)
{
    const struct usd_prim *p = c->prim;
    const char *attribute[USD_ATTRIBUTES_MAX];
    for (size_t i = 0; i < p->n; i++)
        attribute[i] = p->attribute[i].name;
    spec(c, 0, SPEC_ROOT);
    field(c, "defaultPrim", token_value(c, p->name));
    field(c, "endTimeCode", double_value(c, frame));
    field(c, "metersPerUnit", double_value(c, 1));
    field(c, "primChildren", tokens_value(c, &p->name, 1));
    field(c, "startTimeCode", double_value(c, frame));
    field(c, "timeCodesPerSecond", double_value(c, fps));
    field(c, "upAxis", token_value(c, up == OUTPUT_UP_Y ? "Y" : "Z"));
    end_spec(c);
    spec(c, 1, SPEC_PRIM);
    field(c, "properties", tokens_value(c, attribute, p->n));
    field(c, "specifier", INLINED | value(SPECIFIER, 0));
    field(c, "typeName", token_value(c, p->type));
    end_spec(c);
}

/* ---- attributes of a prim */

void usd_prim_add(struct usd_prim *prim, int which[USD_ATTRIBUTES_MAX], struct usd_attribute attribute,
                  int is)
{
    size_t i = prim->n++;
    for (; i > 0 && strcmp(prim->attribute[i - 1].name, attribute.name) > 0; i--) {
        prim->attribute[i] = prim->attribute[i - 1];
        which[i] = which[i - 1];
    }
    prim->attribute[i] = attribute;
    which[i] = is;
}

struct usd_attribute usd_primvar(enum value_id value)
{
    static const char *const name[VALUES] = {
        "",
#define VALUE(name, unit, symbol, of, from, kind, has, where, bits, layer, channels, legend, meaning)        \
    "primvars:" #name,
#include "job/values.def"
    };
    return value_table[value].kind == KIND_ID
               ? (struct usd_attribute){name[value], "int[]", USD_INT, 4, "vertex"}
               : (struct usd_attribute){name[value], "float[]", USD_FLOAT, 4, "vertex"};
}

status usd_crate(const struct usd_prim *prim, const struct usd_items *items, int up, int frame, double fps,
                 struct draft *out)
{
    static const unsigned char head[BOOTSTRAP] = {'P', 'X', 'R', '-', 'U', 'S', 'D', 'C', 0, 8, 0};
    struct crate c = {.prim = prim, .out = out};
    add(&c, head, sizeof head);
    token(&c, "defaultPrim"); /* token 0 has no negative, so it must not be the name of a property */
    add_prims(&c, up, frame, fps);
    for (uint32_t a = 0; a < prim->n; a++)
        add_attribute(&c, a, &items[a], frame);
    /* All tokens are known now, so the sections can be written. */
    add_sections(&c);
    return c.st;
}
