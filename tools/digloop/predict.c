#include "core/markup.h"
#include "core/units.h"
#include "estimator/approach/interpolate.h"
#include "estimator/match/match.h"
#include "estimator/predict/peak_energy.h"
#include "files/identity_json.h"
#include "files/recording_csv.h"
#include "tools/digloop/as_dug.h"
#include "tools/digloop/commands.h"
#include "tools/digloop/prediction_error.h"
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

// A prediction, and its error against measured digs.
struct prediction {
    struct dig_trajectory           trajectory; // as dug
    struct dig_curve                curve;
    struct dig_peak_energy          whole;
    struct digloop_prediction_error errors;
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
        digloop_prediction_error_put(&p->errors);
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
    return status;
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
        status = digloop_prediction_error_measure(job, t, &id.match, &p.errors, error);
    }
    if (status == DIG_OK && options->out != NULL) {
        status = write_curve(options->out, job->set, &p.trajectory, &p.curve, error);
    }
    if (status == DIG_OK) {
        print(options, &p, job->machine);
    }
    return status;
}
