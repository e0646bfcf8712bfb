#include "tests/paper/digs.h"

#include "closed_loop/recordings/observe.h"
#include "core/units.h"
#include "files/recording_csv.h"
#include "tables/derive.h"
#include "tables/load.h"
#include "tables/store.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t entry_of(const struct dig_curve_set *const set, const double gravel[const DIG_AXES])
{
    for (size_t e = 0; e < set->entries; e++) {
        bool same = true;
        for (int a = 0; a < DIG_AXES; a++) {
            same = same && fabs(set->gravel[e].value[a] - gravel[a]) <= 1e-9 * gravel[a];
        }
        if (same) {
            return e;
        }
    }
    return SIZE_MAX;
}

static enum dig_status take_run(void *const context, const struct dig_run *const run,
                                struct dig_error *const error)
{
    struct paper_table *const         table = context;
    const struct dig_curve_set *const set   = table->set;
    if (run->origin.effect[0] != '\0' || !dig_approach_is_plain(&run->origin.approach)) {
        return DIG_OK;
    }
    struct paper_run *const more = realloc(table->run, (table->runs + 1) * sizeof *more);
    double                  curve[DIG_CHANNELS][DIG_CURVE_POINTS];
    if (more == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "no memory");
    }
    table->run = more;
    const enum dig_status status =
        dig_derive_run(&set->trajectory[run->origin.trajectory], set->tooth_m, set->smooth_half_s,
                       run->windows, run->first_s, run->step_s, run->value, curve);
    if (status == DIG_OK) {
        struct paper_run *const r = &table->run[table->runs++];
        r->entry                  = entry_of(set, run->origin.gravel.value);
        r->trajectory             = run->origin.trajectory;
        r->packing                = run->origin.packing;
        memcpy(r->moment_Nm, curve[DIG_CHANNEL_MY_Nm], sizeof r->moment_Nm);
        r->windows = run->windows;
        r->first_s = run->first_s;
        r->step_s  = run->step_s;
        r->raw     = malloc(3 * run->windows * sizeof *r->raw);
        if (r->raw == NULL) {
            return dig_error_set(error, DIG_ENOMEM, "no memory");
        }
        memcpy(r->raw, run->value, 3 * run->windows * sizeof *r->raw);
    }
    return status;
}

static enum dig_status load_table(const char *const path, struct paper_table *const table,
                                  struct dig_error *const error)
{
    struct dig_store *store  = NULL;
    enum dig_status   status = dig_table_load(path, &table->set, error);
    if (status == DIG_OK) {
        status = dig_store_open(path, &store, error);
    }
    if (status == DIG_OK) {
        const struct dig_run_visitor visitor = { take_run, table };
        status                               = dig_store_walk(store, &visitor, error);
    }
    dig_store_close(store);
    return status;
}

static void name_recording(const char *const file, const struct dig_curve_set *const set,
                           struct paper_recording *const r)
{
    const char *const slash = strrchr(file, '/');
    const char *const name  = slash != NULL ? slash + 1 : file;
    double            gravel[DIG_AXES];
    (void)snprintf(r->name, sizeof r->name, "%.*s", (int)strcspn(name, "."), name);
    const char *const end = strstr(name, ".csv");
    if (end != NULL && (size_t)(end - name) < sizeof r->name) {
        (void)snprintf(r->name, sizeof r->name, "%.*s", (int)(end - name), name);
    }
    r->entry = SIZE_MAX;
    if (sscanf(name, "mu%lf_mur%lf_rho%lf", &gravel[0], &gravel[1], &gravel[2]) == 3) {
        r->entry = entry_of(set, gravel);
    }
}

static enum dig_status take_recording(const char *const file, struct paper_table *const table,
                                      struct dig_error *const error)
{
    struct dig_recording recording = { 0 };
    struct dig_measured  seen;
    enum dig_status      status = dig_recording_read(file, &recording, error);
    if (status == DIG_OK) {
        status = dig_observe_dig(table->set, &recording, &seen, error);
        dig_recording_finish(&recording);
    }
    if (status != DIG_OK) {
        return status;
    }
    struct paper_recording *const r = &table->recording[table->recordings++];
    name_recording(file, table->set, r);
    r->trajectory = (size_t)seen.trajectory;
    memcpy(r->moment_Nm, seen.value[DIG_CHANNEL_MY_Nm], sizeof r->moment_Nm);
    return DIG_OK;
}

enum dig_status paper_load(const char *const path, const size_t files, char *const file[],
                           struct paper_table *const table, struct dig_error *const error)
{
    *table           = (struct paper_table){ .runs = 0 };
    table->recording = calloc(files + 1, sizeof *table->recording);
    if (table->recording == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "no memory");
    }
    enum dig_status status = load_table(path, table, error);
    for (size_t i = 0; status == DIG_OK && i < files; i++) {
        status = take_recording(file[i], table, error);
    }
    if (status != DIG_OK) {
        paper_finish(table);
    }
    return status;
}

void paper_finish(struct paper_table *const table)
{
    dig_curve_set_destroy(table->set);
    for (size_t i = 0; i < table->runs; i++) {
        free(table->run[i].raw);
    }
    free(table->run);
    free(table->recording);
    *table = (struct paper_table){ .runs = 0 };
}

size_t paper_trajectory(const struct paper_table *const table, const char *const name)
{
    for (size_t t = 0; t < table->set->trajectories; t++) {
        if (strcmp(table->set->trajectory[t].name, name) == 0) {
            return t;
        }
    }
    (void)fprintf(stderr, "paper: the table has no trajectory %s\n", name);
    exit(1);
}

size_t paper_mean(const struct paper_table *const table, const size_t entry,
                  const size_t trajectory, const size_t skip,
                  double mean_Nm[const DIG_CURVE_POINTS])
{
    size_t beds = 0;
    memset(mean_Nm, 0, DIG_CURVE_POINTS * sizeof *mean_Nm);
    for (size_t i = 0; i < table->runs; i++) {
        const struct paper_run *const r = &table->run[i];
        if (r->entry == entry && r->trajectory == trajectory && i != skip) {
            beds++;
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                mean_Nm[k] += r->moment_Nm[k];
            }
        }
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS && beds > 0; k++) {
        mean_Nm[k] /= (double)beds;
    }
    return beds;
}

size_t paper_same_bed(const struct paper_table *const table, const size_t run,
                      const size_t trajectory)
{
    const struct paper_run *const of = &table->run[run];
    for (size_t i = 0; i < table->runs; i++) {
        const struct paper_run *const r = &table->run[i];
        if (r->entry == of->entry && r->packing == of->packing && r->trajectory == trajectory) {
            return i;
        }
    }
    return SIZE_MAX;
}

const struct paper_recording *paper_pair(const struct paper_table *const table,
                                         const size_t recording, const size_t trajectory)
{
    const char *const name   = table->recording[recording].name;
    const char *const mark   = strstr(name, "__");
    const size_t      length = mark != NULL ? (size_t)(mark - name) : strlen(name);
    for (size_t i = 0; i < table->recordings; i++) {
        const struct paper_recording *const r = &table->recording[i];
        if (r->trajectory == trajectory && strncmp(r->name, name, length) == 0 &&
            strncmp(r->name + length, "__", 2) == 0) {
            return r;
        }
    }
    return NULL;
}

bool paper_is_object(const double gravel[const DIG_AXES])
{
    static const double object[][DIG_AXES] = { { .5, .9, 2500 },
                                               { .3, .9, 2500 },
                                               { .3, .3, 2500 } };
    for (size_t i = 0; i < sizeof object / sizeof object[0]; i++) {
        bool same = true;
        for (int a = 0; a < DIG_AXES; a++) {
            same = same && fabs(object[i][a] - gravel[a]) < 1e-9;
        }
        if (same) {
            return true;
        }
    }
    return false;
}

void paper_write_curve(const char *const out, const char *const name,
                       const struct paper_table *const table, const size_t trajectory,
                       const double moment_Nm[const DIG_CURVE_POINTS])
{
    char path[512];
    (void)snprintf(path, sizeof path, "%s/%s.dat", out, name);
    FILE *const file = fopen(path, "w");
    if (file == NULL) {
        (void)fprintf(stderr, "paper: %s: cannot be written\n", path);
        exit(1);
    }
    const struct dig_trajectory *const t = &table->set->trajectory[trajectory];
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress = (double)k / (DIG_CURVE_POINTS - 1);
        (void)fprintf(file, "%.6g %.6g\n", dig_trajectory_time_s(t, table->set->tooth_m, progress),
                      moment_Nm[k]);
    }
    (void)fclose(file);
}

void paper_write_run(const char *const out, const char *const name,
                     const struct paper_table *const table, const size_t run)
{
    const struct paper_run *const      r = &table->run[run];
    const struct dig_trajectory *const t = &table->set->trajectory[r->trajectory];
    struct dig_recording recording = { r->windows, calloc(r->windows, sizeof *recording.row) };
    struct dig_error     error     = { "" };
    char                 path[512];
    (void)snprintf(path, sizeof path, "%s/%s.csv", out, name);
    for (size_t i = 0; recording.row != NULL && i < r->windows; i++) {
        const double          t_s  = r->first_s + (double)i * r->step_s;
        const struct dig_pose pose = dig_trajectory_pose(t, t_s);
        recording.row[i]           = (struct dig_force_row){
                      .t_s        = t_s,
                      .pin_x_m    = pose.x_m,
                      .pin_z_m    = pose.z_m,
                      .theta_deg  = pose.theta_rad / DIG_RAD_PER_DEG,
                      .My_Nm      = (double)r->raw[DIG_CHANNEL_MY_Nm * r->windows + i],
                      .Fx_N       = (double)r->raw[DIG_CHANNEL_FX_N * r->windows + i],
                      .Fz_N       = (double)r->raw[DIG_CHANNEL_FZ_N * r->windows + i],
                      .carried_kg = (double)NAN,
        };
    }
    if (recording.row == NULL || dig_recording_write(path, &recording, &error) != DIG_OK) {
        (void)fprintf(stderr, "paper: %s: %s\n", path, error.text);
        exit(1);
    }
    dig_recording_finish(&recording);
}
