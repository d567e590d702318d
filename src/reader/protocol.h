/* The protocol between hoodoo and its readers, child programs that decode one foreign file and exit.
 *
 * Request   The command line: hoodoo-read KIND PATH ARGUMENT... Descriptor 3 is an empty memory file for the answer; descriptor 4, for
 *           some kinds, is one with input. All programs come from one build, so structs have the same layout in all of them.
 * Answer    struct reader_head, then its parts, one behind the other. The parts of each kind are documented where they are read
 *           (vdb/serve.h, image/image.c).
 * Trust     The caller trusts nothing in the answer and checks every size and number, because the reader has processed hostile bytes.
 */
#ifndef HOODOO_READER_PROTOCOL_H
#define HOODOO_READER_PROTOCOL_H

#include <stdint.h>

enum { READER_ANSWER_FD = 3, READER_INPUT_FD = 4, READER_VERSION = 1, READER_PARTS = 64 };

/* The path at which a reader can open its input. */
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
