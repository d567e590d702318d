#include "system/draft.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

#include "base/memory.h"

/* Bytes held in memory before they are written, and read at a time. */
enum { CHUNK = 1 << 20 };

static status cut_short(const struct draft *d, uint64_t written, int error)
{
    return fail(E_OUTPUT, "%s: only %llu of at least %llu bytes could be written: %s", d->path.text,
                (unsigned long long)written, (unsigned long long)d->size, strerror(error));
}

static status write_at(const struct draft *d, uint64_t at, const char *bytes, size_t n)
{
    for (size_t done = 0; done < n;) {
        const ssize_t k = pwrite(d->fd, bytes + done, n - done, (off_t)(at + done));
        if (k < 0 && errno == EINTR)
            continue;
        if (k <= 0)
            return cut_short(d, at + done, k < 0 ? errno : ENOSPC);
        done += (size_t)k;
    }
    return OK;
}

status draft_flush(struct draft *d)
{
    if (!d->on_disk || d->held == 0)
        return OK;
    const status st = write_at(d, d->size - d->held, d->bytes, d->held);
    if (st == OK)
        d->held = 0;
    return st;
}

/* Makes room for n more bytes in memory. */
static status reserve(struct draft *d, size_t n)
{
    size_t room = d->room ? d->room : CHUNK;
    while (room - d->held < n)
        room *= 2;
    if (room == d->room)
        return OK;
    char *grown = realloc(d->bytes, room);
    if (!grown)
        return fail(E_MEMORY, "out of memory: a file of more than %llu bytes", (unsigned long long)d->size);
    d->bytes = grown;
    d->room = room;
    return OK;
}

status draft_append(struct draft *d, const void *bytes, size_t n)
{
    status st = OK;
    if (n == 0)
        return OK;
    if (d->on_disk && d->held + n > CHUNK) {
        TRY(draft_flush(d));
        if (n >= CHUNK) { /* not copied */
            d->size += n;
            return write_at(d, d->size - n, bytes, n);
        }
    }
    TRY(reserve(d, n));
    memcpy(d->bytes + d->held, bytes, n);
    d->held += n;
    d->size += n;
done:
    return st;
}

status draft_replace(struct draft *d, uint64_t at, const void *bytes, size_t n)
{
    const uint64_t first_held = d->size - d->held;
    const size_t written = at >= first_held ? 0 : at + n <= first_held ? n : (size_t)(first_held - at);
    if (written < n)
        memcpy(d->bytes + (at + written - first_held), (const char *)bytes + written, n - written);
    return written ? write_at(d, at, bytes, written) : OK;
}

/* Hashes bytes that are in the file. */
static status hash_written(const struct draft *d, uint64_t from, uint64_t to, XXH3_state_t *state)
{
    status st = OK;
    char *chunk = NULL;
    TRY(memory_alloc(CHUNK, 1, "hashing a file", &chunk));
    while (from < to) {
        const size_t n = to - from < CHUNK ? (size_t)(to - from) : CHUNK;
        const ssize_t k = pread(d->fd, chunk, n, (off_t)from);
        if (k < 0 && errno == EINTR)
            continue;
        if (k <= 0) {
            st = fail(E_OUTPUT, "%s: cannot be read back at byte %llu: %s", d->path.text,
                      (unsigned long long)from, k < 0 ? strerror(errno) : "it is too short");
            break;
        }
        XXH3_64bits_update(state, chunk, (size_t)k);
        from += (uint64_t)k;
    }
done:
    free(chunk);
    return st;
}

status draft_hash(struct draft *d, uint64_t from, uint64_t to, uint64_t *hash)
{
    status st = OK;
    const uint64_t first_held = d->size - d->held, held = from > first_held ? from : first_held;
    XXH3_state_t *state = XXH3_createState();
    if (!state)
        return fail(E_MEMORY, "out of memory: hashing a file");
    XXH3_64bits_reset(state);
    TRY(hash_written(d, from, to < first_held ? to : first_held, state));
    if (to > held)
        XXH3_64bits_update(state, d->bytes + (held - first_held), (size_t)(to - held));
    *hash = XXH3_64bits_digest(state);
done:
    XXH3_freeState(state);
    return st;
}

void draft_drop(struct draft *d)
{
    free(d->bytes);
    if (d->on_disk) {
        close(d->fd);
        unlink(d->temporary.text);
    }
    *d = (struct draft){0};
}
