/* A range of frames. One that is taken is written out and read again as the same. */
#include "fuzz/fuzz.h"

#include "text/ranges.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n)
{
    char text[256], out[48];
    struct frame_range r, again;
    n = n < sizeof text ? n : sizeof text - 1;
    memcpy(text, bytes, n);
    text[n] = '\0';
    const status st = range_parse(text, &r);
    fuzz_refused(st);
    if (st == OK && (r.step < 1 || r.last < r.first || !range_holds(r, r.first) || !range_holds(r, r.last) ||
                     range_parse(range_text(r, out), &again) != OK || again.first != r.first ||
                     again.last != r.last || (range_count(r) > 1 && again.step != r.step)))
        abort();
    return 0;
}
