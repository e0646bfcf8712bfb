#include "files/recording_csv.h"

#include "files/lcm/lcm_log.h"
#include "files/text/csv.h"
#include "files/text/whole.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define GAP_MAX_s  0.02  // 50 Hz
#define BUS_MAX_s  0.025 // so often a machine's bus of 50 Hz comes that loses a row in five
#define ROWS_MIN   2
#define GAP_SLACK  1e-6 // of the gap: times are written with few digits
#define VALUE_MAX  1e30 // far beyond every machine; products of such are numbers still
#define TIME_MAX_s 9e9  // nanoseconds in 64 bits hold it; of seconds since 1970 till the year 2255

// As struct dig_force_row has them, one behind the other.
static const struct dig_csv_column force_column[] = {
    { .name = "t_s" },
    { .name = "pin_x_m" },
    { .name = "pin_z_m" },
    { .name = "theta_deg" },
    { .name = "Fx_N", .optional = true, .may_empty = true },
    { .name = "Fy_N", .optional = true, .may_empty = true },
    { .name = "Fz_N", .optional = true, .may_empty = true },
    { .name = "Mx_Nm", .optional = true, .may_empty = true },
    { .name = "My_Nm", .may_empty = true },
    { .name = "Mz_Nm", .optional = true, .may_empty = true },
    { .name = "carried_kg", .optional = true, .may_empty = true },
};
#define FORCE_COLUMNS (sizeof force_column / sizeof force_column[0])
_Static_assert(sizeof(struct dig_force_row) == FORCE_COLUMNS * sizeof(double), "a column each");

// Time, then one column a signal in the signals' own order: of a machine with cylinders, or of a
// rig with a force sensor.
struct machine_columns {
    size_t                count;
    struct dig_csv_column column[DIG_SIGNALS + 1];
    enum dig_signal       signal[DIG_SIGNALS + 1]; // from the second column on
};

static struct machine_columns machine_columns(const enum dig_sensing sensing)
{
    struct machine_columns of = { .count = 1, .column = { { .name = "t_s" } } };
    for (int s = 0; s < DIG_SIGNALS; s++) {
        const enum dig_signal signal = (enum dig_signal)s;
        if (!dig_signal_is_needed(sensing, signal) && !dig_signal_is_optional(signal)) {
            continue;
        }
        of.signal[of.count]   = signal;
        of.column[of.count++] = (struct dig_csv_column){
            .name      = dig_signal_name(signal),
            .optional  = !dig_signal_gives_moment(sensing, signal),
            .may_empty = true,
        };
    }
    return of;
}

bool dig_machine_recording_is(const char *const path)
{
    return dig_csv_has(path, dig_signal_name(DIG_SIGNAL_BUCKET_rad));
}

static void check_rows(const struct dig_csv *const csv, const char *const path,
                       const struct dig_csv_column column[], struct dig_conditions *const c)
{
    dig_require(c, csv->rows >= ROWS_MIN, "%s:%d: column t_s: 1 row, expected at least %d", path,
                csv->line[0], ROWS_MIN);
    for (size_t i = 0; i < csv->rows && c->status == DIG_OK; i++) {
        const double *const row      = &csv->value[i * csv->columns];
        const double        before_s = i > 0 ? row[-(ptrdiff_t)csv->columns] : -(double)INFINITY;
        dig_require(c, fabs(row[0]) <= TIME_MAX_s, "%s:%d: column t_s: %g, expected within +-%g",
                    path, csv->line[i], row[0], TIME_MAX_s);
        dig_require(c, row[0] > before_s,
                    "%s:%d: column t_s: %.9g after %.9g, expected ascending time", path,
                    csv->line[i], row[0], before_s);
        for (size_t k = 1; k < csv->columns; k++) {
            dig_require(c, !(fabs(row[k]) > VALUE_MAX),
                        "%s:%d: column %s: %g, expected within +-%g", path, csv->line[i],
                        column[k].name, row[k], VALUE_MAX);
        }
    }
}

static double gap_before_s(const struct dig_csv *const csv, const size_t row)
{
    return csv->value[row * csv->columns] - csv->value[(row - 1) * csv->columns];
}

// Of a force recording, as a curve is made of all rows.
static void check_every_gap(const struct dig_csv *const csv, const char *const path,
                            struct dig_conditions *const c)
{
    for (size_t i = 1; i < csv->rows && c->status == DIG_OK; i++) {
        const double gap_s = gap_before_s(csv, i);
        dig_require(c, gap_s <= GAP_MAX_s * (1.0 + GAP_SLACK),
                    "%s:%d: column t_s: %.4g s between samples, expected %g s or less (50 Hz or "
                    "faster)",
                    path, csv->line[i], gap_s, GAP_MAX_s);
    }
}

// Of a machine recording, as a bus may drop samples now and then: most of them.
static void check_most_gaps(const struct dig_csv *const csv, const char *const path,
                            struct dig_conditions *const c)
{
    size_t wide = 0;
    for (size_t i = 1; i < csv->rows; i++) {
        wide += gap_before_s(csv, i) <= BUS_MAX_s * (1.0 + GAP_SLACK) ? 0 : 1;
    }
    dig_require(c, 2 * wide < csv->rows,
                "%s: column t_s: %zu of %zu samples come more than %g s after the one before, "
                "expected a few (50 Hz or faster)",
                path, wide, csv->rows, BUS_MAX_s);
}

// Reads a file of these columns, and checks its rows' times and their rate.
static enum dig_status read_rows(const char *const path, const size_t columns,
                                 const struct dig_csv_column column[], struct dig_csv *const csv,
                                 struct dig_error *const error)
{
    struct dig_conditions c = { .error = error };
    const enum dig_status status =
        dig_csv_read(path, DIG_CSV_REFUSE_OTHERS, columns, column, csv, error);
    if (status != DIG_OK) {
        return status;
    }
    check_rows(csv, path, column, &c);
    if (column == force_column) {
        check_every_gap(csv, path, &c);
    } else {
        check_most_gaps(csv, path, &c);
    }
    if (c.status != DIG_OK) {
        dig_csv_finish(csv);
    }
    return c.status;
}

enum dig_status dig_recording_read(const char *const path, struct dig_recording *const recording,
                                   struct dig_error *const error)
{
    assert(path != NULL && recording != NULL);

    struct dig_csv        csv;
    const enum dig_status status = read_rows(path, FORCE_COLUMNS, force_column, &csv, error);
    if (status == DIG_OK) {
        // The values are the rows, which stay.
        *recording = (struct dig_recording){ .rows = csv.rows, .row = (void *)csv.value };
        csv.value  = NULL;
        dig_csv_finish(&csv);
    }
    return status;
}

static struct dig_sample sample_row(const struct machine_columns *const of, const double v[const])
{
    struct dig_sample sample = { .time_ns = llround(v[0] * 1e9) };
    for (size_t c = 1; c < of->count; c++) {
        const enum dig_signal s = of->signal[c];
        sample.valid[s]         = !isnan(v[c]);
        sample.value[s]         = sample.valid[s] ? v[c] : 0.0;
    }
    return sample;
}

enum dig_status dig_machine_recording_read(const char *const                   path,
                                           struct dig_machine_recording *const recording,
                                           struct dig_error *const             error)
{
    assert(path != NULL && recording != NULL);
    if (dig_lcm_log_is(path)) {
        return dig_lcm_log_read(path, recording, error);
    }
    const bool senses = dig_csv_has(path, dig_signal_name(DIG_SIGNAL_SENSOR_MY_Nm));
    const struct machine_columns of =
        machine_columns(senses ? DIG_SENSING_SENSOR : DIG_SENSING_CYLINDERS);
    struct dig_csv  csv;
    enum dig_status status = read_rows(path, of.count, of.column, &csv, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_sample *const row = malloc(csv.rows * sizeof *row);
    for (size_t i = 0; row != NULL && i < csv.rows; i++) {
        row[i] = sample_row(&of, csv.value + i * csv.columns);
    }
    if (row != NULL) {
        *recording = (struct dig_machine_recording){ .rows = csv.rows, .row = row };
    } else {
        status = dig_error_set(error, DIG_ENOMEM, "%s: no memory for %zu rows", path, csv.rows);
    }
    dig_csv_finish(&csv);
    return status;
}

enum dig_status dig_recording_write(const char *const                 path,
                                    const struct dig_recording *const recording,
                                    struct dig_error *const           error)
{
    assert(recording != NULL);

    struct dig_out        out;
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_c_locale locale  = dig_c_locale_enter();
    const size_t        columns = FORCE_COLUMNS - (dig_recording_knows_carried(recording) ? 0 : 1);
    for (size_t c = 0; c < columns; c++) {
        (void)fprintf(out.file, "%s%s", c == 0 ? "" : ",", force_column[c].name);
    }
    (void)fputc('\n', out.file);
    for (size_t i = 0; i < recording->rows; i++) {
        double value[FORCE_COLUMNS];
        memcpy(value, &recording->row[i], sizeof value);
        for (size_t c = 0; c < columns; c++) {
            (void)fputs(c == 0 ? "" : ",", out.file);
            if (!isnan(value[c])) {
                (void)fprintf(out.file, "%.9g", value[c]);
            }
        }
        (void)fputc('\n', out.file);
    }
    dig_c_locale_leave(&locale);
    return dig_out_commit(&out, error);
}

// A signal has a column when at least one sample holds it, or when it is needed.
static void find_written(const struct dig_machine_recording *const recording,
                         bool                                      written[const DIG_SIGNALS])
{
    memset(written, 0, DIG_SIGNALS * sizeof written[0]);
    for (size_t i = 0; i < recording->rows; i++) {
        for (int s = 0; s < DIG_SIGNALS; s++) {
            written[s] = written[s] || recording->row[i].valid[s];
        }
    }
    const enum dig_sensing sensing = dig_signals_sensing(written);
    for (int s = 0; s < DIG_SIGNALS; s++) {
        const enum dig_signal signal = (enum dig_signal)s;
        written[s] =
            dig_signal_is_needed(sensing, signal) || (written[s] && dig_signal_is_optional(signal));
    }
}

enum dig_status dig_machine_recording_write(const char *const                         path,
                                            const struct dig_machine_recording *const recording,
                                            struct dig_error *const                   error)
{
    assert(recording != NULL);

    struct dig_out        out;
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    bool written[DIG_SIGNALS];
    find_written(recording, written);
    (void)fputs("t_s", out.file);
    for (int s = 0; s < DIG_SIGNALS; s++) {
        if (written[s]) {
            (void)fprintf(out.file, ",%s", dig_signal_name((enum dig_signal)s));
        }
    }
    (void)fputc('\n', out.file);

    struct dig_c_locale locale = dig_c_locale_enter();
    for (size_t i = 0; i < recording->rows; i++) {
        const struct dig_sample *const sample = &recording->row[i];
        (void)fprintf(out.file, "%.9f", (double)sample->time_ns / 1e9);
        for (int s = 0; s < DIG_SIGNALS; s++) {
            if (written[s] && sample->valid[s]) {
                (void)fprintf(out.file, ",%.12g", sample->value[s]);
            } else if (written[s]) {
                (void)fputc(',', out.file);
            }
        }
        (void)fputc('\n', out.file);
    }
    dig_c_locale_leave(&locale);
    return dig_out_commit(&out, error);
}
