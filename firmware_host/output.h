// What the daemon tells the world: its five LCM channels. LCM itself is known to output_lcm.c only.

#ifndef DIG_FIRMWARE_HOST_OUTPUT_H
#define DIG_FIRMWARE_HOST_OUTPUT_H

#include "core/curve.h"
#include "core/error.h"
#include "firmware_host/fit.h"
#include "firmware_host/loop.h"

/// HEALTH in plain words; the fields are those of messages/health_t.lcm.
struct dig_health {
    int64_t             time_ns; // CLOCK_MONOTONIC
    const char         *state, *input, *note;
    struct dig_rt_grant rt;
    double              tick_s;
    struct dig_pulse    pulse;
    int64_t             frames, malformed, reconnects, lost;
    int32_t             matches;
};

struct dig_output;

/// Joins an LCM network. DIG_EIO: it is not there (no multicast route, a bad URL); try again later.
DIG_MUST_CHECK enum dig_status dig_output_create(const char *url, struct dig_output **output,
                                                 struct dig_error *error);

/// NULL is allowed.
void dig_output_destroy(struct dig_output *output);

/// Publish one message each; the set names trajectories. utc_us of a message is the wall clock at
/// its time_ns. DIG_EIO when LCM could not send it.
DIG_MUST_CHECK enum dig_status dig_output_record(struct dig_output          *output,
                                                 const struct dig_curve_set *set,
                                                 const struct dig_record    *record);
DIG_MUST_CHECK enum dig_status dig_output_match(struct dig_output           *output,
                                                const struct dig_curve_set  *set,
                                                const struct dig_fit_result *result);
DIG_MUST_CHECK enum dig_status dig_output_outlook(struct dig_output          *output,
                                                  const struct dig_curve_set *set,
                                                  const struct dig_outlook   *outlook);
DIG_MUST_CHECK enum dig_status dig_output_health(struct dig_output       *output,
                                                 const struct dig_health *health);

#endif // DIG_FIRMWARE_HOST_OUTPUT_H
