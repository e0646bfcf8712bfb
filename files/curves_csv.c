#include "files/curves_csv.h"

#include "core/name.h"
#include "core/units.h"
#include "files/text/csv.h"
#include "files/text/whole.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FIELDS_MAX 256 // of a line

struct reader {
    const char                       *path;
    const struct dig_curve_map       *map;
    const struct dig_foreign_visitor *visitor;
    struct dig_error                 *error;
    size_t                            line;
    size_t                            fields;             // in the header
    size_t                            at[DIG_MAP_FIELDS]; // header field of each column
    struct dig_foreign_dig            dig;                // under way
    size_t                            room;               // its rows allocated
};

// One sample, and the dig it belongs to.
struct sample {
    struct dig_foreign_dig of; // without rows
    struct dig_force_row   row;
};

// Cuts a line into fields; how many there are.
static size_t split(char *rest, char *field[const FIELDS_MAX])
{
    size_t n = 0;
    while (n < FIELDS_MAX && (field[n] = dig_csv_field(&rest)) != NULL) {
        n++;
    }
    return n;
}

static enum dig_status read_header(struct reader *const r, char *const line)
{
    char *field[FIELDS_MAX];
    r->fields = split(line, field);
    for (int f = 0; f < DIG_MAP_FIELDS; f++) {
        const char *const name = r->map->field[f].column;
        r->at[f]               = 0;
        while (name[0] != '\0' && r->at[f] < r->fields && strcmp(field[r->at[f]], name) != 0) {
            r->at[f]++;
        }
        if (r->at[f] >= r->fields) {
            return dig_error_set(r->error, DIG_EINVAL,
                                 "%s:%zu: column %s: missing, expected it for %s as the map says",
                                 r->path, r->line, name, dig_map_name((enum dig_map_field)f));
        }
    }
    return DIG_OK;
}

static const char *text_of(const struct reader *const r, char *const field[const],
                           const enum dig_map_field f)
{
    const struct dig_map_column *const c = &r->map->field[f];
    return c->column[0] != '\0' ? field[r->at[f]] : c->value;
}

static enum dig_status refuse_field(const struct reader *const r, const enum dig_map_field f,
                                    const char *const found, const char *const expected)
{
    const char *const name = r->map->field[f].column;
    return dig_error_set(r->error, DIG_EINVAL, "%s:%zu: column %s: \"%.40s\", expected %s", r->path,
                         r->line, name[0] != '\0' ? name : dig_map_name(f), found, expected);
}

// Carried mass that is not there is not known; packing, depth and attack are 0.
static enum dig_status number_of(const struct reader *const r, char *const field[const],
                                 const enum dig_map_field f, double *const value)
{
    const char *const text = text_of(r, field, f);
    if (text[0] == '\0' && f >= DIG_MAP_NEEDED) {
        *value = f == DIG_MAP_CARRIED_kg ? (double)NAN : 0.0;
        return DIG_OK;
    }
    char        *end    = NULL;
    const double number = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(number)) {
        return refuse_field(r, f, text, "a finite number");
    }
    *value = number * r->map->field[f].factor;
    return DIG_OK;
}

// A depth that is not there is 0, which counts as 1; one that is given must be one.
static enum dig_status approach_of(const struct reader *const r, char *const field[const],
                                   const double               number[const DIG_MAP_FIELDS],
                                   struct dig_approach *const approach)
{
    const double      depth      = number[DIG_MAP_DEPTH];
    const double      attack_deg = number[DIG_MAP_ATTACK_deg];
    const char *const given      = text_of(r, field, DIG_MAP_DEPTH);
    if (given[0] != '\0' &&
        !(depth >= DIG_APPROACH_DEPTH_LEAST && depth <= DIG_APPROACH_DEPTH_MOST)) {
        return refuse_field(r, DIG_MAP_DEPTH, given, "a factor of 0.2 to 3");
    }
    if (!(fabs(attack_deg) <= 45.0)) {
        return refuse_field(r, DIG_MAP_ATTACK_deg, text_of(r, field, DIG_MAP_ATTACK_deg),
                            "-45 to 45 deg");
    }
    *approach = (struct dig_approach){ depth, attack_deg * DIG_RAD_PER_DEG };
    return DIG_OK;
}

static enum dig_status read_sample(const struct reader *const r, char *const line,
                                   struct sample *const sample)
{
    char *field[FIELDS_MAX];
    if (split(line, field) != r->fields) {
        return dig_error_set(r->error, DIG_EINVAL, "%s:%zu: expected %zu fields as in the header",
                             r->path, r->line, r->fields);
    }
    double          number[DIG_MAP_FIELDS] = { 0.0 };
    enum dig_status status                 = DIG_OK;
    for (int f = 0; status == DIG_OK && f < DIG_MAP_FIELDS; f++) {
        if (f != DIG_MAP_TRAJECTORY) {
            status = number_of(r, field, (enum dig_map_field)f, &number[f]);
        }
    }
    if (status != DIG_OK) {
        return status;
    }
    struct dig_approach approach;
    status = approach_of(r, field, number, &approach);
    if (status != DIG_OK) {
        return status;
    }
    const char *const name    = text_of(r, field, DIG_MAP_TRAJECTORY);
    const double      packing = number[DIG_MAP_PACKING];
    if (!dig_name_ok(name) || strlen(name) >= DIG_NAME_SIZE) {
        return refuse_field(r, DIG_MAP_TRAJECTORY, name, DIG_NAME_RULE ", at most 31 characters");
    }
    if (!(packing >= 0.0 && packing <= 1e6) || packing > floor(packing)) {
        return refuse_field(r, DIG_MAP_PACKING, text_of(r, field, DIG_MAP_PACKING),
                            "a whole number from 0");
    }
    *sample = (struct sample){
        .of  = { .gravel   = { { number[DIG_MAP_FRICTION], number[DIG_MAP_ROLLING],
                                 number[DIG_MAP_DENSITY_kgpm3] } },
                 .approach = approach,
                 .packing  = (size_t)packing,
                 .line     = r->line },
        .row = { .t_s        = number[DIG_MAP_T_s],
                 .Fx_N       = number[DIG_MAP_FX_N],
                 .Fz_N       = number[DIG_MAP_FZ_N],
                 .My_Nm      = number[DIG_MAP_MY_Nm],
                 .carried_kg = number[DIG_MAP_CARRIED_kg] },
    };
    memcpy(sample->of.trajectory, name, strlen(name) + 1);
    return DIG_OK;
}

static bool is_same_dig(const struct dig_foreign_dig *const a,
                        const struct dig_foreign_dig *const b)
{
    return a->packing == b->packing && strcmp(a->trajectory, b->trajectory) == 0 &&
           dig_approach_is_same(&a->approach, &b->approach) &&
           dig_gravel_is_same(&a->gravel, &b->gravel);
}

static enum dig_status end_dig(struct reader *const r)
{
    if (r->dig.recording.rows == 0) {
        return DIG_OK;
    }
    const enum dig_status status = r->visitor->visit(r->visitor->context, &r->dig, r->error);
    r->dig.recording.rows        = 0;
    return status;
}

static enum dig_status take_sample(struct reader *const r, const struct sample *const sample)
{
    struct dig_recording *const recording = &r->dig.recording;
    if (recording->rows > 0 && !is_same_dig(&r->dig, &sample->of)) {
        const enum dig_status status = end_dig(r);
        if (status != DIG_OK) {
            return status;
        }
    }
    if (recording->rows == 0) {
        struct dig_force_row *const kept = recording->row;
        r->dig                           = sample->of;
        r->dig.recording                 = (struct dig_recording){ .row = kept };
    }
    if (recording->rows == r->room) {
        const size_t                room = r->room * 2 + 1024;
        struct dig_force_row *const more = realloc(recording->row, room * sizeof *more);
        if (more == NULL) {
            return dig_error_set(r->error, DIG_ENOMEM, "%s: no memory for %zu rows", r->path, room);
        }
        recording->row = more;
        r->room        = room;
    }
    recording->row[recording->rows++] = sample->row;
    return DIG_OK;
}

// The header, every line, and the last dig.
static enum dig_status read_lines(struct reader *const r, char *text)
{
    enum dig_status status  = DIG_OK;
    bool            started = false;
    for (char *line; status == DIG_OK && (line = dig_csv_line(&text)) != NULL;) {
        r->line++;
        if (dig_csv_is_comment_or_blank(line)) {
            continue;
        }
        if (!started) {
            status  = read_header(r, line);
            started = true;
            continue;
        }
        struct sample sample = { .of = { .packing = 0 } };
        status               = read_sample(r, line, &sample);
        if (status == DIG_OK) {
            status = take_sample(r, &sample);
        }
    }
    if (status == DIG_OK && r->dig.recording.rows == 0) {
        return dig_error_set(r->error, DIG_EINVAL, "%s:%zu: no samples, expected at least one dig",
                             r->path, r->line > 0 ? r->line : 1);
    }
    return status == DIG_OK ? end_dig(r) : status;
}

enum dig_status dig_curves_read(const char *const path, const struct dig_curve_map *const map,
                                const struct dig_foreign_visitor *const visitor,
                                struct dig_error *const                 error)
{
    assert(path != NULL && map != NULL && visitor != NULL);
    char           *text   = NULL;
    size_t          size   = 0;
    enum dig_status status = dig_file_read(path, &text, &size, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_c_locale locale = dig_c_locale_enter();
    struct reader       r      = { .path = path, .map = map, .visitor = visitor, .error = error };
    status                     = read_lines(&r, text);
    dig_recording_finish(&r.dig.recording);
    dig_c_locale_leave(&locale);
    free(text);
    return status;
}
