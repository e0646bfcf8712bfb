// digloop: which gravel resists like these recordings, and what that gravel will resist with.

#include "closed_loop/observe.h"
#include "closed_loop/score.h"
#include "estimator/match.h"
#include "estimator/predict.h"
#include "files/identity_json.h"
#include "files/recording_csv.h"
#include "tables/load.h"

#include <assert.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RECORDINGS_MAX 64
#define EVALUATIONS    400
#define OUTSIDE_FLOORS 3.0
#define GRID_s         0.005

static const char help[] =
    "digloop finds the gravel of a table that resists like recorded digs, and predicts other "
    "digs.\n"
    "\n"
    "usage:\n"
    "  digloop identify TABLE.sqlite RECORDING.csv… [--json]\n"
    "      which gravel: force recordings of one trajectory, pooled\n"
    "  digloop predict TABLE.sqlite --identified ID.json --trajectory NAME\n"
    "                  [-o CURVE.csv] [--measured RECORDING.csv] [--json]\n"
    "      what that gravel will resist along another trajectory, at the table's scale; with a\n"
    "      measured dig, how wrong that was: relative Euclidean norm of the moment, +-0.16 s\n"
    "  digloop --help | --version\n"
    "\n"
    "exit codes: 0 done, 1 the work failed, 2 bad usage or bad input\n"
    "\n"
    "examples:\n"
    "  digloop identify tables/coarse.sqlite simpleA_1.csv simpleA_2.csv --json >id.json\n"
    "  digloop predict tables/coarse.sqlite --identified id.json --trajectory actual \\\n"
    "          --measured actual_1.csv\n";

struct options {
    const char *command, *table;
    int         recordings;
    char      **recording;
    const char *identified, *trajectory, *out, *measured;
    bool        json;
};

static enum dig_status parse(const int argc, char *argv[], struct options *const options,
                             struct dig_error *const error)
{
    enum { IDENTIFIED = 256, TRAJECTORY, MEASURED, JSON, HELP, VERSION };
    static const struct option known[] = {
        { "identified", required_argument, NULL, IDENTIFIED },
        { "trajectory", required_argument, NULL, TRAJECTORY },
        { "measured", required_argument, NULL, MEASURED },
        { "json", no_argument, NULL, JSON },
        { "help", no_argument, NULL, HELP },
        { "version", no_argument, NULL, VERSION },
        { NULL, 0, NULL, 0 },
    };
    struct options o = { 0 };
    opterr           = 0;
    for (int c; (c = getopt_long(argc, argv, "o:", known, NULL)) != -1;) {
        switch (c) {
        case IDENTIFIED: o.identified = optarg; break;
        case TRAJECTORY: o.trajectory = optarg; break;
        case 'o': o.out = optarg; break;
        case MEASURED: o.measured = optarg; break;
        case JSON: o.json = true; break;
        case HELP: (void)fputs(help, stdout); exit(EXIT_SUCCESS);
        case VERSION: (void)puts("digloop " DIG_VERSION); exit(EXIT_SUCCESS);
        default:
            return dig_error_set(error, DIG_EINVAL, "unknown option or missing value: %s",
                                 argv[optind - 1]);
        }
    }
    if (argc - optind < 2) {
        return dig_error_set(error, DIG_EINVAL, "expected a command and a table");
    }
    o.command    = argv[optind];
    o.table      = argv[optind + 1];
    o.recording  = argv + optind + 2;
    o.recordings = argc - optind - 2;
    if (strcmp(o.command, "identify") == 0) {
        if (o.recordings < 1 || o.recordings > RECORDINGS_MAX || o.identified != NULL ||
            o.trajectory != NULL || o.measured != NULL || o.out != NULL) {
            return dig_error_set(error, DIG_EINVAL,
                                 "identify: expected TABLE.sqlite and 1 to %d RECORDING.csv",
                                 RECORDINGS_MAX);
        }
    } else if (strcmp(o.command, "predict") == 0) {
        if (o.recordings != 0 || o.identified == NULL || o.trajectory == NULL) {
            return dig_error_set(error, DIG_EINVAL,
                                 "predict: expected TABLE.sqlite --identified ID.json "
                                 "--trajectory NAME");
        }
    } else {
        return dig_error_set(error, DIG_EINVAL, "%s: expected identify or predict", o.command);
    }
    *options = o;
    return DIG_OK;
}

static enum dig_status observe_all(const struct options *const       options,
                                   const struct dig_curve_set *const set,
                                   struct dig_observation *const     mean,
                                   struct dig_error *const           error)
{
    struct dig_observation *const one = calloc((size_t)options->recordings, sizeof *one);
    if (one == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    enum dig_status status = DIG_OK;
    for (int i = 0; i < options->recordings && status == DIG_OK; i++) {
        struct dig_recording recording = { 0 };
        status = dig_recording_read(options->recording[i], &recording, error);
        if (status == DIG_OK) {
            struct dig_error why = { "" };
            status               = dig_observe_recording(set, &recording, &one[i], &why);
            if (status != DIG_OK) {
                (void)dig_error_set(error, status, "%s: %s", options->recording[i], why.text);
            }
        }
        dig_recording_finish(&recording);
    }
    if (status == DIG_OK) {
        status = dig_observe_mean((size_t)options->recordings, one, mean, error);
    }
    free(one);
    return status;
}

static void show_identity(const struct dig_identity *const id, FILE *const to)
{
    for (int a = 0; a < DIG_AXES; a++) {
        (void)fprintf(to, "  %-14s %8.4g   90 %%: %.4g to %.4g   nearest entry %.4g\n",
                      dig_axis_name((enum dig_axis)a), id->gravel.value[a], id->low.value[a],
                      id->high.value[a], id->nearest.value[a]);
    }
    (void)fprintf(to, "  distance %.3f, nearest entry %.3f, noise floor %.3f%s\n", id->distance,
                  id->nearest_distance, id->noise_floor,
                  id->outside ? "; OUTSIDE: none of the table's gravels" : "");
}

static enum dig_status identify(const struct options *const       options,
                                const struct dig_curve_set *const set,
                                struct dig_error *const           error)
{
    struct dig_observation observation = { .trajectory = 0 };
    struct dig_match       match;
    enum dig_status        status = observe_all(options, set, &observation, error);
    if (status != DIG_OK) {
        return status;
    }
    status = dig_match_nearest(set, &observation, OUTSIDE_FLOORS, &match);
    if (status == DIG_ENOMATCH) {
        return dig_error_set(error, status, "%s: holds no curve along %s, expected one or more",
                             options->table, set->trajectory[observation.trajectory].name);
    }
    if (status == DIG_OK) {
        status = dig_fit_refine(set, &observation, EVALUATIONS, &match);
    }
    if (status != DIG_OK) {
        return dig_error_set(error, status, "%s: %s", options->table, dig_status_str(status));
    }

    struct dig_identity id = {
        .digs             = (size_t)options->recordings,
        .gravel           = match.gravel,
        .mean             = match.mean,
        .low              = match.low,
        .high             = match.high,
        .nearest          = set->gravel[match.nearest],
        .distance         = match.distance,
        .nearest_distance = match.nearest_distance,
        .noise_floor      = match.noise_floor,
        .outside          = match.outside,
        .samples          = match.samples,
    };
    _Static_assert(DIG_MATCH_SAMPLES <= DIG_IDENTITY_SAMPLES_MAX, "the posterior must fit");
    memcpy(id.sample, match.sample, match.samples * sizeof match.sample[0]);
    (void)snprintf(id.scene_hash, sizeof id.scene_hash, "%s", set->scene_hash);
    (void)snprintf(id.trajectory, sizeof id.trajectory, "%s",
                   set->trajectory[observation.trajectory].name);
    if (options->json) {
        dig_identity_write(stdout, &id);
    } else {
        show_identity(&id, stdout);
    }
    return DIG_OK;
}

// The match as far as a prediction needs it.
static struct dig_match match_of(const struct dig_identity *const id)
{
    struct dig_match m = { .valid       = true,
                           .gravel      = id->gravel,
                           .mean        = id->mean,
                           .low         = id->low,
                           .high        = id->high,
                           .distance    = id->distance,
                           .noise_floor = id->noise_floor,
                           .outside     = id->outside };
    m.samples          = id->samples < DIG_MATCH_SAMPLES ? id->samples : DIG_MATCH_SAMPLES;
    memcpy(m.sample, id->sample, m.samples * sizeof m.sample[0]);
    return m;
}

static double at(const float curve[DIG_CURVE_POINTS], const double progress)
{
    const double place = fmin(fmax(progress, 0.0), 1.0) * (DIG_CURVE_POINTS - 1);
    const size_t i     = (size_t)fmin(floor(place), DIG_CURVE_POINTS - 2);
    const double f     = place - (double)i;
    return (1.0 - f) * (double)curve[i] + f * (double)curve[i + 1];
}

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
        const double          t_s      = (double)i * GRID_s;
        const double          progress = dig_trajectory_path_m(t, set->tooth_m, t_s) / whole_m;
        const struct dig_pose pose     = dig_trajectory_pose(t, t_s);
        r.row[i]                       = (struct dig_force_row){ .t_s       = t_s,
                                                                 .pin_x_m   = pose.x_m,
                                                                 .pin_z_m   = pose.z_m,
                                                                 .theta_deg = pose.theta_rad * 180.0 / acos(-1.0),
                                                                 .Fx_N      = at(curve->mean[DIG_CHANNEL_FX_N], progress),
                                                                 .Fz_N      = at(curve->mean[DIG_CHANNEL_FZ_N], progress),
                                                                 .My_Nm = at(curve->mean[DIG_CHANNEL_MY_Nm], progress),
                                                                 .carried_kg =
                                                                     at(curve->mean[DIG_CHANNEL_CARRIED_kg], progress) };
    }
    const enum dig_status status = dig_recording_write(path, &r, error);
    dig_recording_finish(&r);
    return status;
}

static void put_array(FILE *const to, const char *const name, const float curve[DIG_CURVE_POINTS])
{
    (void)fprintf(to, ",\n \"%s\": [", name);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        (void)fprintf(to, "%s%.5g", k == 0 ? "" : ", ", (double)curve[k]);
    }
    (void)fputs("]", to);
}

// How wrong the predicted curve is against a measured dig.
static enum dig_status score_measured(const struct options *const       options,
                                      const struct dig_curve_set *const set, const size_t t,
                                      const struct dig_curve *const curve,
                                      struct dig_score *const score, struct dig_error *const error)
{
    struct dig_recording   recording = { 0 };
    struct dig_observation seen      = { .trajectory = 0 };
    enum dig_status        status    = dig_recording_read(options->measured, &recording, error);
    if (status == DIG_OK) {
        struct dig_error why = { "" };
        status               = dig_observe_recording(set, &recording, &seen, &why);
        if (status != DIG_OK) {
            (void)dig_error_set(error, status, "%s: %s", options->measured, why.text);
        }
    }
    dig_recording_finish(&recording);
    if (status != DIG_OK) {
        return status;
    }
    if ((size_t)seen.trajectory != t) {
        return dig_error_set(error, DIG_EINVAL, "%s: a dig along %s, expected one along %s",
                             options->measured, set->trajectory[seen.trajectory].name,
                             set->trajectory[t].name);
    }
    double predicted_Nm[DIG_CURVE_POINTS];
    double sigma_Nm[DIG_CURVE_POINTS];
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        predicted_Nm[k] = (double)curve->mean[DIG_CHANNEL_MY_Nm][k];
        sigma_Nm[k]     = (double)curve->sd[DIG_CHANNEL_MY_Nm][k];
    }
    dig_score_add(score, &set->trajectory[t], set->tooth_m, seen.first, seen.last, seen.moment_Nm,
                  predicted_Nm, sigma_Nm);
    return DIG_OK;
}

static enum dig_status predict(const struct options *const       options,
                               const struct dig_curve_set *const set, struct dig_error *const error)
{
    assert(options->identified != NULL && options->trajectory != NULL);
    struct dig_identity id;
    enum dig_status     status = dig_identity_read(options->identified, &id, error);
    if (status != DIG_OK) {
        return status;
    }
    if (strcmp(id.scene_hash, set->scene_hash) != 0) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s was identified with scene %.12s…, %s holds scene %.12s…, expected "
                             "one scene",
                             options->identified, id.scene_hash, options->table, set->scene_hash);
    }
    size_t t = 0;
    while (t < set->trajectories && strcmp(set->trajectory[t].name, options->trajectory) != 0) {
        t++;
    }
    if (t == set->trajectories) {
        return dig_error_set(error, DIG_EINVAL, "--trajectory %s: %s has no such trajectory",
                             options->trajectory, options->table);
    }

    const struct dig_match match = match_of(&id);
    struct dig_curve       curve;
    status = dig_predict_curve(set, &match, t, &curve);
    if (status != DIG_OK) {
        return dig_error_set(error, status, "%s: %s", options->table, dig_status_str(status));
    }
    const double peak_Nm  = dig_predict_peak_Nm(&curve);
    const double energy_J = dig_predict_energy_J(&set->trajectory[t], set->tooth_m, &curve);
    if (options->out != NULL) {
        status = write_curve(options->out, set, &set->trajectory[t], &curve, error);
    }
    struct dig_score score = { 0 };
    if (status == DIG_OK && options->measured != NULL) {
        status = score_measured(options, set, t, &curve, &score, error);
    }
    if (status == DIG_OK && options->json) {
        (void)printf("{\"trajectory\": \"%s\", \"peak_Nm\": %.6g, \"energy_J\": %.6g",
                     set->trajectory[t].name, peak_Nm, energy_J);
        if (options->measured != NULL) {
            (void)printf(", \"error\": %.6g, \"noise_floor\": %.6g", dig_score_error(&score),
                         dig_score_noise_floor(&score));
        }
        put_array(stdout, "moment_Nm", curve.mean[DIG_CHANNEL_MY_Nm]);
        put_array(stdout, "sigma_Nm", curve.sd[DIG_CHANNEL_MY_Nm]);
        put_array(stdout, "force_x_N", curve.mean[DIG_CHANNEL_FX_N]);
        put_array(stdout, "force_z_N", curve.mean[DIG_CHANNEL_FZ_N]);
        (void)puts("}");
    } else if (status == DIG_OK) {
        (void)printf("  %s: peak %.3f N·m, energy %.3f J at the table's scale\n",
                     set->trajectory[t].name, peak_Nm, energy_J);
        if (options->measured != NULL) {
            (void)printf("  error against %s: %.3f (noise floor %.3f)\n", options->measured,
                         dig_score_error(&score), dig_score_noise_floor(&score));
        }
    }
    return status;
}

int main(const int argc, char *argv[])
{
    struct options   options = { .command = "", .table = "", .identified = "", .trajectory = "" };
    struct dig_error error   = { "" };
    if (parse(argc, argv, &options, &error) != DIG_OK) {
        (void)fprintf(stderr, "digloop: %s\nTry digloop --help.\n", error.text);
        return 2;
    }
    struct dig_curve_set *set    = NULL;
    enum dig_status       status = dig_table_load(options.table, &set, &error);
    if (status == DIG_OK) {
        status = strcmp(options.command, "identify") == 0 ? identify(&options, set, &error)
                                                          : predict(&options, set, &error);
    }
    dig_curve_set_destroy(set);
    if (status != DIG_OK) {
        (void)fprintf(stderr, "digloop: %s\n", error.text);
    }
    const bool input = status == DIG_EINVAL || status == DIG_ESCHEMA || status == DIG_ENOMATCH;
    return status == DIG_OK ? EXIT_SUCCESS : input ? 2 : EXIT_FAILURE;
}
