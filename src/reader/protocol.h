/* What passes between hoodoo and its readers: programs that decode one file of somebody else's, and end.
 *
 * Asked     hoodoo-read KIND PATH WORD...  Descriptor 3 is an empty file in memory for the answer, descriptor 4 (of some
 *           kinds) one with input. Both programs come from one build, so that structs are the same for both.
 * Answered  a head, then the parts it counts, one behind the other. What parts a kind has stands where it is read
 *           (vdb/serve.h, scene/image.c).
 * Trust     None: whoever asks checks every size and number. What decodes has read hostile bytes.
 */
#ifndef HOODOO_READER_PROTOCOL_H
#define HOODOO_READER_PROTOCOL_H

#include <stdint.h>

enum { READER_ANSWER_FD = 3, READER_INPUT_FD = 4, READER_VERSION = 1, READER_PARTS = 64 };

/* Where what a reader is given beside the file can be opened. */
#define READER_INPUT_PATH "/proc/self/fd/4"

#define READER_MAGIC UINT64_C(0x7265616465724168)

struct reader_head {
    uint64_t magic;
    uint32_t version;
    int32_t status; /* enum status */
    char message[1024];
    uint64_t n_parts, size[READER_PARTS]; /* bytes */
};

#endif
