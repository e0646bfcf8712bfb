// The daemon's five LCM channels. Only output_lcm.c knows LCM.

#ifndef DIG_FIRMWARE_HOST_PUBLISH_OUTPUT_H
#define DIG_FIRMWARE_HOST_PUBLISH_OUTPUT_H

#include "core/curve.h"
#include "core/error.h"
#include "firmware_host/matching/fit.h"
#include "firmware_host/tick/loop.h"

/// A field of every message.
#define DIG_ADVICE "advice, not a safety function"

/// Histogram of the latency of samples, from their last frame's stamp to LCM: bins a quarter of an
/// octave wide, from 16 us on.
#define DIG_LATENCY_BINS 80
struct dig_latency {
    int64_t count[DIG_LATENCY_BINS]; // the last bin holds all that took longer
    int64_t samples;
};

/// Upper end of a bin, us.
double dig_latency_to_us(int bin);

void dig_latency_add(struct dig_latency *latency, int64_t took_ns);

/// Upper end of the bin below which the share of all samples lies; 0 before the first.
double dig_latency_quantile_us(const struct dig_latency *latency, double share);

/// HEALTH in plain words; the fields are those of messages/health_t.lcm.
struct dig_health {
    int64_t                        time_ns; // CLOCK_MONOTONIC
    const char                    *state, *note;
    struct dig_rt_grant            rt;
    double                         tick_s;
    struct dig_tick_status         tick_status;
    const struct dig_input        *input; // its name and counters
    const struct dig_fit_counters *fit;
    int64_t                        lost, unsent;
    struct dig_latency             latency;
    const char                    *table;                          // scene hash
    char                           missing[DIG_SIGNAL_NAMES_SIZE]; // signals, by name
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
                                                const struct dig_fit_result *result);
DIG_MUST_CHECK enum dig_status dig_output_prediction(struct dig_output                  *output,
                                                     const struct dig_curve_set         *set,
                                                     const struct dig_prediction_record *record);
DIG_MUST_CHECK enum dig_status dig_output_health(struct dig_output       *output,
                                                 const struct dig_health *health);

#endif // DIG_FIRMWARE_HOST_PUBLISH_OUTPUT_H
