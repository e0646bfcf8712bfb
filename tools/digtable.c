// digtable: the analyst's tool. Computes digs and tables of digs, and shows what a table holds.
//
//   digtable dig SCENE.yaml --trajectory NAME --friction F --rolling R --density D -o CURVE.csv
//   digtable generate SCENE.yaml GRID.yaml -o TABLE.sqlite
//   digtable list|check|show|export TABLE.sqlite

#include "core/error.h"
#include "files/grid_yaml.h"
#include "files/recording_csv.h"
#include "files/scene_yaml.h"
#include "files/whole.h"
#include "offline_dem/dig.h"
#include "offline_dem/sweep.h"
#include "tables/export.h"
#include "tables/load.h"
#include "tables/store.h"

#include <getopt.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { EXIT_DONE = 0, EXIT_WORK_FAILED = 1, EXIT_BAD_INPUT = 2 };

static const char help_text[] =
    "digtable computes how gravel resists bucket digs, and keeps the curves in a table.\n"
    "\n"
    "usage:\n"
    "  digtable dig SCENE.yaml --trajectory NAME --friction F --rolling R --density KGPM3\n"
    "               [--young PA] [--seed 1] [--engine kernel] [--bed BED.csv] [--save-bed "
    "BED.csv]\n"
    "               [--vtk DIR] -o CURVE.csv\n"
    "      one dig; the curve is a force recording\n"
    "  digtable generate SCENE.yaml GRID.yaml -o TABLE.sqlite\n"
    "               [-j N] [--packings N] [--time-limit S] [--engine kernel]\n"
    "      every dig of the grid, on all cores; what the table holds already is not computed "
    "again,\n"
    "      and Ctrl-C keeps all that is finished\n"
    "  digtable list TABLE.sqlite [--json]\n"
    "      the entries and how many packings each has\n"
    "  digtable show TABLE.sqlite ENTRY | --friction F --rolling R --density KGPM3\n"
    "               [--trajectory NAME] [--channel My|Fx|Fz] [--csv|--json]\n"
    "      one curve of the table\n"
    "  digtable export TABLE.sqlite [--runs] [-o FILE.csv]\n"
    "      all curves, or all runs behind them\n"
    "  digtable check TABLE.sqlite [--complete] [--json]\n"
    "      version, integrity, and every curve against the runs it was made of; with --complete,\n"
    "      holes and missing packings fail too\n"
    "  digtable --help | --version\n"
    "\n"
    "exit codes: 0 done, 1 the work failed, 2 bad usage or bad input\n"
    "\n"
    "examples:\n"
    "  digtable dig config/scenes/rig.yaml --trajectory simpleA --friction .5 --rolling .5 \\\n"
    "           --density 2500 -o dig.csv\n"
    "  digtable generate config/scenes/rig.yaml config/grids/coarse.yaml -o rig.sqlite "
    "--time-limit 3600\n"
    "  digtable show rig.sqlite --friction .5 --rolling .5 --density 2500 --trajectory actual\n"
    "  digtable export rig.sqlite --runs -o runs.csv\n";

// Every option of every command; which command takes which stands in `commands`.
enum option_id {
    OPTION_TRAJECTORY = 256,
    OPTION_FRICTION,
    OPTION_ROLLING,
    OPTION_DENSITY,
    OPTION_YOUNG,
    OPTION_SEED,
    OPTION_ENGINE,
    OPTION_BED,
    OPTION_SAVE_BED,
    OPTION_VTK,
    OPTION_PACKINGS,
    OPTION_TIME_LIMIT,
    OPTION_CHANNEL,
    OPTION_CSV,
    OPTION_JSON,
    OPTION_RUNS,
    OPTION_COMPLETE,
};

static const struct option long_options[] = {
    { "trajectory", required_argument, NULL, OPTION_TRAJECTORY },
    { "friction", required_argument, NULL, OPTION_FRICTION },
    { "rolling", required_argument, NULL, OPTION_ROLLING },
    { "density", required_argument, NULL, OPTION_DENSITY },
    { "young", required_argument, NULL, OPTION_YOUNG },
    { "seed", required_argument, NULL, OPTION_SEED },
    { "engine", required_argument, NULL, OPTION_ENGINE },
    { "bed", required_argument, NULL, OPTION_BED },
    { "save-bed", required_argument, NULL, OPTION_SAVE_BED },
    { "vtk", required_argument, NULL, OPTION_VTK },
    { "packings", required_argument, NULL, OPTION_PACKINGS },
    { "time-limit", required_argument, NULL, OPTION_TIME_LIMIT },
    { "channel", required_argument, NULL, OPTION_CHANNEL },
    { "csv", no_argument, NULL, OPTION_CSV },
    { "json", no_argument, NULL, OPTION_JSON },
    { "runs", no_argument, NULL, OPTION_RUNS },
    { "complete", no_argument, NULL, OPTION_COMPLETE },
    { "output", required_argument, NULL, 'o' },
    { "jobs", required_argument, NULL, 'j' },
    { NULL, 0, NULL, 0 },
};

struct arguments {
    const char      *positional[2];
    int              positionals;
    const char      *output, *trajectory, *bed, *save_bed, *vtk;
    double           gravel[DIG_AXES];        // NaN: not given
    double           young_Pa;                // NaN: the scene's
    unsigned long    seed, workers, packings; // 0 packings: the grid's
    double           time_limit_s;
    enum dig_channel channel;
    bool             csv, json, runs, complete;
};

// Ctrl-C and a polite kill: what is finished is kept.
static volatile sig_atomic_t stop_requested;

static void request_stop(const int signal)
{
    (void)signal;
    stop_requested = 1;
}

__attribute__((format(printf, 1, 2))) static int bad_usage(const char *const format, ...)
{
    va_list args;
    va_start(args, format);
    (void)fputs("digtable: ", stderr);
    (void)vfprintf(stderr, format, args);
    (void)fputs("\ndigtable: see digtable --help\n", stderr);
    va_end(args);
    return EXIT_BAD_INPUT;
}

// An error in what was read is the user's to mend; out of memory is not.
static int bad_input(const enum dig_status status, const struct dig_error *const error)
{
    (void)fprintf(stderr, "digtable: %s\n", error->text);
    return status == DIG_ENOMEM ? EXIT_WORK_FAILED : EXIT_BAD_INPUT;
}

static int work_failed(const enum dig_status status, const struct dig_error *const error)
{
    (void)fprintf(stderr, "digtable: %s\n",
                  error->text[0] != '\0' ? error->text : dig_status_str(status));
    return status == DIG_EINVAL || status == DIG_ESCHEMA ? EXIT_BAD_INPUT : EXIT_WORK_FAILED;
}

static bool parse_number(const char *const text, const double least, const double most,
                         double *const value)
{
    char        *end    = NULL;
    const double number = strtod(text, &end);
    if (end == text || *end != '\0' || !(number >= least && number <= most)) {
        return false;
    }
    *value = number;
    return true;
}

static bool parse_count(const char *const text, const unsigned long least, const unsigned long most,
                        unsigned long *const value)
{
    char               *end    = NULL;
    const unsigned long number = strtoul(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || *end != '\0' || number < least || number > most) {
        return false;
    }
    *value = number;
    return true;
}

static bool parse_channel(const char *const text, enum dig_channel *const channel)
{
    static const char *const names[DIG_CHANNELS] = { "My", "Fx", "Fz" };
    for (int c = 0; c < DIG_CHANNELS; c++) {
        if (strcmp(text, names[c]) == 0) {
            *channel = (enum dig_channel)c;
            return true;
        }
    }
    return false;
}

static unsigned long all_cores(void)
{
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores > 0 ? (unsigned long)cores : 1;
}

// One option into the arguments; NULL, or what was expected instead of its value.
static const char *take_option(const int option, const char *const value, struct arguments *const a)
{
    bool ok = true;
    switch (option) {
    case 'o': a->output = value; break;
    case 'j': ok = parse_count(value, 1, 4096, &a->workers); return ok ? NULL : "1 to 4096";
    case OPTION_TRAJECTORY: a->trajectory = value; break;
    case OPTION_FRICTION:
        ok = parse_number(value, 0.0, 3.0, &a->gravel[DIG_AXIS_FRICTION]);
        return ok ? NULL : "0 to 3";
    case OPTION_ROLLING:
        ok = parse_number(value, 0.0, 3.0, &a->gravel[DIG_AXIS_ROLLING]);
        return ok ? NULL : "0 to 3";
    case OPTION_DENSITY:
        ok = parse_number(value, 100.0, 20000.0, &a->gravel[DIG_AXIS_DENSITY_kgpm3]);
        return ok ? NULL : "kg/m3, 100 to 20000";
    case OPTION_YOUNG:
        ok = parse_number(value, 1.0, 1e12, &a->young_Pa);
        return ok ? NULL : "Pa, 1 to 1e12";
    case OPTION_SEED:
        ok = parse_count(value, 0, (unsigned long)INT64_MAX, &a->seed);
        return ok ? NULL : "a whole number below 2^63";
    case OPTION_ENGINE:
        return strcmp(value, "kernel") == 0 ? NULL
                                            : "kernel (the all-ODE engine is not built in yet)";
    case OPTION_BED: a->bed = value; break;
    case OPTION_SAVE_BED: a->save_bed = value; break;
    case OPTION_VTK: a->vtk = value; break;
    case OPTION_PACKINGS:
        ok = parse_count(value, 1, 1000, &a->packings);
        return ok ? NULL : "1 to 1000";
    case OPTION_TIME_LIMIT:
        ok = parse_number(value, 0.0, 1e9, &a->time_limit_s);
        return ok ? NULL : "seconds, >= 0";
    case OPTION_CHANNEL: ok = parse_channel(value, &a->channel); return ok ? NULL : "My, Fx or Fz";
    case OPTION_CSV: a->csv = true; break;
    case OPTION_JSON: a->json = true; break;
    case OPTION_RUNS: a->runs = true; break;
    case OPTION_COMPLETE: a->complete = true; break;
    default: break;
    }
    return NULL;
}

// A line that is redrawn on a terminal, and a line every few seconds in a log.
struct progress_line {
    bool   tty;
    double every_s, told_s;
};

static struct progress_line progress_line(void)
{
    const bool tty = isatty(STDERR_FILENO) == 1;
    return (struct progress_line){ .tty = tty, .every_s = tty ? 0.2 : 5.0, .told_s = -1e9 };
}

static double now_s(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool is_due(struct progress_line *const line, const bool last)
{
    const double at_s = now_s();
    if (!last && at_s - line->told_s < line->every_s) {
        return false;
    }
    line->told_s = at_s;
    return true;
}

static void end_line(const struct progress_line *const line, const bool last)
{
    (void)fputs(line->tty && !last ? "\033[K" : line->tty ? "\033[K\n" : "\n", stderr);
    (void)fflush(stderr);
}

static const char *span(const double seconds, const size_t size, char text[const])
{
    if (!isfinite(seconds)) {
        (void)snprintf(text, size, "?");
    } else if (seconds < 100.0) {
        (void)snprintf(text, size, "%.0f s", seconds);
    } else {
        const long whole = (long)seconds;
        (void)snprintf(text, size, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    }
    return text;
}

struct dig_watch {
    struct progress_line line;
    double               from_s;
    const char          *what;
};

static int watch_dig(void *const context, const double done_s, const double total_s)
{
    struct dig_watch *const w = context;
    if (is_due(&w->line, false)) {
        char         left[32];
        const double elapsed_s = now_s() - w->from_s;
        const double left_s = done_s > 0.0 ? elapsed_s * (total_s - done_s) / done_s : (double)NAN;
        (void)fprintf(stderr, "%s%s: %.2f of %.2f s simulated, %s left", w->line.tty ? "\r" : "",
                      w->what, done_s, total_s, span(left_s, sizeof left, left));
        end_line(&w->line, false);
    }
    return stop_requested == 0;
}

static enum dig_status get_bed(const struct arguments *const a, const struct dig_scene *const scene,
                               const struct dig_gravel *const gravel, struct dig_bed *const bed,
                               struct dig_error *const error)
{
    if (a->bed != NULL) {
        return dig_bed_read(a->bed, &bed->grains, &bed->x_m, &bed->y_m, &bed->z_m, &bed->radius_m,
                            error);
    }
    struct dig_watch          watch    = { progress_line(), now_s(), "bed" };
    const struct dig_progress progress = { watch_dig, &watch };
    const enum dig_status     status = dig_bed_pour(scene, gravel, a->seed, &progress, bed, error);
    if (status == DIG_OK && watch.line.tty) {
        end_line(&watch.line, true);
    }
    return status;
}

static enum dig_status dig_and_write(const struct arguments *const  a,
                                     const struct dig_scene *const  scene,
                                     const struct dig_gravel *const gravel,
                                     const struct dig_bed *const bed, struct dig_error *const error)
{
    struct dig_watch          watch     = { progress_line(), now_s(), "dig" };
    const struct dig_progress progress  = { watch_dig, &watch };
    struct dig_recording      recording = { 0 };
    enum dig_status           status    = DIG_OK;
    if (a->save_bed != NULL) {
        status = dig_bed_write(a->save_bed, bed->grains, bed->x_m, bed->y_m, bed->z_m,
                               bed->radius_m, error);
    }
    if (status == DIG_OK) {
        status = dig_dig_run(scene, gravel, bed, dig_scene_find(scene, a->trajectory), a->vtk,
                             &progress, &recording, error);
    }
    if (status == DIG_OK) {
        status = dig_recording_write(a->output, &recording, error);
    }
    if (status == DIG_OK) {
        (void)fprintf(stderr, "%s%zu grains, %zu samples, %.1f s -> %s", watch.line.tty ? "\r" : "",
                      bed->grains, recording.rows, now_s() - watch.from_s, a->output);
        end_line(&watch.line, true);
    }
    dig_recording_finish(&recording);
    return status;
}

static int run_dig(const struct arguments *const a)
{
    if (a->trajectory == NULL || a->output == NULL) {
        return bad_usage("dig: %s missing",
                         a->output == NULL ? "-o CURVE.csv" : "--trajectory NAME");
    }
    struct dig_gravel gravel;
    for (int i = 0; i < DIG_AXES; i++) {
        gravel.value[i] = a->gravel[i];
        if (isnan(a->gravel[i])) {
            static const char *const option[DIG_AXES] = { "--friction", "--rolling", "--density" };
            return bad_usage("dig: %s missing", option[i]);
        }
    }
    struct dig_error error = { "" };
    struct dig_scene scene;
    enum dig_status  status = dig_scene_read(a->positional[0], &scene, &error);
    if (status != DIG_OK) {
        return bad_input(status, &error);
    }
    if (dig_scene_find(&scene, a->trajectory) == NULL) {
        (void)fprintf(stderr,
                      "digtable: %s: trajectories: no \"%s\", expected one of:", a->positional[0],
                      a->trajectory);
        for (size_t i = 0; i < scene.trajectories; i++) {
            (void)fprintf(stderr, " %s", scene.trajectory[i].name);
        }
        (void)fputc('\n', stderr);
        return EXIT_BAD_INPUT;
    }
    if (!isnan(a->young_Pa)) {
        scene.material.young_Pa = a->young_Pa;
    }

    struct dig_bed bed = { 0 };
    status             = get_bed(a, &scene, &gravel, &bed, &error);
    if (status != DIG_OK) {
        return a->bed != NULL ? bad_input(status, &error) : work_failed(status, &error);
    }
    status = dig_and_write(a, &scene, &gravel, &bed, &error);
    dig_bed_finish(&bed);
    return status == DIG_OK ? EXIT_DONE : work_failed(status, &error);
}

static void tell_sweep(void *const context, const struct dig_sweep_state *const s)
{
    struct progress_line *const line = context;
    if (is_due(line, false)) {
        char elapsed[32];
        char left[32];
        (void)fprintf(stderr, "%s%zu of %zu digs, %zu running, %s elapsed, %s left",
                      line->tty ? "\r" : "", s->digs_done, s->digs_total, s->workers,
                      span(s->elapsed_s, sizeof elapsed, elapsed),
                      span(s->left_s, sizeof left, left));
        end_line(line, false);
    }
}

static int tell_end(const struct arguments *const a, const struct dig_sweep_state *const s,
                    const enum dig_status status, const struct dig_error *const error)
{
    char elapsed[32];
    (void)fprintf(stderr, "%s: %zu of %zu digs, %s", a->output, s->digs_done, s->digs_total,
                  span(s->elapsed_s, sizeof elapsed, elapsed));
    if (s->digs_done < s->digs_total) {
        (void)fprintf(stderr, "; %zu left%s, the same command goes on with them",
                      s->digs_total - s->digs_done,
                      status != DIG_OK      ? ""
                      : stop_requested != 0 ? " (interrupted)"
                                            : " (time limit)");
    }
    (void)fputc('\n', stderr);
    if (status != DIG_OK) {
        if (s->failed > 0) {
            (void)fprintf(stderr, "digtable: %zu digs failed, the first:\n", s->failed);
        }
        return work_failed(status, error);
    }
    return stop_requested != 0 && s->digs_done < s->digs_total ? EXIT_WORK_FAILED : EXIT_DONE;
}

static int run_generate(const struct arguments *const a)
{
    if (a->output == NULL) {
        return bad_usage("generate: %s missing", "-o TABLE.sqlite");
    }
    struct dig_error error = { "" };
    struct dig_scene scene;
    struct dig_grid  grid;
    enum dig_status  status = dig_scene_read(a->positional[0], &scene, &error);
    if (status == DIG_OK) {
        status = dig_grid_read(a->positional[1], &grid, &error);
    }
    if (status != DIG_OK) {
        return bad_input(status, &error);
    }
    struct dig_plan plan = { .packings = a->packings > 0 ? a->packings : grid.packings };
    for (int i = 0; i < DIG_AXES; i++) {
        plan.count[i] = grid.count[i];
        plan.value[i] = grid.value[i];
    }
    status = dig_grid_trajectories(a->positional[1], &grid, &scene, &plan.trajectories,
                                   plan.trajectory, &error);
    if (status != DIG_OK) {
        return bad_input(status, &error);
    }

    struct dig_store *store = NULL;
    status                  = dig_store_create(a->output, &scene, &store, &error);
    if (status != DIG_OK) {
        return work_failed(status, &error);
    }
    struct progress_line           line    = progress_line();
    const struct dig_engine        engine  = dig_engine_kernel();
    const struct dig_sweep_options options = {
        .workers      = a->workers,
        .time_limit_s = a->time_limit_s,
        .stop         = &stop_requested,
        .tell         = tell_sweep,
        .context      = &line,
    };
    struct dig_sweep_state state = { .digs_total = 0 };
    status = dig_sweep_run(&scene, &plan, &engine, &options, store, &state, &error);
    dig_store_close(store);
    if (line.tty) {
        end_line(&line, true);
    }
    return tell_end(a, &state, status, &error);
}

// Results go to stdout, or whole or not at all to -o.
static int with_output(const struct arguments *const a,
                       enum dig_status (*const write)(const void *context, FILE *file,
                                                      struct dig_error *error),
                       const void *const context)
{
    struct dig_error error  = { "" };
    struct dig_out   out    = { .file = NULL };
    enum dig_status  status = dig_out_open(&out, a->output != NULL ? a->output : "-", &error);
    if (status == DIG_OK) {
        status = write(context, out.file, &error);
    }
    if (status == DIG_OK) {
        status = dig_out_commit(&out, &error);
    }
    dig_out_cancel(&out);
    return status == DIG_OK ? EXIT_DONE : work_failed(status, &error);
}

static int run_list(const struct arguments *const a)
{
    struct dig_error      error  = { "" };
    struct dig_curve_set *set    = NULL;
    const enum dig_status status = dig_table_load(a->positional[0], &set, &error);
    if (status != DIG_OK) {
        return bad_input(status, &error);
    }
    if (a->json) {
        dig_export_list_json(set, stdout);
    } else {
        dig_export_list(set, stdout);
    }
    dig_curve_set_destroy(set);
    return EXIT_DONE;
}

static int run_check(const struct arguments *const a)
{
    struct dig_error        error  = { "" };
    struct dig_store       *store  = NULL;
    struct dig_store_report report = { .entries = 0 };
    enum dig_status         status = dig_store_open(a->positional[0], &store, &error);
    if (status == DIG_OK) {
        status = dig_store_check(store, &report, &error);
    }
    dig_store_close(store);
    if (status != DIG_OK) {
        return bad_input(status, &error);
    }
    if (a->json) {
        (void)printf("{\"points\": %zu, \"entries\": %zu, \"runs\": %zu, \"holes\": %zu, "
                     "\"incomplete\": %zu}\n",
                     report.points, report.entries, report.runs, report.holes, report.incomplete);
    } else {
        (void)printf("%s: sound; %zu points, %zu entries, %zu runs; %zu holes in the grid, %zu "
                     "entries with fewer packings\n",
                     a->positional[0], report.points, report.entries, report.runs, report.holes,
                     report.incomplete);
    }
    return a->complete && report.holes + report.incomplete > 0 ? EXIT_WORK_FAILED : EXIT_DONE;
}

// The entry asked for, by number or by gravel; set->entries when there is none.
static size_t find_entry(const struct arguments *const a, const struct dig_curve_set *const set)
{
    if (a->positionals == 2) {
        unsigned long number = 0;
        return parse_count(a->positional[1], 0, set->entries - 1, &number) ? number : set->entries;
    }
    size_t e = 0;
    for (; e < set->entries; e++) {
        bool same = true;
        for (int i = 0; i < DIG_AXES; i++) {
            same = same && fabs(set->gravel[e].value[i] - a->gravel[i]) <= 1e-9 * a->gravel[i];
        }
        if (same) {
            break;
        }
    }
    return e;
}

static int show(const struct arguments *const a, const struct dig_curve_set *const set)
{
    const size_t entry = find_entry(a, set);
    if (entry >= set->entries) {
        return bad_usage("%s: no such entry, digtable list shows all", a->positional[0]);
    }
    size_t trajectory = 0;
    while (trajectory < set->trajectories &&
           (a->trajectory != NULL ? strcmp(a->trajectory, set->trajectory[trajectory].name) != 0
                                  : set->packings[entry * set->trajectories + trajectory] == 0)) {
        trajectory++;
    }
    if (trajectory >= set->trajectories ||
        set->packings[entry * set->trajectories + trajectory] == 0) {
        return bad_usage("%s: no such trajectory in this entry, digtable list shows all",
                         a->trajectory != NULL ? a->trajectory : a->positional[0]);
    }
    if (a->csv) {
        dig_export_curve_csv(set, entry, trajectory, stdout);
    } else if (a->json) {
        dig_export_curve_json(set, entry, trajectory, stdout);
    } else {
        dig_export_curve_plot(set, entry, trajectory, a->channel, 72, stdout);
    }
    return EXIT_DONE;
}

static int run_show(const struct arguments *const a)
{
    for (int i = 0; i < DIG_AXES; i++) {
        if (a->positionals < 2 && isnan(a->gravel[i])) {
            return bad_usage("show: %s", "name an ENTRY, or --friction, --rolling and --density");
        }
    }
    struct dig_error      error  = { "" };
    struct dig_curve_set *set    = NULL;
    const enum dig_status status = dig_table_load(a->positional[0], &set, &error);
    if (status != DIG_OK) {
        return bad_input(status, &error);
    }
    const int code = show(a, set);
    dig_curve_set_destroy(set);
    return code;
}

static enum dig_status write_curves(const void *const set, FILE *const file,
                                    struct dig_error *const error)
{
    (void)error;
    dig_export_curves(set, file);
    return DIG_OK;
}

struct runs_to_write {
    struct dig_store *store;
};

static enum dig_status write_runs(const void *const context, FILE *const file,
                                  struct dig_error *const error)
{
    const struct runs_to_write *const runs = context;
    return dig_export_runs(runs->store, file, error);
}

static int run_export(const struct arguments *const a)
{
    struct dig_error error = { "" };
    if (a->runs) {
        struct runs_to_write  runs   = { NULL };
        const enum dig_status status = dig_store_open(a->positional[0], &runs.store, &error);
        if (status != DIG_OK) {
            return bad_input(status, &error);
        }
        const int code = with_output(a, write_runs, &runs);
        dig_store_close(runs.store);
        return code;
    }
    struct dig_curve_set *set    = NULL;
    const enum dig_status status = dig_table_load(a->positional[0], &set, &error);
    if (status != DIG_OK) {
        return bad_input(status, &error);
    }
    const int code = with_output(a, write_curves, set);
    dig_curve_set_destroy(set);
    return code;
}

struct command {
    const char *name;
    int (*run)(const struct arguments *a);
    int         least, most; // positional arguments
    const char *positional;
    const char *options; // "friction rolling …", and the letters o and j
};

static const struct command commands[] = {
    { "dig", run_dig, 1, 1, "SCENE.yaml",
      " trajectory friction rolling density young seed engine bed save-bed vtk output " },
    { "generate", run_generate, 2, 2, "SCENE.yaml GRID.yaml",
      " output jobs packings time-limit engine " },
    { "list", run_list, 1, 1, "TABLE.sqlite", " json " },
    { "check", run_check, 1, 1, "TABLE.sqlite", " json complete " },
    { "show", run_show, 1, 2, "TABLE.sqlite",
      " friction rolling density trajectory channel csv json " },
    { "export", run_export, 1, 1, "TABLE.sqlite", " runs output " },
};

static const char *option_name(const int id)
{
    const struct option *o = long_options;
    while (o->name != NULL && o->val != id) {
        o++;
    }
    return o->name != NULL ? o->name : "?";
}

static bool takes(const struct command *const command, const int option)
{
    char word[32];
    (void)snprintf(word, sizeof word, " %s ", option_name(option));
    return strstr(command->options, word) != NULL;
}

static int parse(const struct command *const command, const int argc, char **const argv,
                 struct arguments *const a)
{
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, ":o:j:", long_options, NULL)) != -1;) {
        if (option == ':') {
            return bad_usage("%s: needs a value", argv[optind - 1]);
        }
        if (option == '?') {
            return bad_usage("%s: unknown option", argv[optind - 1]);
        }
        if (!takes(command, option)) {
            (void)fprintf(stderr, "digtable: %s takes no --%s\n", command->name,
                          option_name(option));
            return EXIT_BAD_INPUT;
        }
        const char *const expected = take_option(option, optarg, a);
        if (expected != NULL) {
            (void)fprintf(stderr, "digtable: --%s %s: expected %s\n", option_name(option), optarg,
                          expected);
            return EXIT_BAD_INPUT;
        }
    }
    for (; optind < argc; optind++) {
        if (a->positionals == command->most) {
            return bad_usage("%s: one argument too many", argv[optind]);
        }
        a->positional[a->positionals++] = argv[optind];
    }
    return a->positionals >= command->least ? EXIT_DONE
                                            : bad_usage("expected %s", command->positional);
}

static void catch_signals(void)
{
    const struct sigaction action = { .sa_handler = request_stop, .sa_flags = 0 };
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
}

int main(const int argc, char **const argv)
{
    if (argc < 2) {
        return bad_usage("%s", "expected a command");
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        (void)fputs(help_text, stdout);
        return EXIT_DONE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        (void)puts("digtable " DIG_VERSION);
        return EXIT_DONE;
    }
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        if (strcmp(commands[i].name, argv[1]) != 0) {
            continue;
        }
        for (int k = 2; k < argc; k++) {
            if (strcmp(argv[k], "--help") == 0) {
                (void)fputs(help_text, stdout);
                return EXIT_DONE;
            }
        }
        struct arguments a = {
            .gravel       = { (double)NAN, (double)NAN, (double)NAN },
            .young_Pa     = (double)NAN,
            .seed         = 1,
            .workers      = all_cores(),
            .time_limit_s = (double)INFINITY,
        };
        const int code = parse(&commands[i], argc - 1, argv + 1, &a);
        if (code != EXIT_DONE) {
            return code;
        }
        catch_signals();
        return commands[i].run(&a);
    }
    return bad_usage("%s: unknown command", argv[1]);
}
