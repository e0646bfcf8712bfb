#include "closed_loop/accuracy/score.h"
#include "core/markup.h"
#include "core/units.h"
#include "estimator/approach/interpolate.h"
#include "estimator/match/match.h"
#include "estimator/predict/peak_energy.h"
#include "files/identity_json.h"
#include "files/recording_csv.h"
#include "tools/digloop/as_dug.h"
#include "tools/digloop/commands.h"
#include "tools/digloop/recording.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GRID_s 0.005

// The predicted curve as a force recording: what another program may read like a measured one.
static enum dig_status write_curve(const char *const path, const struct dig_curve_set *const set,
                                   const struct dig_trajectory *const t,
                                   const struct dig_curve *const      curve,
                                   struct dig_error *const            error)
{
    const double         duration_s = dig_trajectory_duration_s(t);
    const double         whole_m    = dig_trajectory_path_m(t, set->tooth_m, duration_s);
    const size_t         rows       = (size_t)floor(duration_s / GRID_s) + 1;
    struct dig_recording r          = { rows, calloc(rows, sizeof *r.row) };
    if (r.row == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    for (size_t i = 0; i < rows; i++) {
        const double t_s = (double)i * GRID_s;
        const double place =
            dig_trajectory_path_m(t, set->tooth_m, t_s) / whole_m * (DIG_CURVE_POINTS - 1);
        const struct dig_pose pose = dig_trajectory_pose(t, t_s);
        r.row[i] =
            (struct dig_force_row){ .t_s       = t_s,
                                    .pin_x_m   = pose.x_m,
                                    .pin_z_m   = pose.z_m,
                                    .theta_deg = pose.theta_rad * 180.0 / acos(-1.0),
                                    .Fx_N      = dig_curve_at(curve->mean[DIG_CHANNEL_FX_N], place),
                                    .Fz_N      = dig_curve_at(curve->mean[DIG_CHANNEL_FZ_N], place),
                                    .My_Nm = dig_curve_at(curve->mean[DIG_CHANNEL_MY_Nm], place),
                                    .carried_kg =
                                        dig_curve_at(curve->mean[DIG_CHANNEL_CARRIED_kg], place) };
    }
    const enum dig_status status = dig_recording_write(path, &r, error);
    dig_recording_finish(&r);
    return status;
}

static void put_array(const char *const name, const float curve[DIG_CURVE_POINTS])
{
    dig_json_put(stdout, ",\n %s: [", name);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        dig_json_put(stdout, k == 0 ? "%.5g" : ", %.5g", (double)curve[k]);
    }
    (void)fputs("]", stdout);
}

#define ERRORS_MAX 64 // peaks and energies listed one by one

// Error of a prediction against the digs measured along its trajectory. Zeroed: of no dig. Peaks
// and energies are those measured; NaN without forces.
struct errors {
    struct dig_score    score;
    struct dig_coverage coverage;
    size_t              digs;
    double              peak_Nm[ERRORS_MAX], energy_J[ERRORS_MAX];
};

// Peak and energy of a measured dig. The energy needs the forces.
static void add_peak_energy(const struct dig_trajectory *const t, const double tooth_m,
                            const struct dig_observation *const dig, struct errors *const errors)
{
    struct dig_channels weight;
    dig_peak_energy_weights(t, tooth_m, &weight);
    double peak_Nm  = -INFINITY;
    double energy_J = dig->forces ? 0.0 : (double)NAN;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = (double)k / (DIG_CURVE_POINTS - 1);
        if (at >= dig->first && at <= dig->last) {
            peak_Nm = fmax(peak_Nm, dig->moment_Nm[k]);
            energy_J += weight.of[0][k] * dig->moment_Nm[k] + weight.of[1][k] * dig->force_N[0][k] +
                        weight.of[2][k] * dig->force_N[1][k];
        }
    }
    if (errors->digs < ERRORS_MAX) {
        errors->peak_Nm[errors->digs]  = peak_Nm;
        errors->energy_J[errors->digs] = energy_J;
        errors->digs++;
    }
}

// Error of the prediction of one dig at its own approach.
static enum dig_status score_dig(const struct dig_curve_set *const   set,
                                 const struct dig_match *const       match,
                                 const struct dig_observation *const dig,
                                 struct errors *const errors, struct dig_error *const error)
{
    struct digloop_as_dug table = { .set = NULL };
    struct dig_curve      curve;
    size_t                at = 0;
    enum dig_status       status =
        digloop_as_dug_at(set, (size_t)dig->trajectory, &dig->approach, &table, &at, error);
    if (status != DIG_OK) {
        return status;
    }
    status = dig_predict_curve(table.set, match, at, &curve);
    if (status == DIG_OK) {
        const struct dig_trajectory *const t = &table.set->trajectory[at];
        double                             predicted_Nm[DIG_CURVE_POINTS];
        double                             sigma_Nm[DIG_CURVE_POINTS];
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            predicted_Nm[k] = (double)curve.mean[DIG_CHANNEL_MY_Nm][k];
            sigma_Nm[k]     = (double)curve.sd[DIG_CHANNEL_MY_Nm][k];
        }
        dig_score_add(&errors->score, t, set->tooth_m, dig->first, dig->last, dig->moment_Nm,
                      predicted_Nm, sigma_Nm);
        dig_coverage_add(&errors->coverage, dig, &curve);
        add_peak_energy(t, set->tooth_m, dig, errors);
    } else {
        (void)dig_error_set(error, status, "%s", dig_status_str(status));
    }
    digloop_as_dug_finish(&table);
    return status;
}

// Of all digs of --measured along trajectory t, each predicted as it was made.
static enum dig_status measure(const struct digloop_job *const job, const int t,
                               const struct dig_match *const match, struct errors *const errors,
                               struct dig_error *const error)
{
    struct dig_observed_digs seen = { .digs = 0 };
    enum dig_status status        = digloop_read_digs(job, job->options->measured, t, &seen, error);
    for (size_t i = 0; status == DIG_OK && i < seen.digs; i++) {
        status = score_dig(job->set, match, &seen.dig[i], errors, error);
    }
    dig_observed_digs_finish(&seen);
    return status;
}

static void put_list(const char *const name, const size_t n, const double value[])
{
    dig_json_put(stdout, ", %s: [", name);
    for (size_t i = 0; i < n; i++) {
        dig_json_put(stdout, i == 0 ? "%g" : ", %g", value[i]);
    }
    (void)fputs("]", stdout);
}

static void put_errors(const struct errors *const errors)
{
    dig_json_put(stdout, ", \"error\": %g, \"noise_floor\": %g", dig_score_error(&errors->score),
                 dig_score_noise_floor(&errors->score));
    double inside[DIG_FORCE_CHANNELS];
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        inside[c] = dig_coverage_share(&errors->coverage, (enum dig_channel)c);
    }
    put_list("inside_90", DIG_FORCE_CHANNELS, inside);
    put_list("measured_peak_Nm", errors->digs, errors->peak_Nm);
    put_list("measured_energy_J", errors->digs, errors->energy_J);
}

// A prediction, and its error against measured digs.
struct prediction {
    struct dig_trajectory  trajectory; // as dug
    struct dig_curve       curve;
    struct dig_peak_energy whole;
    struct errors          errors;
};

// The same dig by a machine: Froude similarity.
static struct dig_peak_energy on_machine(const struct dig_peak_energy *const w, const double lambda)
{
    const double lambda4 = lambda * lambda * lambda * lambda;
    return (struct dig_peak_energy){ lambda4 * w->peak_Nm, lambda4 * w->peak_sigma_Nm,
                                     lambda4 * w->energy_J, lambda4 * w->energy_sigma_J };
}

static double duration_s(const struct prediction *const p, const double lambda)
{
    return sqrt(lambda) * dig_trajectory_duration_s(&p->trajectory);
}

// For people: the result where none goes to a program.
static void print_text(const struct digloop_options *const options,
                       const struct prediction *const p, const char *const how,
                       const struct digloop_machine *const machine)
{
    FILE *const to = options->out != NULL ? stderr : stdout;
    (void)fprintf(to,
                  "  %s%s: peak %.3f ± %.3f N·m, energy %.3f ± %.3f J at the table's scale "
                  "(1 sigma of one dig)\n",
                  p->trajectory.name, how, p->whole.peak_Nm, p->whole.peak_sigma_Nm,
                  p->whole.energy_J, p->whole.energy_sigma_J);
    if (machine != NULL) {
        const struct dig_peak_energy m = on_machine(&p->whole, machine->lambda);
        (void)fprintf(to,
                      "  by %s, %.2f times the table's bucket: peak %.4g ± %.2g kN·m, energy %.4g "
                      "± %.2g kJ, in %.1f s\n",
                      machine->machine.name, machine->lambda, 1e-3 * m.peak_Nm,
                      1e-3 * m.peak_sigma_Nm, 1e-3 * m.energy_J, 1e-3 * m.energy_sigma_J,
                      duration_s(p, machine->lambda));
    }
    if (options->measured != NULL) {
        (void)fprintf(to,
                      "  error against %s: %.3f (noise floor %.3f), %.0f %% of the moment in "
                      "the 90 %% band\n",
                      options->measured, dig_score_error(&p->errors.score),
                      dig_score_noise_floor(&p->errors.score),
                      100.0 * dig_coverage_share(&p->errors.coverage, DIG_CHANNEL_MY_Nm));
    }
}

static void put_whole(const struct dig_peak_energy *const w)
{
    dig_json_put(stdout,
                 ", \"peak_Nm\": %g, \"peak_sigma_Nm\": %g, \"energy_J\": %g, "
                 "\"energy_sigma_J\": %g",
                 w->peak_Nm, w->peak_sigma_Nm, w->energy_J, w->energy_sigma_J);
}

static void print(const struct digloop_options *const options, const struct prediction *const p,
                  const struct digloop_machine *const machine)
{
    const struct dig_curve *const curve = &p->curve;
    char                          how[DIG_APPROACH_TEXT_SIZE];
    dig_approach_text(&options->approach, how);
    if (!options->json) {
        print_text(options, p, how, machine);
        return;
    }
    dig_json_put(stdout, "{\"trajectory\": %s", p->trajectory.name);
    put_whole(&p->whole);
    if (how[0] != '\0') {
        dig_json_put(stdout, ", \"depth\": %g, \"attack_deg\": %g", options->approach.depth,
                     options->approach.attack_rad / DIG_RAD_PER_DEG);
    }
    if (options->measured != NULL) {
        put_errors(&p->errors);
    }
    if (machine != NULL) {
        const struct dig_peak_energy m = on_machine(&p->whole, machine->lambda);
        dig_json_put(stdout, ",\n \"machine\": {\"name\": %s, \"lambda\": %g, \"duration_s\": %g",
                     machine->machine.name, machine->lambda, duration_s(p, machine->lambda));
        put_whole(&m);
        (void)fputs("}", stdout);
    }
    put_array("moment_Nm", curve->mean[DIG_CHANNEL_MY_Nm]);
    put_array("sigma_Nm", curve->sd[DIG_CHANNEL_MY_Nm]);
    put_array("force_x_N", curve->mean[DIG_CHANNEL_FX_N]);
    put_array("force_z_N", curve->mean[DIG_CHANNEL_FZ_N]);
    put_array("sigma_force_x_N", curve->sd[DIG_CHANNEL_FX_N]);
    put_array("sigma_force_z_N", curve->sd[DIG_CHANNEL_FZ_N]);
    (void)puts("}");
}

// The trajectory asked for, dug as asked for.
static enum dig_status predict(const struct digloop_job *const job, const int t,
                               const struct dig_match *const match, struct prediction *const p,
                               struct dig_error *const error)
{
    struct digloop_as_dug table = { .set = NULL };
    size_t                at    = 0;
    enum dig_status       status =
        digloop_as_dug_at(job->set, (size_t)t, &job->options->approach, &table, &at, error);
    if (status != DIG_OK) {
        return status;
    }
    p->trajectory = table.set->trajectory[at];
    status        = dig_predict_curve(table.set, match, at, &p->curve);
    if (status == DIG_OK) {
        status = dig_peak_energy_predict(table.set, match, at, &p->whole);
    }
    digloop_as_dug_finish(&table);
    return status == DIG_OK ? DIG_OK
                            : dig_error_set(error, status, "%s: %s", job->options->table,
                                            dig_status_str(status));
}

// An identity is of a table's gravel: between its least and its greatest.
static enum dig_status check_inside(const struct digloop_job *const  job,
                                    const struct dig_identity *const id,
                                    struct dig_error *const          error)
{
    for (int a = 0; a < DIG_AXES; a++) {
        const double value = id->match.gravel.value[a];
        double       least = INFINITY;
        double       most  = -INFINITY;
        for (size_t e = 0; e < job->set->entries; e++) {
            least = fmin(least, job->set->gravel[e].value[a]);
            most  = fmax(most, job->set->gravel[e].value[a]);
        }
        if (!(value >= least * (1.0 - 1e-9) && value <= most * (1.0 + 1e-9))) {
            return dig_error_set(error, DIG_EINVAL, "%s: %s %g, expected %g to %g, which %s holds",
                                 job->options->identified, dig_axis_name((enum dig_axis)a), value,
                                 least, most, job->options->table);
        }
    }
    return DIG_OK;
}

static enum dig_status read_identity(const struct digloop_job *const job,
                                     struct dig_identity *const id, struct dig_error *const error)
{
    const enum dig_status status =
        dig_status_of_input(dig_identity_read(job->options->identified, id, error));
    if (status == DIG_OK && strcmp(id->scene_hash, job->set->scene_hash) != 0) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s was identified with scene %.12s…, %s holds scene %.12s…, expected "
                             "one scene",
                             job->options->identified, id->scene_hash, job->options->table,
                             job->set->scene_hash);
    }
    return status == DIG_OK ? check_inside(job, id, error) : status;
}

enum dig_status digloop_predict(const struct digloop_job *const job, struct dig_error *const error)
{
    const struct digloop_options *const options = job->options;
    assert(options->identified != NULL && options->trajectory != NULL);
    struct dig_identity id;
    int                 t      = 0;
    enum dig_status     status = read_identity(job, &id, error);
    if (status == DIG_OK) {
        status = digloop_find_trajectory(job, &t, error);
    }
    if (status != DIG_OK) {
        return status;
    }
    struct prediction p = { .errors = { .digs = 0 } };
    status              = predict(job, t, &id.match, &p, error);
    if (status == DIG_OK && options->measured != NULL) {
        status = measure(job, t, &id.match, &p.errors, error);
    }
    if (status == DIG_OK && options->out != NULL) {
        status = write_curve(options->out, job->set, &p.trajectory, &p.curve, error);
    }
    if (status == DIG_OK) {
        print(options, &p, job->machine);
    }
    return status;
}
