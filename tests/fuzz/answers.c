/* Answers of the readers of meshes, volumes and images, which may have been taken over by a hostile file. The first byte chooses who asks;
 * then come the sizes of the parts, two bytes each, up to a zero, and the parts. With the highest bit set, the rest is the whole answer. */
#include "fuzz/fuzz.h"

#include <sys/mman.h>
#include <unistd.h>

#include "base/log.h"
#include "image/image.h"
#include "meshinput/ask.h"

static int answer_of(const uint8_t *bytes, size_t n, bool whole)
{
    struct reader_head head = {.magic = READER_MAGIC, .version = READER_VERSION};
    size_t at = 0;
    for (; !whole && at + 2 <= n && head.n_parts < READER_PARTS; at += 2) {
        const size_t size = (size_t)(bytes[at] | bytes[at + 1] << 8);
        if (size == 0)
            break;
        head.size[head.n_parts++] = size;
    }
    at = whole ? 0 : at + 2 < n ? at + 2 : n;
    const int fd = memfd_create("fuzz", MFD_CLOEXEC);
    if (fd < 0 || (!whole && write(fd, &head, sizeof head) != (ssize_t)sizeof head) ||
        write(fd, bytes + at, n - at) != (ssize_t)(n - at))
        abort();
    return fd;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    if (n == 0)
        return 0;
    struct reader_answer answer;
    struct mesh_part part;
    struct mesh mesh = {0};
    struct mesh_solid solid = {0};
    struct image image = {0};
    const struct image_request request = {
        .file = "a.exr", .nodata = bytes[0] >> 3 & 3, .height = bytes[0] >> 5 & 1, .scale = 1};
    log_silence(true);
    status st = reader_adopt("a", answer_of(bytes + 1, n - 1, bytes[0] >> 7), &answer);
    if (st == OK && (bytes[0] & 3) < 2)
        st = mesh_take(&answer, bytes[0] & 1, &part, &mesh);
    else if (st == OK && (bytes[0] & 3) == 2)
        st = mesh_take_volume(&answer, &part, &mesh, &solid);
    else if (st == OK)
        st = image_take(&request, &answer, &image);
    fuzz_refused(st);
    for (size_t t = 0; st == OK && t < 3 * mesh.n_triangles; t++)
        if (mesh.triangle[t / 3][t % 3] >= mesh.n_vertices)
            abort();
    if (st == OK && image.width * image.height > 0 && image.value[image.width * image.height - 1] > 1e30F)
        image.value[0] = 0; /* all of them exist */
    mesh_free(&mesh);
    mesh_solid_free(&solid);
    image_free(&image);
    reader_end(&answer);
    return 0;
}
