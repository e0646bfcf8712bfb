// Source of messages: LCM, or a log that is played at a speed.

#ifndef DIG_TOOLS_DIGWATCH_SOURCE_H
#define DIG_TOOLS_DIGWATCH_SOURCE_H

#include "core/error.h"
#include "files/lcm/lcm_log.h"
#include "tools/digwatch/model.h"

#include <stdbool.h>

/// Close it with digwatch_source_close().
struct digwatch_source {
    int                         fd;   // becomes readable; -1: a log
    struct dig_lcm_log         *log;  // NULL: a network
    const struct dig_lcm_event *next; // of the log; NULL: its end
    double                      speed;
    double                      due_s; // when that is due; infinity: nothing is
};

/// Listens on an LCM network, to the daemon's channels alone. Fails as digwatch_multicast_open().
DIG_MUST_CHECK enum dig_status
digwatch_source_listen(const char *url, struct digwatch_source *source, struct dig_error *error);

/// Plays a log, speed times as fast as it was written; a pause of more than ten seconds in it takes
/// ten. path must live as long. Fails as dig_lcm_log_open().
DIG_MUST_CHECK enum dig_status digwatch_source_play(const char *path, double speed,
                                                    struct digwatch_source *source,
                                                    struct dig_error       *error);

/// Lets the model take what is due at now_s (of a clock that only grows), a bounded number of
/// messages of the daemon's channels. Fails where the log is damaged; it has ended then.
DIG_MUST_CHECK enum dig_status digwatch_source_read(struct digwatch_source *source, double now_s,
                                                    struct digwatch_model *model,
                                                    struct dig_error      *error);

/// True at the end of a log.
bool digwatch_source_ended(const struct digwatch_source *source);

void digwatch_source_close(struct digwatch_source *source);

#endif // DIG_TOOLS_DIGWATCH_SOURCE_H
