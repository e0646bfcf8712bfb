// Prints what an LCM log of the daemon holds, a line a message, for system tests to read:
//   daemon_log LOG.lcm
//   estimate T_s PHASE TRAJECTORY|- PROGRESS MOMENT SIGMA DIGS FORCE_VALID "MISSING" MOTION
//   match VALID OUTSIDE DIG TRAJECTORY FRICTION LOW HIGH ROLLING LOW HIGH DENSITY LOW HIGH DISTANCE
//   RESTORED DRIFT DEPTH ATTACK_deg MATCHED_DEPTH MATCHED_ATTACK_deg "WANTED" FORCES DIGS
//   PATH_MEASURED GOING_ON
//   family FAMILY "UNTOLD" ENDING
//   weighted ENTRY FRICTION ROLLING DENSITY DISTANCE
//   prediction VALID TRAJECTORY|- PROGRESS POINTS PEAK FIRST_MOMENT DEPTH ATTACK_deg "REASON"
//   spread POINTS PEAK_SIGMA ENERGY ENERGY_SIGMA LEAST_SIGMA_X LEAST_SIGMA_Z
//   health STATE_ REALTIME FRAMES MALFORMED NAN NOT_AVAILABLE OUT_OF_RANGE FROZEN MISSING
//          RECONNECTS DIGS MATCHES LOST TICKS OVERRUNS WORST_us CHECKSUM REPEATED JUMP STUCK MISSED
//          ERROR_FRAMES BUS_OFFS TIMEOUTS UNSENT RELOADS RELOADS_REFUSED WORST_CPU_us P99_us
//          WITHOUT_FORCE "INPUT" "NOTE" "MISSING"
//   endings WHOLE ABORTED UNKNOWN
//   late WORST_LATE_us
//   utc UTC_s
//   samples N DURATION_s MAX_GAP_s
// family and weighted are of the match before them, spread of the prediction, endings, late and utc
// of the health.

#include "core/units.h"
#include "files/lcm/lcm_log.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char *name(const char *const text)
{
    return text[0] != '\0' ? text : "-";
}

static void estimate(void *const context, const int64_t time_us, const digsight_estimate_t *const m)
{
    (void)context;
    (void)time_us;
    (void)printf("estimate %.6f %d %s %.5f %.6g %.6g %d %d \"%s\" %d\n", (double)m->time_ns * 1e-9,
                 m->phase, name(m->trajectory), m->progress, m->moment_Nm, m->sigma_moment_Nm,
                 m->dig_count, m->force_valid, m->missing, m->motion);
}

static void match(void *const context, const int64_t time_us, const digsight_match_t *const m)
{
    (void)context;
    (void)time_us;
    (void)printf("match %d %d %d %s %.4f %.4f %.4f %.4f %.4f %.4f %.1f %.1f %.1f %.4f %d %.3f "
                 "%.3f %.2f %.3f %.2f \"%s\" %d %d %.3f %d\n",
                 m->valid, m->outside, m->dig_count, name(m->trajectory), m->friction,
                 m->friction_low, m->friction_high, m->rolling, m->rolling_low, m->rolling_high,
                 m->density_kgpm3, m->density_low_kgpm3, m->density_high_kgpm3, m->distance,
                 m->restored, m->drift, m->depth, m->attack_rad / DIG_RAD_PER_DEG, m->matched_depth,
                 m->matched_attack_rad / DIG_RAD_PER_DEG, m->wanted, m->forces, m->digs,
                 m->path_measured, m->going_on);
    (void)printf("family %d \"%s\" %d\n", m->family, m->untold, m->ending);
    (void)printf("weighted %d %.4f %.4f %.1f %.3f\n", m->weighted_entry, m->weighted_friction,
                 m->weighted_rolling, m->weighted_density_kgpm3, m->weighted_distance);
}

static double least(const int points, const double value[])
{
    double found = points > 0 ? value[0] : 0.0;
    for (int i = 1; i < points; i++) {
        found = value[i] < found ? value[i] : found;
    }
    return found;
}

static void prediction(void *const context, const int64_t time_us,
                       const digsight_prediction_t *const m)
{
    (void)context;
    (void)time_us;
    (void)printf("prediction %d %s %.5f %d %.6g %.6g %.3f %.2f \"%s\"\n", m->valid,
                 name(m->trajectory), m->progress_now, m->points, m->peak_Nm,
                 m->points > 0 ? m->moment_Nm[0] : 0.0, m->depth, m->attack_rad / DIG_RAD_PER_DEG,
                 m->reason);
    (void)printf("spread %d %.6g %.6g %.6g %.6g %.6g\n", m->points, m->peak_sigma_Nm, m->energy_J,
                 m->energy_sigma_J, least(m->points, m->sigma_force_x_N),
                 least(m->points, m->sigma_force_z_N));
}

static void health(void *const context, const int64_t time_us, const digsight_health_t *const m)
{
    (void)context;
    (void)time_us;
    char state[32];
    (void)snprintf(state, sizeof state, "%s", m->state);
    for (char *c = state; *c != '\0'; c++) {
        *c = *c == ' ' ? '_' : *c;
    }
    (void)printf("health %s %d %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64
                 " %" PRId64 " %" PRId64 " %d %d %" PRId64 " %" PRId64 " %" PRId64 " %.1f",
                 state, m->realtime, m->frames, m->dropped_malformed, m->dropped_nan,
                 m->dropped_not_available, m->dropped_out_of_range, m->dropped_frozen, m->missing,
                 m->reconnects, m->digs, m->matches, m->lost, m->ticks, m->overruns,
                 m->worst_tick_us);
    const int64_t more[] = { m->dropped_checksum, m->dropped_repeated, m->dropped_jump,
                             m->dropped_stuck,    m->missed,           m->error_frames,
                             m->bus_offs,         m->timeouts,         m->unsent,
                             m->reloads,          m->reloads_refused };
    for (size_t i = 0; i < sizeof more / sizeof more[0]; i++) {
        (void)printf(" %" PRId64, more[i]);
    }
    (void)printf(" %.1f %.1f %" PRId64 " \"%s\" \"%s\" \"%s\"\n", m->worst_tick_cpu_us,
                 m->latency_p99_us, m->without_force, m->input, m->note, m->missing_signals);
    (void)printf("endings %d %d %d\n", m->digs_whole, m->digs_aborted, m->digs_unknown);
    (void)printf("late %.1f\n", m->worst_late_us);
    (void)printf("utc %.3f\n", 1e-6 * (double)m->utc_us);
}

int main(const int argc, char *argv[])
{
    if (argc != 2) {
        (void)fprintf(stderr, "usage: daemon_log LOG.lcm\n");
        return 2;
    }
    const struct dig_lcm_reader reader = {
        .estimate = estimate, .match = match, .prediction = prediction, .health = health
    };
    struct dig_error             error = { "" };
    struct dig_machine_recording samples;
    if (dig_lcm_log_each(argv[1], &reader, &error) != DIG_OK ||
        dig_lcm_log_read(argv[1], &samples, &error) != DIG_OK) {
        (void)fprintf(stderr, "daemon_log: %s\n", error.text);
        return 1;
    }
    double gap_s = 0.0;
    for (size_t i = 1; i < samples.rows; i++) {
        const double step_s = (double)(samples.row[i].time_ns - samples.row[i - 1].time_ns) * 1e-9;
        gap_s               = step_s > gap_s ? step_s : gap_s;
    }
    (void)printf("samples %zu %.3f %.4f\n", samples.rows,
                 (double)samples.row[samples.rows - 1].time_ns * 1e-9, gap_s);
    dig_machine_recording_finish(&samples);
    return 0;
}
