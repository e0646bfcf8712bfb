#include "firmware_host/publish/output.h"

#include "core/text.h"
#include "estimator/match/match.h"
#include "messages/digsight_estimate_t.h"
#include "messages/digsight_health_t.h"
#include "messages/digsight_match_t.h"
#include "messages/digsight_prediction_t.h"
#include "messages/digsight_sample_t.h"

#include <assert.h>
#include <lcm/lcm.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define TEXT_SIZE 256

struct dig_output {
    lcm_t *lcm;
};

enum dig_status dig_output_create(const char *const url, struct dig_output **const output,
                                  struct dig_error *const error)
{
    assert(url != NULL && output != NULL);
    struct dig_output *const created = calloc(1, sizeof *created);
    if (created == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "LCM: no memory");
    }
    created->lcm = lcm_create(url);
    if (created->lcm == NULL) {
        free(created);
        return dig_error_set(error, DIG_EIO,
                             "LCM %s: no such network (a multicast route is needed: "
                             "ip route add 239.255.76.67 dev lo)",
                             url);
    }
    *output = created;
    return DIG_OK;
}

void dig_output_destroy(struct dig_output *const output)
{
    if (output != NULL) {
        lcm_destroy(output->lcm);
        free(output);
    }
}

// The wall clock at a monotonic instant (of a machine's clock that may run scaled on a bench: then
// of now).
static int64_t utc_us(const int64_t time_ns)
{
    struct timespec wall;
    struct timespec mono;
    (void)clock_gettime(CLOCK_REALTIME, &wall);
    (void)clock_gettime(CLOCK_MONOTONIC, &mono);
    const int64_t now_us = (int64_t)wall.tv_sec * 1000000 + wall.tv_nsec / 1000;
    const int64_t age_us = ((int64_t)mono.tv_sec * 1000000000 + mono.tv_nsec - time_ns) / 1000;
    return age_us >= 0 && age_us < 1000000 ? now_us - age_us : now_us;
}

static enum dig_status sent(const int result)
{
    return result == 0 ? DIG_OK : DIG_EIO;
}

static const char *trajectory_name(const struct dig_curve_set *const set, const int trajectory)
{
    return trajectory >= 0 && (size_t)trajectory < set->trajectories
               ? set->trajectory[trajectory].name
               : "";
}

static enum dig_status publish_sample(struct dig_output *const       output,
                                      const struct dig_sample *const sample)
{
    double value[DIG_SIGNALS];
    int8_t valid[DIG_SIGNALS];
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        value[i] = sample->value[i];
        valid[i] = sample->valid[i] ? 1 : 0;
    }
    const digsight_sample_t message = {
        .time_ns = sample->time_ns,
        .utc_us  = utc_us(sample->time_ns),
        .signals = DIG_SIGNALS,
        .value   = value,
        .valid   = valid,
    };
    return sent(digsight_sample_t_publish(output->lcm, "DIGSIGHT_SAMPLE", &message));
}

// lcm-gen's structs hold text as char *; publishing does not write to it.
static char *text(const char *const said)
{
    const union {
        const char *said;
        char       *held;
    } as = { .said = said };
    return as.held;
}

static enum dig_status publish_estimate(struct dig_output *const          output,
                                        const struct dig_curve_set *const set,
                                        const struct dig_record *const    record)
{
    const struct dig_estimate *const e = &record->estimate;
    char                             missing[DIG_SIGNAL_NAMES_SIZE];
    dig_signal_name_missing(record->sample.valid, sizeof missing, missing);
    const digsight_estimate_t message = {
        .time_ns         = e->time_ns,
        .utc_us          = utc_us(e->time_ns),
        .moment_valid    = e->wrench.moment_valid ? 1 : 0,
        .force_valid     = e->wrench.force_valid ? 1 : 0,
        .moment_Nm       = e->wrench.My_Nm,
        .force_x_N       = e->wrench.Fx_N,
        .force_z_N       = e->wrench.Fz_N,
        .sigma_moment_Nm = e->wrench.sigma_My_Nm,
        .sigma_force_x_N = e->wrench.sigma_Fx_N,
        .sigma_force_z_N = e->wrench.sigma_Fz_N,
        .pin_X_m         = e->pin_X_m,
        .pin_Z_m         = e->pin_Z_m,
        .bucket_phi_rad  = e->phi_rad,
        .phase           = (int8_t)e->phase,
        .dig_count       = (int32_t)e->dig_count,
        .trajectory      = text(trajectory_name(set, e->trajectory)),
        .progress        = e->progress,
        .off_path_m      = e->off_path_m,
        .expires_ns      = record->expires_ns,
        .missing         = missing,
        .advice          = text(DIG_ADVICE),
        .motion          = (int8_t)e->motion,

        .geometry_sigma_moment_Nm = e->wrench.geometry_sigma_My_Nm,
        .geometry_sigma_force_x_N = e->wrench.geometry_sigma_Fx_N,
        .geometry_sigma_force_z_N = e->wrench.geometry_sigma_Fz_N,
    };
    return sent(digsight_estimate_t_publish(output->lcm, "DIGSIGHT_ESTIMATE", &message));
}

enum dig_status dig_output_record(struct dig_output *const          output,
                                  const struct dig_curve_set *const set,
                                  const struct dig_record *const    record)
{
    assert(output != NULL && set != NULL && record != NULL);
    const enum dig_status status = publish_sample(output, &record->sample);
    return status == DIG_OK && record->has_estimate ? publish_estimate(output, set, record)
                                                    : status;
}

enum dig_status dig_output_match(struct dig_output *const           output,
                                 const struct dig_fit_result *const result)
{
    assert(output != NULL && result != NULL);
    const struct dig_gravel_track *const k       = &result->track;
    const struct dig_match *const        m       = &k->match;
    const struct dig_gravel *const       nearest = &k->nearest;
    const struct dig_gravel              weighted =
        m->weighted >= 0 ? k->weighted
                                      : (struct dig_gravel){ { (double)NAN, (double)NAN, (double)NAN } };
    const struct dig_approach matched = dig_approach_normalized(&k->matched);
    char                      untold[DIG_UNTOLD_SIZE];
    double                    sample[DIG_AXES][DIG_MATCH_SAMPLES] = { { 0 } };
    dig_match_unresolved(m, untold);
    for (size_t s = 0; s < m->samples; s++) {
        for (int a = 0; a < DIG_AXES; a++) {
            sample[a][s] = m->sample[s].value[a];
        }
    }
    const digsight_match_t message = {
        .time_ns               = k->time_ns,
        .utc_us                = utc_us(k->time_ns),
        .valid                 = k->valid ? 1 : 0,
        .outside               = m->outside ? 1 : 0,
        .dig_count             = (int32_t)m->dig_count,
        .trajectory            = text(k->trajectory),
        .table                 = text(k->table),
        .nearest_entry         = m->nearest,
        .nearest_friction      = nearest->value[DIG_AXIS_FRICTION],
        .nearest_rolling       = nearest->value[DIG_AXIS_ROLLING],
        .nearest_density_kgpm3 = nearest->value[DIG_AXIS_DENSITY_kgpm3],
        .nearest_distance      = m->nearest_distance,
        .friction              = m->gravel.value[DIG_AXIS_FRICTION],
        .friction_low          = m->low.value[DIG_AXIS_FRICTION],
        .friction_high         = m->high.value[DIG_AXIS_FRICTION],
        .rolling               = m->gravel.value[DIG_AXIS_ROLLING],
        .rolling_low           = m->low.value[DIG_AXIS_ROLLING],
        .rolling_high          = m->high.value[DIG_AXIS_ROLLING],
        .density_kgpm3         = m->gravel.value[DIG_AXIS_DENSITY_kgpm3],
        .density_low_kgpm3     = m->low.value[DIG_AXIS_DENSITY_kgpm3],
        .density_high_kgpm3    = m->high.value[DIG_AXIS_DENSITY_kgpm3],
        .distance              = m->distance,
        .noise_floor           = m->noise_floor,
        .expires_ns            = k->expires_ns,
        .restored              = k->restored ? 1 : 0,
        .drift                 = k->drift,
        .wanted                = text(k->wanted),
        .samples               = (int32_t)m->samples,
        .sample_friction       = sample[DIG_AXIS_FRICTION],
        .sample_rolling        = sample[DIG_AXIS_ROLLING],
        .sample_density_kgpm3  = sample[DIG_AXIS_DENSITY_kgpm3],
        .hint_trajectory       = text(result->hint_trajectory),
        .hint_J_per_kg         = result->hint_J_per_kg,
        .digs                  = (int32_t)m->digs,
        .path_measured         = k->path_measured,
        .going_on              = k->going_on ? 1 : 0,
        .forces                = m->forces ? 1 : 0,
        .depth                 = k->made.depth > 0.0 ? k->made.depth : (double)NAN,
        .attack_rad            = k->made.depth > 0.0 ? k->made.attack_rad : (double)NAN,
        .matched_depth         = matched.depth,
        .matched_attack_rad    = matched.attack_rad,
        .advice                = text(DIG_ADVICE),
        .family                = dig_match_is_family(m) ? 1 : 0,
        .untold                = untold,
        .ending                = (int8_t)k->ending,

        .weighted_entry         = m->weighted,
        .weighted_friction      = weighted.value[DIG_AXIS_FRICTION],
        .weighted_rolling       = weighted.value[DIG_AXIS_ROLLING],
        .weighted_density_kgpm3 = weighted.value[DIG_AXIS_DENSITY_kgpm3],
        .weighted_distance      = m->weighted >= 0 ? m->weighted_distance : (double)NAN,
    };
    return sent(digsight_match_t_publish(output->lcm, "DIGSIGHT_MATCH", &message));
}

enum dig_status dig_output_prediction(struct dig_output *const                  output,
                                      const struct dig_curve_set *const         set,
                                      const struct dig_prediction_record *const record)
{
    assert(output != NULL && set != NULL && record != NULL);
    struct dig_prediction       prediction = record->prediction;
    const struct dig_approach   dug        = dig_approach_normalized(&prediction.approach);
    const digsight_prediction_t message    = {
           .time_ns        = record->time_ns,
           .utc_us         = utc_us(record->time_ns),
           .valid          = prediction.valid ? 1 : 0,
           .expires_ns     = record->expires_ns,
           .trajectory     = text(prediction.valid ? trajectory_name(set, prediction.trajectory) : ""),
           .dig_count      = (int32_t)record->dig_count,
           .progress_now   = prediction.progress_now,
           .from_progress  = prediction.from_progress,
           .to_progress    = prediction.to_progress,
           .points         = prediction.valid ? DIG_PREDICTION_POINTS : 0,
           .moment_Nm      = prediction.moment_Nm,
           .sigma_Nm       = prediction.sigma_Nm,
           .force_x_N      = prediction.Fx_N,
           .force_z_N      = prediction.Fz_N,
           .peak_Nm        = prediction.peak_Nm,
           .energy_J       = prediction.energy_J,
           .outside        = record->outside ? 1 : 0,
           .depth          = prediction.valid ? dug.depth : (double)NAN,
           .attack_rad     = prediction.valid ? dug.attack_rad : (double)NAN,
           .reason         = text(dig_prediction_state_str(record->state)),
           .advice         = text(DIG_ADVICE),
           .peak_sigma_Nm  = prediction.peak_sigma_Nm,
           .energy_sigma_J = prediction.energy_sigma_J,
           .sigma_force_x_N = prediction.sigma_Fx_N,
           .sigma_force_z_N = prediction.sigma_Fz_N,
    };
    return sent(digsight_prediction_t_publish(output->lcm, "DIGSIGHT_PREDICTION", &message));
}

enum dig_status dig_output_health(struct dig_output *const       output,
                                  const struct dig_health *const health)
{
    assert(output != NULL && health != NULL);
    char    input[TEXT_SIZE];
    char    note[TEXT_SIZE];
    double  latency_to_us[DIG_LATENCY_BINS];
    int64_t latency_count[DIG_LATENCY_BINS];
    for (int i = 0; i < DIG_LATENCY_BINS; i++) {
        latency_to_us[i] = dig_latency_to_us(i);
        latency_count[i] = health->latency.count[i];
    }
    // Names of files among it, cut perhaps within a character.
    dig_text_copy(sizeof input, input, health->input->name);
    dig_text_copy(sizeof note, note, health->note);
    const struct dig_tick_status *const  tick    = &health->tick_status;
    const struct dig_input *const        in      = health->input;
    const struct dig_fit_counters *const fit     = health->fit;
    const digsight_health_t              message = {
                     .time_ns               = health->time_ns,
                     .utc_us                = utc_us(health->time_ns),
                     .state                 = text(health->state),
                     .input                 = input,
                     .note                  = note,
                     .realtime              = health->rt.realtime ? 1 : 0,
                     .memory_locked         = health->rt.memory_locked ? 1 : 0,
                     .tick_s                = health->tick_s,
                     .ticks                 = tick->ticks,
                     .overruns              = tick->overruns,
                     .worst_tick_us         = tick->worst_tick_us,
                     .frames                = atomic_load(&in->frames),
                     .dropped_malformed     = atomic_load(&in->malformed),
                     .dropped_nan           = tick->drops.nan,
                     .dropped_not_available = tick->drops.not_available,
                     .dropped_out_of_range  = tick->drops.out_of_range,
                     .dropped_frozen        = tick->drops.frozen,
                     .missing               = tick->missing,
                     .reconnects            = atomic_load(&in->reconnects),
                     .digs                  = (int32_t)tick->digs,
                     .matches               = (int32_t)atomic_load(&fit->matches),
                     .lost                  = health->lost,
                     .dropped_checksum      = atomic_load(&in->checksum),
                     .dropped_repeated      = tick->drops.repeated,
                     .dropped_jump          = tick->drops.jump,
                     .dropped_stuck         = tick->drops.stuck,
                     .missed                = tick->drops.missed,
                     .error_frames          = atomic_load(&in->errors),
                     .bus_offs              = atomic_load(&in->bus_offs),
                     .timeouts              = atomic_load(&in->timeouts),
                     .unsent                = health->unsent,
                     .reloads               = atomic_load(&fit->reloads),
                     .reloads_refused       = atomic_load(&fit->reloads_refused),
                     .worst_tick_cpu_us     = tick->worst_tick_cpu_us,
                     .latency_p99_us        = dig_latency_quantile_us(&health->latency, 0.99),
                     .latency_bins          = DIG_LATENCY_BINS,
                     .latency_to_us         = latency_to_us,
                     .latency_count         = latency_count,
                     .missing_signals       = text(health->missing),
                     .table                 = text(health->table),
                     .without_force         = tick->drops.without_force,
                     .advice                = text(DIG_ADVICE),
                     .digs_whole            = (int32_t)atomic_load(&fit->whole),
                     .digs_aborted          = (int32_t)atomic_load(&fit->aborted),
                     .digs_unknown          = (int32_t)atomic_load(&fit->unknown),
                     .worst_late_us         = tick->worst_late_us,
    };
    return sent(digsight_health_t_publish(output->lcm, "DIGSIGHT_HEALTH", &message));
}
