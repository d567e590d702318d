/* Reading large files of other programs as shapes: a mesh of 1.3 million triangles, and an image of 8192 x 8192 pixels. CPU time counts
 * the decoders' processes. The goal for the mesh is 1.3 times what the flood fill took that the winding number has replaced, 16.1 s on
 * two busy cores of 2026, on which the present code takes 18.8 s. */
#include <math.h>
#include <sys/resource.h>
#include <unistd.h>

#include "bench/bench.h"
#include "job/job.h"
#include "scene/scene.h"

enum { REPEATS = 3, RINGS = 571, SIDES = 1142, PIXELS = 8192 };

static double cpu_seconds(void)
{
    double sum = 0;
    for (int who = RUSAGE_CHILDREN; who <= RUSAGE_SELF; who++) {
        struct rusage r;
        getrusage(who, &r);
        sum += (double)(r.ru_utime.tv_sec + r.ru_stime.tv_sec) +
               1e-6 * (double)(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
    }
    return sum;
}

/* A bumpy ball of 90 m, as binary PLY. */
static void write_ply(FILE *f)
{
    const size_t n_vertices = 2 + (RINGS - 1) * (size_t)SIDES, n_faces = 2 * (RINGS - 1) * (size_t)SIDES;
    fprintf(f,
            "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty float x\nproperty float y\n"
            "property float z\nelement face %zu\nproperty list uchar int vertex_indices\nend_header\n",
            n_vertices, n_faces);
    for (size_t i = 0; i < n_vertices; i++) {
        const size_t ring = i == 0 ? 0 : i == n_vertices - 1 ? RINGS : (i - 1) / SIDES + 1;
        const double theta = M_PI * (double)ring / RINGS,
                     phi = 2 * M_PI * (double)((i + SIDES - 1) % SIDES) / SIDES;
        const double radius = 45 + sin(20 * theta) * sin(theta) * sin(23 * phi);
        const float x[3] = {(float)(50 + radius * sin(theta) * cos(phi)),
                            (float)(50 + radius * sin(theta) * sin(phi)), (float)(50 + radius * cos(theta))};
        fwrite(x, sizeof x, 1, f);
    }
    for (size_t ring = 0; ring < RINGS; ring++)
        for (size_t s = 0; s < SIDES; s++) {
            const size_t next = (s + 1) % SIDES;
            const int32_t a = (int32_t)(1 + (ring - 1) * SIDES + s),
                          b = (int32_t)(1 + (ring - 1) * SIDES + next);
            const int32_t c = (int32_t)(1 + ring * SIDES + s), d = (int32_t)(1 + ring * SIDES + next);
            const int32_t upper[3] = {a, d, b}, lower[3] = {a, c, d};
            const int32_t top[3] = {0, c, d}, bottom[3] = {a, (int32_t)n_vertices - 1, b};
            for (int k = 0; k < 2; k++) {
                const int32_t *t = ring == 0 ? top : ring == RINGS - 1 ? bottom : k ? upper : lower;
                if (k == 1 && (ring == 0 || ring == RINGS - 1))
                    break;
                fputc(3, f);
                fwrite(t, sizeof *t, 3, f);
            }
        }
}

static void put(FILE *f, const char *name, const char *type, const void *value, uint32_t size)
{
    fwrite(name, 1, strlen(name) + 1, f);
    fwrite(type, 1, strlen(type) + 1, f);
    fwrite(&size, 4, 1, f);
    fwrite(value, 1, size, f);
}

/* Hills, as uncompressed floats. */
static void write_exr(FILE *f)
{
    static const unsigned char channel[] = "Y\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0";
    const int32_t window[4] = {0, 0, PIXELS - 1, PIXELS - 1};
    const float one = 1, middle[2] = {0, 0};
    fwrite("\x76\x2f\x31\x01\2\0\0", 1, 8, f);
    put(f, "channels", "chlist", channel, sizeof channel);
    put(f, "compression", "compression", "", 1);
    put(f, "dataWindow", "box2i", window, sizeof window);
    put(f, "displayWindow", "box2i", window, sizeof window);
    put(f, "lineOrder", "lineOrder", "", 1);
    put(f, "pixelAspectRatio", "float", &one, 4);
    put(f, "screenWindowCenter", "v2f", middle, 8);
    put(f, "screenWindowWidth", "float", &one, 4);
    fputc(0, f);
    const uint64_t first = (uint64_t)ftello(f) + 8 * (uint64_t)PIXELS;
    for (uint64_t y = 0; y < PIXELS; y++)
        fwrite(&(uint64_t){first + y * (8 + 4 * (uint64_t)PIXELS)}, 8, 1, f);
    for (int32_t y = 0; y < PIXELS; y++) {
        static float row[PIXELS];
        for (int x = 0; x < PIXELS; x++)
            row[x] = 0.5F + 0.4F * sinf(0.002F * (float)x) * sinf(0.003F * (float)y);
        fwrite((const int32_t[]){y, 4 * PIXELS}, 4, 2, f);
        fwrite(row, 4, PIXELS, f);
    }
}

/* Makes the shape of a file that was just written, and so is in the page cache. */
static struct samples measure(void (*write)(FILE *), const char *ending, const char *shape)
{
    struct samples s = {0};
    char file[64], job_file[64], text[600];
    struct job *job = NULL;
    snprintf(file, sizeof file, "/tmp/hoodoo-bench.%d%s", (int)getpid(), ending);
    snprintf(job_file, sizeof job_file, "/tmp/hoodoo-bench.%d.yaml", (int)getpid());
    FILE *f = fopen(file, "wb");
    if (!f)
        check(fail(E_OUTPUT, "%s: %s", file, strerror(errno)));
    write(f);
    fclose(f);
    snprintf(
        text, sizeof text,
        "name: bench\nframes: 1-2\ndomain: {size_m: [100, 100, 100], spacing_m: 0.5}\nscene: {%s: {file: %s%s}}\n",
        shape, file, *shape == 'h' ? ", max_m: [100, 100, 60]" : "");
    f = fopen(job_file, "w");
    fputs(text, f);
    fclose(f);
    check(job_load(job_file, NULL, 0, &job));
    for (int i = 0; i < REPEATS; i++) {
        struct solid *solid = NULL;
        const double start = cpu_seconds();
        check(solid_create(job->scene, 0.25, 1.75, &solid));
        sample(&s, cpu_seconds() - start);
        solid_destroy(&solid);
    }
    job_destroy(&job);
    unlink(file);
    unlink(job_file);
    return s;
}

int main(void)
{
    struct row mesh = {
        .name = "files: mesh of 1.3 million triangles (PLY)", .unit = "s of CPU", .at_most = 21};
    struct row image = {
        .name = "files: image of 8192 x 8192 pixels (EXR)", .unit = "s of CPU", .at_most = 15};
    mesh.ours = measure(write_ply, ".ply", "mesh");
    print_row(&mesh);
    image.ours = measure(write_exr, ".exr", "heightfield");
    print_row(&image);
    return 0;
}
