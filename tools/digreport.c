// digreport: what a run of the daemon showed, from its LCM log.

#include "closed_loop/observe.h"
#include "closed_loop/report.h"
#include "closed_loop/score.h"
#include "core/name.h"
#include "estimator/estimator.h"
#include "estimator/match.h"
#include "files/lcm_log.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "files/whole.h"
#include "tables/load.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "digreport shows what a run of digsightd identified and predicted, from its LCM log.\n"
    "\n"
    "usage:\n"
    "  digreport --table TABLE.sqlite --machine MACHINE.yaml\n"
    "            [--truth FRICTION,ROLLING,DENSITY] [--recording RECORDING.csv]…\n"
    "            [--title TEXT] [--html PAGE.html] [--json FILE.json] NAME=LOG.lcm…\n"
    "      NAME is how the run is called in the report (\"Modbus TCP=tcp.lcm\"); up to 4 runs.\n"
    "      The log must hold one simple dig that identified the gravel and one later dig that was\n"
    "      predicted. --recording: a force recording that was fed to the rig, drawn beside.\n"
    "  digreport --help | --version\n"
    "\n"
    "The table of results goes to standard output, with --json to standard error. Exit codes: 0 "
    "done,\n"
    "1 the work failed or the log holds no identified and predicted dig, 2 bad usage or bad "
    "input.\n"
    "\n"
    "examples:\n"
    "  digreport --table tables/rig.sqlite --machine config/machines/zx200_trench.yaml \\\n"
    "            --html report.html \"SocketCAN=site.lcm\"\n";

struct options {
    const char       *table, *machine, *title, *html, *json;
    bool              truth_known;
    struct dig_gravel truth;
    size_t            recordings;
    const char       *recording[8];
    size_t            logs;
    char             *log[DIG_REPORT_RUNS_MAX];
};

static enum dig_status parse_truth(const char *const text, struct dig_gravel *const truth,
                                   struct dig_error *const error)
{
    struct dig_gravel g   = { { 0.0 } };
    const char       *at  = text;
    char             *end = NULL;
    for (int a = 0; a < DIG_AXES; a++) {
        g.value[a] = strtod(at, &end);
        if (end == at || *end != (a + 1 < DIG_AXES ? ',' : '\0') || !isfinite(g.value[a])) {
            return dig_error_set(error, DIG_EINVAL, "--truth %s: expected FRICTION,ROLLING,DENSITY",
                                 text);
        }
        at = end + 1;
    }
    *truth = g;
    return DIG_OK;
}

static enum dig_status parse(const int argc, char *argv[], struct options *const options,
                             struct dig_error *const error)
{
    enum { TABLE = 256, MACHINE, TRUTH, RECORDING, TITLE, HTML, JSON, HELP, VERSION };
    static const struct option known[] = {
        { "table", required_argument, NULL, TABLE },
        { "machine", required_argument, NULL, MACHINE },
        { "truth", required_argument, NULL, TRUTH },
        { "recording", required_argument, NULL, RECORDING },
        { "title", required_argument, NULL, TITLE },
        { "html", required_argument, NULL, HTML },
        { "json", required_argument, NULL, JSON },
        { "help", no_argument, NULL, HELP },
        { "version", no_argument, NULL, VERSION },
        { NULL, 0, NULL, 0 },
    };
    struct options o = { .title = "What the ground resisted with" };
    opterr           = 0;
    for (int c; (c = getopt_long(argc, argv, "", known, NULL)) != -1;) {
        switch (c) {
        case TABLE: o.table = optarg; break;
        case MACHINE: o.machine = optarg; break;
        case TITLE: o.title = optarg; break;
        case HTML: o.html = optarg; break;
        case JSON: o.json = optarg; break;
        case HELP: (void)fputs(help, stdout); exit(EXIT_SUCCESS);
        case VERSION: (void)puts("digreport " DIG_VERSION); exit(EXIT_SUCCESS);
        case TRUTH: {
            const enum dig_status status = parse_truth(optarg, &o.truth, error);
            if (status != DIG_OK) {
                return status;
            }
            o.truth_known = true;
            break;
        }
        case RECORDING:
            if (o.recordings == sizeof o.recording / sizeof o.recording[0]) {
                return dig_error_set(error, DIG_EINVAL, "--recording: expected at most 8");
            }
            o.recording[o.recordings++] = optarg;
            break;
        default:
            return dig_error_set(error, DIG_EINVAL, "unknown option or missing value: %s",
                                 argv[optind - 1]);
        }
    }
    for (; optind < argc; optind++) {
        if (o.logs == DIG_REPORT_RUNS_MAX || strchr(argv[optind], '=') == NULL) {
            return dig_error_set(error, DIG_EINVAL, "%s: expected NAME=LOG.lcm, at most %d of them",
                                 argv[optind], DIG_REPORT_RUNS_MAX);
        }
        o.log[o.logs++] = argv[optind];
    }
    if (o.table == NULL || o.machine == NULL || o.logs == 0) {
        return dig_error_set(error, DIG_EINVAL,
                             "expected --table, --machine and at least one NAME=LOG.lcm");
    }
    *options = o;
    return DIG_OK;
}

// What the daemon said, as far as the report needs it.
struct said {
    bool              matched, forces;
    struct dig_gravel gravel, low, high, nearest;
    double            distance;
    uint32_t          matched_dig;
    bool              predicted; // for a dig after the match
    char              trajectory[DIG_NAME_SIZE];
    double            from, to;
    double            moment_Nm[DIG_PREDICTION_POINTS];
    double            sigma_Nm[DIG_PREDICTION_POINTS];
};

// A log holds what anybody on the network sent.
static bool are_finite(const size_t n, const double number[])
{
    size_t i = 0;
    while (i < n && isfinite(number[i])) {
        i++;
    }
    return i == n;
}

static void take_match(void *const context, const int64_t time_us, const digsight_match_t *const m)
{
    (void)time_us;
    struct said *const said     = context;
    const double       number[] = { m->friction,         m->rolling,         m->density_kgpm3,
                                    m->friction_low,     m->rolling_low,     m->density_low_kgpm3,
                                    m->friction_high,    m->rolling_high,    m->density_high_kgpm3,
                                    m->nearest_friction, m->nearest_rolling, m->nearest_density_kgpm3,
                                    m->distance };
    if (!m->valid || m->going_on || said->predicted ||
        !are_finite(sizeof number / sizeof number[0], number)) {
        return; // a later match is of a later dig
    }
    said->matched     = true;
    said->forces      = m->forces != 0;
    said->matched_dig = (uint32_t)m->dig_count;
    said->gravel      = (struct dig_gravel){ { m->friction, m->rolling, m->density_kgpm3 } };
    said->low = (struct dig_gravel){ { m->friction_low, m->rolling_low, m->density_low_kgpm3 } };
    said->high =
        (struct dig_gravel){ { m->friction_high, m->rolling_high, m->density_high_kgpm3 } };
    said->nearest  = (struct dig_gravel){ { m->nearest_friction, m->nearest_rolling,
                                            m->nearest_density_kgpm3 } };
    said->distance = m->distance;
}

// The first prediction of the dig: the one that was made before most of it was dug.
static void take_prediction(void *const context, const int64_t time_us,
                            const digsight_prediction_t *const p)
{
    (void)time_us;
    struct said *const said = context;
    if (!said->matched || said->predicted || !p->valid || p->points != DIG_PREDICTION_POINTS ||
        strncmp(p->trajectory, "simple", 6) == 0 || !dig_name_ok(p->trajectory) ||
        !(p->from_progress >= 0.0 && p->from_progress < p->to_progress && p->to_progress <= 1.0) ||
        !are_finite(DIG_PREDICTION_POINTS, p->moment_Nm) ||
        !are_finite(DIG_PREDICTION_POINTS, p->sigma_Nm)) {
        return;
    }
    said->predicted = true;
    (void)snprintf(said->trajectory, sizeof said->trajectory, "%s", p->trajectory);
    said->from = p->from_progress;
    said->to   = p->to_progress;
    memcpy(said->moment_Nm, p->moment_Nm, sizeof said->moment_Nm);
    memcpy(said->sigma_Nm, p->sigma_Nm, sizeof said->sigma_Nm);
}

static int find_trajectory(const struct dig_curve_set *const set, const char *const name)
{
    for (size_t t = 0; t < set->trajectories; t++) {
        if (strcmp(set->trajectory[t].name, name) == 0) {
            return (int)t;
        }
    }
    return -1;
}

// The digs of a log, measured again from its samples: the same estimator, without a bus.
static enum dig_status measure(const struct dig_machine *const   machine,
                               const struct dig_curve_set *const set, const char *const log,
                               const struct said *const said, struct dig_observation *const simple,
                               struct dig_observation *const real, struct dig_error *const error)
{
    struct dig_machine_recording samples = { 0 };
    enum dig_status              status  = dig_lcm_log_read(log, &samples, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_estimator_settings settings  = dig_estimator_settings_default();
    struct dig_estimator *const   estimator = malloc(dig_estimator_size());
    settings.tick_s                         = 1e-9 *
                      (double)(samples.row[samples.rows - 1].time_ns - samples.row[0].time_ns) /
                      (double)(samples.rows - 1);
    if (estimator == NULL) {
        status = dig_error_set(error, DIG_ENOMEM, "out of memory");
        goto done;
    }
    status = dig_estimator_init(estimator, machine, set, &settings);
    if (status != DIG_OK) {
        (void)dig_error_set(error, status, "%s: %s", log, dig_status_str(status));
        goto done;
    }
    const int want_real   = find_trajectory(set, said->trajectory);
    bool      have_simple = false;
    bool      have_real   = false;
    for (size_t i = 0; i < samples.rows; i++) {
        struct dig_estimate    estimate;
        struct dig_observation dig;
        if (dig_estimator_step(estimator, &samples.row[i], &estimate) != DIG_OK ||
            !dig_estimator_take_dig(estimator, &dig)) {
            continue;
        }
        if (dig.dig_count == said->matched_dig) {
            *simple     = dig;
            have_simple = true;
        } else if (have_simple && !have_real && dig.trajectory == want_real) {
            *real     = dig;
            have_real = true;
        }
    }
    if (!have_simple || !have_real) {
        status = dig_error_set(error, DIG_ENOMATCH,
                               "%s: the samples hold no %s, expected the dig that identified and "
                               "the one that was predicted",
                               log, have_simple ? "predicted dig" : "identifying dig");
    }
done:
    free(estimator);
    dig_machine_recording_finish(&samples);
    return status;
}

// A curve of DIG_PREDICTION_POINTS over [from, to], as the daemon published it, on the table's
// grid.
static double published_at(const struct said *const said, const double curve[],
                           const double progress)
{
    const double place =
        (progress - said->from) / (said->to - said->from) * (DIG_PREDICTION_POINTS - 1);
    if (!(place >= 0.0)) {
        return (double)NAN;
    }
    const size_t i = (size_t)fmin(floor(place), DIG_PREDICTION_POINTS - 2);
    const double f = fmin(place - (double)i, 1.0);
    return (1.0 - f) * curve[i] + f * curve[i + 1];
}

static enum dig_status add_recordings(const struct options *const       options,
                                      const struct dig_curve_set *const set,
                                      struct dig_report_run *const      run,
                                      struct dig_error *const           error)
{
    struct dig_report_dig *const digs[] = { &run->simple, &run->real };
    for (size_t d = 0; d < 2; d++) {
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            digs[d]->recording_Nm[k] = (double)NAN;
        }
    }
    for (size_t r = 0; r < options->recordings; r++) {
        struct dig_recording   recording = { 0 };
        struct dig_observation fed;
        enum dig_status status = dig_recording_read(options->recording[r], &recording, error);
        if (status == DIG_OK) {
            status = dig_observe_recording(set, &recording, &fed, error);
        }
        dig_recording_finish(&recording);
        if (status != DIG_OK) {
            return status;
        }
        for (size_t d = 0; d < 2; d++) {
            if (strcmp(digs[d]->trajectory, set->trajectory[fed.trajectory].name) == 0) {
                memcpy(digs[d]->recording_Nm, fed.moment_Nm, sizeof fed.moment_Nm);
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

static enum dig_status fill_run(const struct options *const       options,
                                const struct dig_machine *const   machine,
                                const struct dig_curve_set *const set, char *const named_log,
                                struct dig_report_run *const run, struct dig_error *const error)
{
    char *const                     log    = strchr(named_log, '=') + 1;
    struct said                     said   = { .matched = false };
    const struct dig_lcm_log_reader reader = { .context    = &said,
                                               .match      = take_match,
                                               .prediction = take_prediction };
    enum dig_status                 status = dig_lcm_log_each(log, &reader, error);
    if (status != DIG_OK) {
        return status;
    }
    if (!said.matched || !said.predicted) {
        return dig_error_set(error, DIG_ENOMATCH, "%s: the daemon %s", log,
                             said.matched ? "predicted no real dig after identifying the gravel"
                                          : "identified no gravel");
    }

    struct dig_observation simple = { .trajectory = 0 };
    struct dig_observation real   = { .trajectory = 0 };
    status                        = measure(machine, set, log, &said, &simple, &real, error);
    if (status != DIG_OK) {
        return status;
    }
    (void)snprintf(run->name, sizeof run->name, "%.*s", (int)(log - 1 - named_log), named_log);
    run->truth_known = options->truth_known;
    run->truth       = options->truth;
    run->gravel      = said.gravel;
    run->low         = said.low;
    run->high        = said.high;
    run->nearest     = said.nearest;
    run->distance    = said.distance;
    fill_dig(&run->simple, set, &simple);
    fill_dig(&run->real, set, &real);
    (void)snprintf(run->dig, sizeof run->dig,
                   "%s identified the gravel by %s, then %s was predicted", run->simple.trajectory,
                   said.forces ? "moment and forces" : "moment alone", run->real.trajectory);

    struct dig_curve curve;
    if (dig_match_interpolate(set, &said.gravel, (size_t)simple.trajectory, &curve) != DIG_OK) {
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
        run->real.model_Nm[k]   = to_rig * published_at(&said, said.moment_Nm, progress);
        run->real.sigma_Nm[k]   = to_rig * published_at(&said, said.sigma_Nm, progress);
    }
    struct dig_score score = { 0 };
    const int        t     = find_trajectory(set, run->real.trajectory);
    // One grid point in from where the prediction begins: the curve is a gap before it.
    const double from = fmax(real.first, said.from + 1.0 / (DIG_CURVE_POINTS - 1));
    dig_score_add(&score, &set->trajectory[t], set->tooth_m, from, real.last, run->real.measured_Nm,
                  run->real.model_Nm, run->real.sigma_Nm);
    run->error       = dig_score_error(&score);
    run->noise_floor = dig_score_noise_floor(&score);
    return add_recordings(options, set, run, error);
}

static enum dig_status report(const struct options *const options, struct dig_error *const error)
{
    struct dig_machine    machine;
    struct dig_curve_set *set    = NULL;
    enum dig_status       status = dig_machine_read(options->machine, &machine, error);
    if (status != DIG_OK) {
        return status;
    }
    status = dig_table_load(options->table, &set, error);
    if (status != DIG_OK) {
        return status;
    }

    // Some 40 kB a run: too much to leave to the stack's good will.
    struct dig_report *const all = calloc(1, sizeof *all);
    if (all == NULL) {
        status = dig_error_set(error, DIG_ENOMEM, "out of memory");
        goto done;
    }
    all->title  = options->title;
    all->table  = options->table;
    all->lambda = machine.link[DIG_JOINT_BUCKET].length_m / set->tooth_m;
    for (size_t i = 0; i < options->logs && status == DIG_OK; i++) {
        status = fill_run(options, &machine, set, options->log[i], &all->run[i], error);
        all->runs += status == DIG_OK ? 1 : 0;
    }
    if (status == DIG_OK && options->html != NULL) {
        status = dig_report_html(all, options->html, error);
    }
    if (status == DIG_OK && options->json != NULL) {
        struct dig_out out;
        status = dig_out_open(&out, options->json, error);
        if (status == DIG_OK) {
            dig_report_json(all, out.file);
            status = dig_out_commit(&out, error);
        }
    }
    if (status == DIG_OK) {
        // Where a program is to read the result, people read on standard error.
        dig_report_text(all, options->json != NULL ? stderr : stdout);
    }
done:
    free(all);
    dig_curve_set_destroy(set);
    return status;
}

int main(const int argc, char *argv[])
{
    struct options   options = { 0 };
    struct dig_error error   = { "" };
    if (parse(argc, argv, &options, &error) != DIG_OK) {
        (void)fprintf(stderr, "digreport: %s\nTry digreport --help.\n", error.text);
        return 2;
    }
    const enum dig_status status = report(&options, &error);
    if (status != DIG_OK) {
        (void)fprintf(stderr, "digreport: %s\n", error.text);
    }
    return status == DIG_OK                                  ? EXIT_SUCCESS
           : (status == DIG_EINVAL || status == DIG_ESCHEMA) ? 2
                                                             : EXIT_FAILURE;
}
