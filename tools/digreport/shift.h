// A shift by the daemon's messages: its digs, the gravel over time, the troubles.

#ifndef DIG_TOOLS_DIGREPORT_SHIFT_H
#define DIG_TOOLS_DIGREPORT_SHIFT_H

#include "core/error.h"
#include "files/lcm/health_text.h"
#include "files/lcm/lcm_message.h"
#include "files/lcm/matched_gravel.h"
#include "tools/digreport/shift_dig.h"

#define DIGREPORT_TEXT 256

/// A match, or the end of one.
struct digreport_gravel {
    int64_t                   time_us;
    struct dig_matched_gravel match;
};

/// A trouble, from its first to its last sign; signs less than a minute apart are one.
struct digreport_event {
    int64_t                       from_us, to_us;
    int64_t                       count;                // by which its counter grew; 0: no counter
    const struct dig_health_text *text;                 // NULL: the daemon's own words
    char                          said[DIGREPORT_TEXT]; // those
};

/// A clock that is set while a log is written: a controller without a battery, before the network
/// tells it the time. Messages carry the daemon's monotonic clock, too, which goes on meanwhile. Of
/// one log; zeroed at its beginning.
struct digreport_clock {
    bool    any;
    int64_t time_us;  // of the log, at the last message
    int64_t time_ns;  // monotonic, of that message
    int64_t moved_us; // what is added to the log's time so that it goes on
};

/// digreport_shift_begin() zeroes it but for the scale: nothing was taken.
struct digreport_shift {
    double  lambda; // tooth length of the machine over the table's; 0: not known
    int64_t first_us, last_us;
    int64_t messages, misread;        // misread: on our channels, not understood
    int64_t ended[DIGREPORT_ENDINGS]; // digs, by the daemon's counts
    int64_t left_out;       // digs, matches and events beyond the first ten thousand of each
    char    scene_hash[65]; // of the daemon's table, as the last HEALTH says; "": none said it
    size_t  digs, gravels, events;
    struct digreport_dig      *dig;
    struct digreport_gravel   *gravel;
    struct digreport_event    *event;
    struct digreport_dig_track track;

    // Of the log that is read.
    bool                   any_health;
    int64_t                count[DIG_HEALTH_COUNTERS], reloads;
    int64_t                log_ended[DIGREPORT_ENDINGS];
    size_t                 log_digs, log_gravels, log_events; // of logs before
    struct digreport_clock clock;
    int64_t                match_ns; // time of the last match
    bool                   match_known;
    enum dig_status        status; // of the last message
};

/// A machine this much larger than the table's rig; 0: not known. The moving average of moments
/// takes 0.16 s of rig time, for a machine of unknown size as if it were ten times the rig.
void digreport_shift_begin(struct digreport_shift *shift, double lambda);

/// "whole", "aborted", "unknown", "" for one that is not known.
const char *digreport_ending_name(enum digreport_ending ended);

/// Takes all messages of a log. A message that is not understood is counted; a log that is cut off
/// is read up to there. Fails as dig_lcm_log_open() and dig_lcm_log_next(); DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status digreport_shift_log(struct digreport_shift *shift, const char *log,
                                                   struct dig_error *error);

/// The gravel known at a time; NULL: none.
const struct dig_matched_gravel *digreport_shift_gravel_at(const struct digreport_shift *shift,
                                                           int64_t                       time_us);

/// The median of the digs' errors that are known, and of their noise floors; NaN for none. Returns
/// how many there are.
size_t digreport_shift_error(const struct digreport_shift *shift, double *error,
                             double *noise_floor);

/// Frees what it holds.
void digreport_shift_finish(struct digreport_shift *shift);

#endif // DIG_TOOLS_DIGREPORT_SHIFT_H
