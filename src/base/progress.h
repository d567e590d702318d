/* How far a run is, for whoever watches: a person at a terminal, a log, or an OpenJD worker.
 *
 *   bar      one line of stderr, redrawn; log lines pass above it
 *   plain    a log line a frame
 *   openjd   stdout, whole flushed lines: "openjd_progress: 12.5" (never falling) and "openjd_status: ..."
 *   none     nothing
 *   auto     bar if stderr is a terminal, else plain
 *
 * Calling sequence   progress_begin(), any of progress_stage() and progress_frame(), progress_end(). One at a
 *                    time.
 * Threads            one thread calls these; log lines may come from any.
 */
#ifndef HOODOO_PROGRESS_H
#define HOODOO_PROGRESS_H

#include <stddef.h>

#include "base/choice.h"
#include "base/ranges.h"

#define PROGRESS_CHOICE                                                                                      \
    (PROGRESS_AUTO, "auto")(PROGRESS_BAR, "bar")(PROGRESS_PLAIN, "plain")(PROGRESS_OPENJD,                   \
                                                                          "openjd")(PROGRESS_NONE, "none")
enum progress_style { CHOICE_CONSTANTS(PROGRESS_CHOICE) };

struct progress {
    enum progress_style style;
    struct frame_range frames;
    size_t done, total;
    int frame;                        /* the one finished last */
    double share;                     /* of the rock's volume left, 0..1 */
    double last_s, seconds_per_frame; /* smoothed; 0 until the first frame */
    double percent_said;
    char stage[48], line[320];
};

/* `done` frames of `frames` are there already. */
void progress_begin(struct progress *p, enum progress_style style, struct frame_range frames, size_t done);

/* What is being done now, for the bar alone: "1013 wind". */
void progress_stage(struct progress *p, int frame, const char *stage);

/* `frame` is done. `note` adds to the line ("stress 14 iterations"), or is NULL; a
 * negative share says nothing. */
void progress_frame(struct progress *p, int frame, double volume_share, const char *note);

/* A farm's progress, in the caller's own words: `done` of `total`. Plain says nothing: the caller logs what
 * happens. */
void progress_begin_notes(struct progress *p, enum progress_style style);
void progress_note(struct progress *p, size_t done, size_t total, const char *line);

/* Leaves the terminal as it should be found. Harmless on {0} and twice. */
void progress_end(struct progress *p);

/* "3 h 12 min", "2 min 6 s", "41 s" in out; returns out. */
const char *duration_text(double seconds, char out[32]);

#endif
