#include "files/curves_csv.h"

#include "core/name.h"
#include "core/text.h"
#include "core/units.h"
#include "files/text/csv.h"
#include "files/text/whole.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct reader {
    const char                 *path;
    const struct dig_curve_map *map;
    struct dig_error           *error;
    struct dig_csv              csv;
    size_t                      at[DIG_MAP_FIELDS];    // column of each field the map names
    double                      fixed[DIG_MAP_FIELDS]; // of the others; NaN where it is not there
};

static bool is_column(const struct reader *const r, const enum dig_map_field f)
{
    return r->map->field[f].column[0] != '\0';
}

static const char *name_of(const struct reader *const r, const enum dig_map_field f)
{
    return is_column(r, f) ? r->map->field[f].column : dig_map_name(f);
}

// As it stands in the file; NaN where there is none.
static double found(const struct reader *const r, const size_t row, const enum dig_map_field f)
{
    return is_column(r, f) ? r->csv.value[row * r->csv.columns + r->at[f]] : r->fixed[f];
}

// Carried mass that is not there is not known; packing, depth and attack are 0.
static double number(const struct reader *const r, const size_t row, const enum dig_map_field f)
{
    const double value = found(r, row, f);
    return isnan(value) && f != DIG_MAP_CARRIED_kg ? 0.0 : value * r->map->field[f].factor;
}

static void require(struct dig_conditions *const c, const bool holds, const struct reader *const r,
                    const size_t row, const enum dig_map_field f, const char *const expected)
{
    dig_require(c, holds, "%s:%d: column %s: %g, expected %s", r->path, r->csv.line[row],
                name_of(r, f), found(r, row, f), expected);
}

// The dig a sample belongs to, without its rows. A depth that is not there is 0, which counts as 1;
// one that is given must be one.
static enum dig_status read_dig(const struct reader *const r, const size_t row,
                                struct dig_foreign_dig *const dig)
{
    struct dig_conditions c          = { .error = r->error };
    const char *const     name       = is_column(r, DIG_MAP_TRAJECTORY)
                                           ? r->csv.word[row]
                                           : r->map->field[DIG_MAP_TRAJECTORY].value;
    const double          depth      = number(r, row, DIG_MAP_DEPTH);
    const double          attack_deg = number(r, row, DIG_MAP_ATTACK_deg);
    const double          packing    = number(r, row, DIG_MAP_PACKING);
    require(&c,
            isnan(found(r, row, DIG_MAP_DEPTH)) ||
                (depth >= DIG_APPROACH_DEPTH_LEAST && depth <= DIG_APPROACH_DEPTH_MOST),
            r, row, DIG_MAP_DEPTH, "a factor of 0.2 to 3");
    require(&c, fabs(attack_deg) <= 45.0, r, row, DIG_MAP_ATTACK_deg, "-45 to 45 deg");
    dig_require(&c, dig_name_ok(name) && strlen(name) < DIG_NAME_SIZE,
                "%s:%d: column %s: \"%.40s\", expected " DIG_NAME_RULE ", at most 31 characters",
                r->path, r->csv.line[row], name_of(r, DIG_MAP_TRAJECTORY), name);
    require(&c, packing >= 0.0 && packing <= 1e6 && !(packing > floor(packing)), r, row,
            DIG_MAP_PACKING, "a whole number from 0");
    if (c.status != DIG_OK) {
        return c.status;
    }
    *dig = (struct dig_foreign_dig){
        .gravel   = { { number(r, row, DIG_MAP_FRICTION), number(r, row, DIG_MAP_ROLLING),
                        number(r, row, DIG_MAP_DENSITY_kgpm3) } },
        .approach = { depth, attack_deg * DIG_RAD_PER_DEG },
        .packing  = (size_t)packing,
        .line     = (size_t)r->csv.line[row],
    };
    memcpy(dig->trajectory, name, strlen(name) + 1);
    return DIG_OK;
}

static struct dig_force_row read_row(const struct reader *const r, const size_t row)
{
    return (struct dig_force_row){ .t_s        = number(r, row, DIG_MAP_T_s),
                                   .Fx_N       = number(r, row, DIG_MAP_FX_N),
                                   .Fz_N       = number(r, row, DIG_MAP_FZ_N),
                                   .My_Nm      = number(r, row, DIG_MAP_MY_Nm),
                                   .carried_kg = number(r, row, DIG_MAP_CARRIED_kg) };
}

static bool is_same_dig(const struct dig_foreign_dig *const a,
                        const struct dig_foreign_dig *const b)
{
    return a->packing == b->packing && strcmp(a->trajectory, b->trajectory) == 0 &&
           dig_approach_is_same(&a->approach, &b->approach) &&
           dig_gravel_is_same(&a->gravel, &b->gravel);
}

// Of two samples of one dig.
static enum dig_status check_ascends(const struct reader *const r, const size_t row)
{
    const double was_s = number(r, row - 1, DIG_MAP_T_s);
    const double t_s   = number(r, row, DIG_MAP_T_s);
    return t_s > was_s
               ? DIG_OK
               : dig_error_set(r->error, DIG_EINVAL,
                               "%s:%d: column %s: %.9g after %.9g in one dig, expected ascending "
                               "time, or another packing where another dig begins",
                               r->path, r->csv.line[row], r->map->field[DIG_MAP_T_s].column, t_s,
                               was_s);
}

// Visits the dig of the rows from *begin on, which becomes the first row behind it.
static enum dig_status visit_dig(const struct reader *const r, size_t *const begin,
                                 const struct dig_foreign_visitor *const visitor)
{
    struct dig_foreign_dig dig    = { .line = 0 };
    struct dig_foreign_dig next   = { .line = 0 };
    enum dig_status        status = read_dig(r, *begin, &dig);
    size_t                 end    = *begin + 1;
    for (; status == DIG_OK && end < r->csv.rows; end++) {
        status = read_dig(r, end, &next);
        if (status == DIG_OK && !is_same_dig(&dig, &next)) {
            break;
        }
        status = status == DIG_OK ? check_ascends(r, end) : status;
    }
    if (status != DIG_OK) {
        return status;
    }
    const size_t                rows = end - *begin;
    struct dig_force_row *const kept = malloc(rows * sizeof *kept);
    if (kept == NULL) {
        return dig_error_set(r->error, DIG_ENOMEM, "%s: no memory for %zu rows", r->path, rows);
    }
    for (size_t i = 0; i < rows; i++) {
        kept[i] = read_row(r, *begin + i);
    }
    dig.recording = (struct dig_recording){ .rows = rows, .row = kept };
    *begin        = end;
    status        = visitor->visit(visitor->context, &dig, r->error);
    free(kept);
    return status;
}

// The columns the map names, and the values it has instead.
static enum dig_status read_columns(struct reader *const r)
{
    struct dig_csv_column column[DIG_MAP_FIELDS];
    size_t                columns = 0;
    for (int i = 0; i < DIG_MAP_FIELDS; i++) {
        const enum dig_map_field           f  = (enum dig_map_field)i;
        const struct dig_map_column *const of = &r->map->field[f];
        r->fixed[f]                           = NAN;
        if (is_column(r, f)) {
            r->at[f]          = columns;
            column[columns++] = (struct dig_csv_column){ .name      = of->column,
                                                         .may_empty = f >= DIG_MAP_NEEDED,
                                                         .text      = f == DIG_MAP_TRAJECTORY };
        } else if (of->value[0] != '\0' && f != DIG_MAP_TRAJECTORY &&
                   !dig_text_number(of->value, &r->fixed[f])) {
            return dig_error_set(r->error, DIG_EINVAL,
                                 "%s: the map's value of %s: \"%.40s\", expected a finite number",
                                 r->path, dig_map_name(f), of->value);
        }
    }
    return dig_csv_read(r->path, DIG_CSV_SKIP_OTHERS, columns, column, &r->csv, r->error);
}

enum dig_status dig_curves_read(const char *const path, const struct dig_curve_map *const map,
                                const struct dig_foreign_visitor *const visitor,
                                struct dig_error *const                 error)
{
    assert(path != NULL && map != NULL && visitor != NULL);
    struct reader       r      = { .path = path, .map = map, .error = error };
    struct dig_c_locale locale = dig_c_locale_enter();
    enum dig_status     status = read_columns(&r);
    for (size_t row = 0; status == DIG_OK && row < r.csv.rows;) {
        status = visit_dig(&r, &row, visitor);
    }
    dig_csv_finish(&r.csv);
    dig_c_locale_leave(&locale);
    return status;
}
