/* Progress of a run, shown on a terminal, in a log, or to an OpenJD worker.
 *
 *   bar      one line on stderr that is redrawn: a meter, time to go, stage, and more where the terminal is wide; log lines scroll above it
 *   plain    one log line per frame
 *   openjd   flushed lines on stdout: "openjd_progress: 12.5", which never decreases, and "openjd_status: ..."
 *   none     nothing
 *   auto     bar if stderr is a terminal, else plain
 *
 * Calling sequence   progress_begin(), any number of progress_stage() and progress_frame(), progress_end(). Only one progress may be
 *                    active.
 * Threads            All functions are called from one thread; log lines may come from any thread.
 */
#ifndef HOODOO_PROGRESS_H
#define HOODOO_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/choice.h"
#include "text/ranges.h"

#define PROGRESS_CHOICE                                                                                      \
    (PROGRESS_AUTO, "auto")(PROGRESS_BAR, "bar")(PROGRESS_PLAIN, "plain")(PROGRESS_OPENJD,                   \
                                                                          "openjd")(PROGRESS_NONE, "none")
enum progress_style { CHOICE_CONSTANTS(PROGRESS_CHOICE) };

struct progress {
    enum progress_style style;
    struct frame_range frames;
    size_t done, total;
    int frame;                        /* the frame that was finished last */
    double share;                     /* share of the rock's volume that is left, 0..1; negative: unknown */
    double last_s, seconds_per_frame; /* seconds_per_frame is smoothed; 0 until the first frame */
    double percent_reported;
    double drawn_s; /* when the bar was drawn last */
    bool notes;     /* progress_note() gives the text */
    bool frame_done;
    char stage[48], note[64], line[320];
};

/* Begins, with `done` of the frames already complete. */
void progress_begin(struct progress *p, enum progress_style style, struct frame_range frames, size_t done);

/* Shows the current stage of a frame in the bar, such as "1013 wind"; no effect in other styles. */
void progress_stage(struct progress *p, int frame, const char *stage);

/* Reports that `frame` is done. `note` (or NULL) is appended to the line, such as "stress 14 iterations"; a negative share is not
 * shown. */
void progress_frame(struct progress *p, int frame, double volume_share, const char *note);

/* Progress with the caller's own text: `done` of `total`. In style plain nothing is printed, because the caller logs its events. */
void progress_begin_notes(struct progress *p, enum progress_style style);
void progress_note(struct progress *p, size_t done, size_t total, const char *line);

/* Ends the bar's line. May be called on {0} and repeatedly. */
void progress_end(struct progress *p);

/* "3 h 12 min", "2 min 6 s", "41 s" in out; returns out. */
const char *duration_text(double seconds, char out[32]);

#endif
