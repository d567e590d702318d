/* embed_kernels OUT SHADER...: a program of the build. It compiles each shader to SPIR-V in three variants and validates them. One
 * process compiles all shaders of a folder, because glslang needs more time to set up its built-in functions than to compile a
 * shader. It writes
 *
 *   OUT.spv   the SPIR-V of all variants, one after the other
 *   OUT.c     a struct kernel_source (gpu/kernel_source.h) for each shader, which includes OUT.spv
 *   OUT.d     the files that were read, for make
 *
 * A shader declares each buffer on a line of its own, as READ_F(0, name), WRITE_V(1, name) and so on (shaders/shared/buffers.glsl).
 * The letters become a string such as "rF wV ", from which the dispatch wrapper knows how to bind the buffers. */
#include <errno.h>
#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <spirv-tools/libspirv.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VARIANTS = 3, BINDINGS = 16, DEEPEST = 16, PATHS = 1024 };
static const char *const variant_name[VARIANTS] = {"texel", "storage", "wide"};

static _Noreturn void die(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vfprintf(stderr, format, args);
    va_end(args);
    fputc('\n', stderr);
    exit(1);
}

/* A growing array of bytes, terminated by 0. */
struct bytes {
    char *p;
    size_t n;
};

static void add(struct bytes *b, const void *p, size_t n)
{
    b->p = realloc(b->p, b->n + n + 1);
    if (!b->p)
        die("embed_kernels: out of memory");
    if (n)
        memcpy(b->p + b->n, p, n);
    b->n += n;
    b->p[b->n] = 0;
}

static struct bytes read_all(const char *path)
{
    struct bytes all = {0};
    char part[1 << 14];
    size_t n;
    FILE *f = fopen(path, "rb");
    if (!f)
        die("%s: %s", path, strerror(errno));
    while ((n = fread(part, 1, sizeof part, f)) > 0)
        add(&all, part, n);
    if (ferror(f))
        die("%s: cannot be read", path);
    fclose(f);
    add(&all, "", 0);
    return all;
}

static FILE *open_output(const char *out, const char *ending, char path[FILENAME_MAX])
{
    snprintf(path, FILENAME_MAX, "%s%s", out, ending);
    FILE *f = fopen(path, "wb");
    if (!f)
        die("%s: %s", path, strerror(errno));
    return f;
}

static void close_output(FILE *f, const char *path)
{
    if (ferror(f) | fclose(f))
        die("%s: cannot be written", path);
}

/* The files that were read, each once. */
static char *seen[PATHS];
static int n_seen;

static void remember(const char *path)
{
    for (int i = 0; i < n_seen; i++)
        if (strcmp(seen[i], path) == 0)
            return;
    if (n_seen == PATHS || !(seen[n_seen] = strdup(path)))
        die("%s: too many files", path);
    n_seen++;
}

/* Appends the text of a shader, with its includes expanded. Includes are relative to shaders/. */
static void flatten(const char *path, struct bytes *text, int depth)
{
    if (depth == DEEPEST)
        die("%s: files include each other", path);
    remember(path);
    struct bytes own = read_all(path);
    int number = 1;
    for (char *line = own.p, *end; *line; line = end, number++) {
        char name[256], at[FILENAME_MAX];
        end = strchr(line, '\n');
        end = end ? end + 1 : line + strlen(line);
        const int include = sscanf(line, "#include \"%255[^\"\n]", name) == 1;
        if (!include) {
            add(text, line, (size_t)(end - line));
        } else {
            snprintf(at, sizeof at, "shaders/%s", name);
            add(text, "#line 1 \"", 9);
            add(text, at, strlen(at));
            add(text, "\"\n", 2);
            flatten(at, text, depth + 1);
        }
        if (include || (depth == 0 && number == 1)) {
            snprintf(at, sizeof at, "#line %d \"%s\"\n", number + 1, path);
            add(text, at, strlen(at));
        }
    }
    free(own.p);
}

static void validate(const char *path, const char *variant, const uint32_t *words, size_t n)
{
    spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_2);
    spv_validator_options options = spvValidatorOptionsCreate();
    spvValidatorOptionsSetScalarBlockLayout(options, true);
    spv_const_binary_t binary = {.code = words, .wordCount = n};
    spv_diagnostic wrong = NULL;
    if (spvValidateWithOptions(context, options, &binary, &wrong) != SPV_SUCCESS)
        die("%s (%s): not valid SPIR-V: %s", path, variant, wrong ? wrong->error : "unknown");
    spvDiagnosticDestroy(wrong);
    spvValidatorOptionsDestroy(options);
    spvContextDestroy(context);
}

/* Appends the SPIR-V of one variant to `spv` and returns its size in bytes. */
static size_t compile(const char *path, const char *text, const char *variant, struct bytes *spv)
{
    char define[128];
    snprintf(define, sizeof define,
             "#extension GL_GOOGLE_cpp_style_line_directive : require\n#define VARIANT_%s 1\n", variant);
    struct bytes code = {0};
    const char *body = strchr(text, '\n'); /* #version must come first */
    body = body ? body + 1 : text;
    add(&code, text, (size_t)(body - text));
    add(&code, define, strlen(define));
    add(&code, body, strlen(body));
    const int rules = GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT;
    const glslang_input_t input = {.language = GLSLANG_SOURCE_GLSL,
                                   .stage = GLSLANG_STAGE_COMPUTE,
                                   .client = GLSLANG_CLIENT_VULKAN,
                                   .client_version = GLSLANG_TARGET_VULKAN_1_2,
                                   .target_language = GLSLANG_TARGET_SPV,
                                   .target_language_version = GLSLANG_TARGET_SPV_1_5,
                                   .code = code.p,
                                   .default_version = 460,
                                   .default_profile = GLSLANG_NO_PROFILE,
                                   .messages = (glslang_messages_t)rules,
                                   .resource = glslang_default_resource()};
    glslang_shader_t *shader = glslang_shader_create(&input);
    if (!glslang_shader_preprocess(shader, &input) || !glslang_shader_parse(shader, &input))
        die("%s (%s):\n%s", path, variant, glslang_shader_get_info_log(shader));
    glslang_program_t *program = glslang_program_create();
    glslang_program_add_shader(program, shader);
    if (!glslang_program_link(program, rules) || !glslang_program_map_io(program))
        die("%s (%s):\n%s", path, variant, glslang_program_get_info_log(program));
    glslang_program_SPIRV_generate(program, GLSLANG_STAGE_COMPUTE);
    const char *said = glslang_program_SPIRV_get_messages(program);
    if (said && *said)
        die("%s (%s): %s", path, variant, said);
    const size_t n = glslang_program_SPIRV_get_size(program);
    validate(path, variant, glslang_program_SPIRV_get_ptr(program), n);
    add(spv, glslang_program_SPIRV_get_ptr(program), n * sizeof(uint32_t));
    glslang_program_delete(program);
    glslang_shader_delete(shader);
    free(code.p);
    return n * sizeof(uint32_t);
}

/* The string of buffers by binding, such as "rF wV ", from the shader's own lines. */
static void find_bindings(const char *path, char out[3 * BINDINGS + 1])
{
    struct bytes own = read_all(path);
    char kind[BINDINGS] = {0}, type[BINDINGS] = {0}, word[6], letter;
    unsigned at;
    for (char *line = own.p; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (sscanf(line, "%5[A-Z]_%c(%u,", word, &letter, &at) == 3 && strchr("FUV", letter) &&
            (strcmp(word, "READ") == 0 || strcmp(word, "WRITE") == 0)) {
            if (at >= BINDINGS || kind[at])
                die("%s: binding %u is one too many", path, at);
            kind[at] = word[0] == 'R' ? 'r' : 'w';
            type[at] = letter;
        }
    }
    for (at = 0; at < BINDINGS; at++)
        if (kind[at])
            out += sprintf(out, "%c%c ", kind[at], type[at]);
    *out = 0;
    free(own.p);
}

/* The name of a kernel: stress_dot for shaders/stress/dot.comp.glsl. */
static void kernel_name(const char *path, char name[FILENAME_MAX])
{
    snprintf(name, FILENAME_MAX, "%s", strncmp(path, "shaders/", 8) == 0 ? path + 8 : path);
    char *end = strstr(name, ".comp.glsl");
    if (!end)
        die("%s: not a shader's name", path);
    *end = 0;
    for (char *slash; (slash = strchr(name, '/'));)
        *slash = '_';
}

static void embed(const char *path, struct bytes *spv, FILE *c)
{
    char bindings[3 * BINDINGS + 1], name[FILENAME_MAX];
    struct bytes text = {0};
    size_t start[VARIANTS], size[VARIANTS];
    flatten(path, &text, 0);
    find_bindings(path, bindings);
    kernel_name(path, name);
    for (int v = 0; v < VARIANTS; v++) {
        start[v] = spv->n / sizeof(uint32_t);
        size[v] = compile(path, text.p, variant_name[v], spv);
    }
    fprintf(
        c,
        "const struct kernel_source kernel_%s = {\"%s\", \"%s\", {words + %zu, words + %zu, words + %zu}, {%zu, %zu, %zu}};\n",
        name, name, bindings, start[0], start[1], start[2], size[0], size[1], size[2]);
    free(text.p);
}

int main(int argc, char **argv)
{
    if (argc < 3)
        die("usage: embed_kernels OUT SHADER...");
    char c_path[FILENAME_MAX], made[FILENAME_MAX], path[FILENAME_MAX];
    struct bytes spv = {0};
    snprintf(c_path, sizeof c_path, "%s.c", argv[1]);
    FILE *c = open_output(argv[1], ".c.tmp", made);
    fprintf(
        c,
        "/* Made by src/embed_kernels.c. */\n#include \"gpu/kernel_source.h\"\n\n"
        "/* The words of %s.spv are the assembler's: a compiler takes seconds to read them as numbers. */\n"
        "__asm__(\".section .rodata\\n.balign 4\\n.Lwords:\\n.incbin \\\"%s.spv\\\"\\n.previous\\n\");\n"
        "extern const uint32_t words[] __asm__(\".Lwords\");\n\n",
        argv[1], argv[1]);
    glslang_initialize_process();
    for (int i = 2; i < argc; i++)
        embed(argv[i], &spv, c);
    glslang_finalize_process();
    close_output(c, made);

    FILE *f = open_output(argv[1], ".spv", path);
    fwrite(spv.p, 1, spv.n, f);
    close_output(f, path);
    f = open_output(argv[1], ".d", path);
    fprintf(f, "%s:", c_path);
    for (int i = 0; i < n_seen; i++)
        fprintf(f, " %s", seen[i]);
    for (int i = 0; i < n_seen; i++) /* empty rules, so that make does not fail when a file was deleted */
        fprintf(f, "\n%s:", seen[i]);
    fputc('\n', f);
    close_output(f, path);
    if (rename(made, c_path) != 0) /* last, because make looks at this file */
        die("%s: %s", c_path, strerror(errno));
    free(spv.p);
    return 0;
}
