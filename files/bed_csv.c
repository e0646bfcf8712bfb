#include "files/bed_csv.h"

#include "files/text/csv.h"
#include "files/text/whole.h"

#include <math.h>
#include <stdbool.h>

enum { X, Y, Z, RADIUS, MATERIAL, CLUMP, COLUMNS };

static const struct dig_csv_column column[COLUMNS] = {
    [X]        = { .name = "x_m" },
    [Y]        = { .name = "y_m" },
    [Z]        = { .name = "z_m" },
    [RADIUS]   = { .name = "radius_m" },
    [MATERIAL] = { .name = "material", .optional = true },
    [CLUMP]    = { .name = "clump", .optional = true },
};

static double at(const struct dig_csv *const csv, const size_t row, const size_t c)
{
    return csv->value[row * COLUMNS + c];
}

// A column that is absent holds NaN throughout.
static bool has(const struct dig_csv *const csv, const size_t c)
{
    return !isnan(at(csv, 0, c));
}

static bool is_whole(const double value, const double from, const double to)
{
    return value >= from && value <= to && !(value > floor(value));
}

static enum dig_status check(const struct dig_csv *const csv, const char *const path,
                             struct dig_error *const error)
{
    struct dig_conditions c = { .error = error };
    for (size_t i = 0; i < csv->rows; i++) {
        dig_require(&c, at(csv, i, RADIUS) > 0.0, "%s:%d: column radius_m: %g, expected > 0", path,
                    csv->line[i], at(csv, i, RADIUS));
        dig_require(&c,
                    !has(csv, MATERIAL) || is_whole(at(csv, i, MATERIAL), 0.0, (double)UINT8_MAX),
                    "%s:%d: column material: %g, expected a whole number from 0 to %d", path,
                    csv->line[i], at(csv, i, MATERIAL), UINT8_MAX);
        dig_require(&c, !has(csv, CLUMP) || is_whole(at(csv, i, CLUMP), 1.0, (double)UINT32_MAX),
                    "%s:%d: column clump: %g, expected a whole number from 1", path, csv->line[i],
                    at(csv, i, CLUMP));
    }
    return c.status;
}

static enum dig_status take(const struct dig_csv *const csv, struct dig_bed *const bed)
{
    const size_t          n      = csv->rows;
    struct dig_bed        made   = { 0 };
    const enum dig_status status = dig_bed_create(n, has(csv, MATERIAL), has(csv, CLUMP), &made);
    if (status != DIG_OK) {
        return status;
    }
    for (size_t i = 0; i < n; i++) {
        made.x_m[i]      = at(csv, i, X);
        made.y_m[i]      = at(csv, i, Y);
        made.z_m[i]      = at(csv, i, Z);
        made.radius_m[i] = at(csv, i, RADIUS);
        if (made.material != NULL) {
            made.material[i] = (uint8_t)at(csv, i, MATERIAL);
        }
        if (made.clump != NULL) {
            made.clump[i] = (uint32_t)at(csv, i, CLUMP);
        }
    }
    *bed = made;
    return DIG_OK;
}

enum dig_status dig_bed_read(const char *const path, struct dig_bed *const bed,
                             struct dig_error *const error)
{
    struct dig_csv  csv;
    enum dig_status status =
        dig_csv_read(path, DIG_CSV_REFUSE_OTHERS, COLUMNS, column, &csv, error);
    if (status != DIG_OK) {
        return status;
    }
    status = check(&csv, path, error);
    if (status == DIG_OK && take(&csv, bed) != DIG_OK) {
        status = dig_error_set(error, DIG_ENOMEM, "%s: no memory for %zu grains", path, csv.rows);
    }
    dig_csv_finish(&csv);
    return status;
}

enum dig_status dig_bed_write(const char *const path, const struct dig_bed *const bed,
                              struct dig_error *const error)
{
    struct dig_out        out;
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_c_locale locale = dig_c_locale_enter();
    (void)fprintf(out.file, "x_m,y_m,z_m,radius_m%s%s\n", bed->material != NULL ? ",material" : "",
                  bed->clump != NULL ? ",clump" : "");
    for (size_t i = 0; i < bed->grains; i++) {
        (void)fprintf(out.file, "%.17g,%.17g,%.17g,%.17g", bed->x_m[i], bed->y_m[i], bed->z_m[i],
                      bed->radius_m[i]);
        if (bed->material != NULL) {
            (void)fprintf(out.file, ",%u", (unsigned)bed->material[i]);
        }
        if (bed->clump != NULL) {
            (void)fprintf(out.file, ",%lu", (unsigned long)bed->clump[i]);
        }
        (void)fputc('\n', out.file);
    }
    dig_c_locale_leave(&locale);
    return dig_out_commit(&out, error);
}
