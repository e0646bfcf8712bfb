#include "tools/digreport/run.h"

#include "closed_loop/accuracy/score.h"
#include "closed_loop/machine_digs/observe_machine.h"
#include "closed_loop/recordings/observe.h"
#include "core/name.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/match/match.h"
#include "files/lcm/lcm_log.h"
#include "files/lcm/matched_gravel.h"
#include "files/lcm/predicted_curve.h"
#include "files/recording_csv.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// What the daemon published, as far as the report needs it.
struct published {
    struct dig_report_run     *run; // takes the gravel
    bool                       matched, forces;
    uint32_t                   matched_dig;
    bool                       predicted; // for a dig after the match
    struct dig_predicted_curve curve;
};

static void take_match(void *const context, const int64_t time_us, const digsight_match_t *const m)
{
    (void)time_us;
    struct published *const   published = context;
    struct dig_matched_gravel g;
    // A later match is of a later dig. A log holds what anybody on the network sent.
    if (published->predicted || !isfinite(m->distance) || !dig_matched_gravel_take(m, &g) ||
        !g.known || g.going_on) {
        return;
    }
    published->matched       = true;
    published->forces        = g.forces;
    published->matched_dig   = (uint32_t)m->dig_count;
    published->run->gravel   = g.gravel;
    published->run->low      = g.low;
    published->run->high     = g.high;
    published->run->nearest  = g.nearest;
    published->run->distance = m->distance;
}

// The first prediction of the dig: the one that was made before most of it was dug.
static void take_prediction(void *const context, const int64_t time_us,
                            const digsight_prediction_t *const p)
{
    (void)time_us;
    struct published *const published = context;
    if (published->matched && !published->predicted && strncmp(p->trajectory, "simple", 6) != 0) {
        published->predicted = dig_predicted_curve_take(p, &published->curve);
    }
}

// The digs of a log, measured again from its samples: the same estimator, without a bus.
static enum dig_status measure(const struct dig_machine *const           machine,
                               const struct dig_corrected_machine *const corrected,
                               const struct dig_curve_set *const set, const char *const log,
                               const struct published *const published,
                               struct dig_observation *const simple,
                               struct dig_observation *const real, struct dig_error *const error)
{
    struct dig_machine_recording samples = { 0 };
    struct dig_observed_digs     digs    = { .digs = 0 };
    enum dig_status              status  = dig_lcm_log_read(log, &samples, error);
    if (status != DIG_OK) {
        return status;
    }
    status = dig_error_name(
        error, dig_observe_machine(machine, corrected, set, &samples, &digs, error), "%s", log);
    dig_machine_recording_finish(&samples);
    if (status != DIG_OK) {
        return status;
    }
    const int want_real   = dig_curve_set_find(set, published->curve.trajectory);
    bool      have_simple = false;
    bool      have_real   = false;
    for (size_t i = 0; i < digs.digs; i++) {
        const struct dig_observation *const dig = &digs.dig[i];
        if (dig->dig_count == published->matched_dig) {
            *simple     = *dig;
            have_simple = true;
        } else if (have_simple && !have_real && dig->trajectory == want_real) {
            *real     = *dig;
            have_real = true;
        }
    }
    dig_observed_digs_finish(&digs);
    return have_simple && have_real
               ? DIG_OK
               : dig_error_set(
                     error, DIG_ENOMATCH,
                     "%s: the samples hold no %s, expected the dig that identified and "
                     "the one that was predicted; a daemon that ran with a model wants --model",
                     log, have_simple ? "predicted dig" : "identifying dig");
}

static enum dig_status add_recordings(const struct digreport_options *const options,
                                      const struct dig_curve_set *const     set,
                                      struct dig_report_run *const          run,
                                      struct dig_error *const               error)
{
    struct dig_report_dig *const digs[] = { &run->simple, &run->real };
    for (size_t d = 0; d < 2; d++) {
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            digs[d]->recording_Nm[k] = (double)NAN;
        }
    }
    for (size_t r = 0; r < options->recordings; r++) {
        struct dig_recording recording = { 0 };
        struct dig_measured  fed;
        enum dig_status      status = dig_recording_read(options->recording[r], &recording, error);
        if (status == DIG_OK) {
            status = dig_observe_dig(set, &recording, &fed, error);
        }
        dig_recording_finish(&recording);
        if (status != DIG_OK) {
            return status;
        }
        for (size_t d = 0; d < 2; d++) {
            if (strcmp(digs[d]->trajectory, set->trajectory[fed.trajectory].name) == 0) {
                memcpy(digs[d]->recording_Nm, fed.value[DIG_CHANNEL_MY_Nm],
                       sizeof digs[d]->recording_Nm);
            }
        }
    }
    return DIG_OK;
}

static void fill_dig(struct dig_report_dig *const dig, const struct dig_curve_set *const set,
                     const struct dig_observation *const seen)
{
    (void)snprintf(dig->trajectory, sizeof dig->trajectory, "%s",
                   set->trajectory[seen->trajectory].name);
    dig->first = seen->first;
    dig->last  = seen->last;
    memcpy(dig->measured_Nm, seen->moment_Nm, sizeof dig->measured_Nm);
}

// The table's curve of the gravel, at the depth and attack a dig was matched at.
static enum dig_status curve_as_dug(const struct dig_curve_set *const   set,
                                    const struct dig_gravel *const      gravel,
                                    const struct dig_observation *const dig,
                                    struct dig_curve *const             curve)
{
    if (!dig_approach_varies(set, (size_t)dig->trajectory)) {
        return dig_match_interpolate(set, gravel, (size_t)dig->trajectory, curve);
    }
    const struct dig_approached_slot slot   = { .trajectory = (size_t)dig->trajectory,
                                                .approach   = dig->approach };
    void *const                      memory = malloc(dig_approached_size(set, 1));
    if (memory == NULL) {
        return DIG_ENOMEM;
    }
    const enum dig_status status =
        dig_match_interpolate(dig_approached_make(set, 1, &slot, NULL, memory), gravel, 0, curve);
    free(memory);
    return status;
}

enum dig_status digreport_run(const struct digreport_options *const     options,
                              const struct dig_machine *const           machine,
                              const struct dig_corrected_machine *const corrected,
                              const struct dig_curve_set *const set, char *const named_log,
                              struct dig_report_run *const run, struct dig_error *const error)
{
    char *const                 log       = strchr(named_log, '=') + 1;
    struct published            published = { .run = run };
    const struct dig_lcm_reader reader    = { .context    = &published,
                                              .match      = take_match,
                                              .prediction = take_prediction };
    enum dig_status             status    = dig_lcm_log_each(log, &reader, error);
    if (status != DIG_OK) {
        return status;
    }
    if (!published.matched || !published.predicted) {
        return dig_error_set(error, DIG_ENOMATCH, "%s: the daemon %s", log,
                             published.matched
                                 ? "predicted no actual dig after identifying the gravel"
                                 : "identified no gravel");
    }

    struct dig_observation simple = { .trajectory = 0 };
    struct dig_observation real   = { .trajectory = 0 };
    status = measure(machine, corrected, set, log, &published, &simple, &real, error);
    if (status != DIG_OK) {
        return status;
    }
    (void)snprintf(run->name, sizeof run->name, "%.*s", (int)(log - 1 - named_log), named_log);
    run->truth_known = options->truth_known;
    run->truth       = options->truth;
    fill_dig(&run->simple, set, &simple);
    fill_dig(&run->real, set, &real);
    (void)snprintf(run->dig, sizeof run->dig,
                   "%s identified the gravel by %s, then %s was predicted", run->simple.trajectory,
                   published.forces ? "moment and forces" : "moment alone", run->real.trajectory);

    struct dig_curve curve;
    status = curve_as_dug(set, &run->gravel, &simple, &curve);
    if (status == DIG_ENOMEM) {
        return dig_error_set(error, status, "out of memory");
    }
    if (status != DIG_OK) {
        return dig_error_set(error, DIG_ENOMATCH,
                             "%s: the identified gravel lies outside %s, expected the table the "
                             "daemon ran on",
                             log, options->table);
    }
    const double to_rig = pow(set->tooth_m / machine->link[DIG_JOINT_BUCKET].length_m, 4.0);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress   = (double)k / (DIG_CURVE_POINTS - 1);
        run->simple.model_Nm[k] = (double)curve.mean[DIG_CHANNEL_MY_Nm][k];
        run->simple.sigma_Nm[k] = (double)curve.sd[DIG_CHANNEL_MY_Nm][k];
        double predicted_Nm     = (double)NAN;
        double sigma_Nm         = (double)NAN;
        (void)dig_predicted_curve_at(&published.curve, progress, &predicted_Nm, &sigma_Nm);
        run->real.model_Nm[k] = to_rig * predicted_Nm;
        run->real.sigma_Nm[k] = to_rig * sigma_Nm;
    }
    struct dig_score score = { 0 };
    const int        t     = dig_curve_set_find(set, run->real.trajectory);
    // One grid point in from where the prediction begins: the curve is a gap before it.
    const double from = fmax(real.first, published.curve.from + 1.0 / (DIG_CURVE_POINTS - 1));
    dig_score_add(&score, &set->trajectory[t], set->tooth_m, from, real.last, run->real.measured_Nm,
                  run->real.model_Nm, run->real.sigma_Nm);
    run->error       = dig_score_error(&score);
    run->noise_floor = dig_score_noise_floor(&score);
    return add_recordings(options, set, run, error);
}
