#include "closed_loop/machine/machine_lines.h"

#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// A payload of one segment beside the common one: this share of the common one's scale.
static const double own_share = 0.5;

// A common payload of so much tells where it lies.
static const double telling_kg = 5.0;

// Step of the differences, in scales.
static const double step = 0.05;

// Of all campaigns' first digs most were clean, and those that were not are told by their own.
static bool is_carrying(const struct dig_air_segment *const segment)
{
    return segment->dig > 0 || segment->after;
}

void dig_lines_carry(const double own_kg, const struct dig_added_mass *const common,
                     struct dig_added_mass *const payload)
{
    const double share = own_kg / (telling_kg + fmax(common->mass_kg, 0.0));
    payload->moment_kgm.x += share * common->moment_kgm.x;
    payload->moment_kgm.y += share * common->moment_kgm.y;
    payload->mass_kg += own_kg;
}

static void list_columns(struct dig_lines *const lines, const double file_scale[])
{
    size_t n = 0;
    for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
        const struct dig_effect *const effect = dig_effect_of((enum dig_effect_id)e);
        for (size_t p = 0; p < effect->parameters; p++) {
            lines->column[n++] =
                (struct dig_lines_column){ effect->id, p, -1, effect->parameter[p].scale };
        }
    }
    const double scale = own_share * dig_effect_of(DIG_EFFECT_PAYLOAD)->parameter[0].scale;
    for (size_t s = 0; s < lines->air->segments; s++) {
        lines->column[n++] = (struct dig_lines_column){ DIG_EFFECT_PAYLOAD, 0, (int)s, scale };
    }
    for (size_t p = 0; file_scale != NULL && p < DIG_FILE_ERRORS; p++) {
        lines->column[n++] = (struct dig_lines_column){ DIG_EFFECT_UNLISTED, p, -1, file_scale[p] };
    }
    lines->columns = n;
}

static size_t most_columns(const struct dig_air *const air)
{
    return (size_t)DIG_MACHINE_EFFECTS * DIG_MODEL_PARAMETERS_MAX + air->segments + DIG_FILE_ERRORS;
}

static void number_digs(struct dig_lines *const lines)
{
    lines->digs = 0;
    for (size_t s = 0; s < lines->air->segments; s++) {
        const bool same = s > 0 && lines->air->segment[s].dig == lines->air->segment[s - 1].dig;
        lines->digs += same ? 0 : 1;
        lines->dig[s] = lines->digs - 1;
    }
}

static enum dig_status make(struct dig_air *const air, const double file_scale[],
                            struct dig_lines *const lines)
{
    const size_t     most = most_columns(air);
    struct dig_lines made = {
        .air    = air,
        .column = malloc(most * sizeof *made.column),
        .at     = calloc(most, sizeof *made.at),
        .dig    = malloc((air->segments + 1) * sizeof *made.dig),
        .normal = calloc(air->segments + 1, sizeof *made.normal),
        .trust  = malloc((air->rows + 1) * sizeof *made.trust),
    };
    bool ok = made.column != NULL && made.at != NULL && made.dig != NULL && made.normal != NULL &&
              made.trust != NULL;
    for (size_t r = 0; ok && r < air->rows; r++) {
        made.trust[r] = 1.0;
    }
    if (ok) {
        list_columns(&made, file_scale);
        number_digs(&made);
    }
    for (size_t d = 0; ok && d < made.digs; d++) {
        made.normal[d].slope_rest = malloc(made.columns * sizeof(double));
        made.normal[d].slope2     = malloc(made.columns * made.columns * sizeof(double));
        ok = made.normal[d].slope_rest != NULL && made.normal[d].slope2 != NULL;
    }
    if (!ok) {
        dig_lines_finish(&made);
        return DIG_ENOMEM;
    }
    *lines = made;
    return DIG_OK;
}

enum dig_status dig_lines_make(struct dig_air *const air, struct dig_lines *const lines)
{
    assert(air != NULL && lines != NULL);
    return make(air, NULL, lines);
}

enum dig_status dig_lines_make_with_file(struct dig_air *const   air,
                                         const double            scale[DIG_FILE_ERRORS],
                                         struct dig_lines *const lines)
{
    assert(air != NULL && scale != NULL && lines != NULL);
    return make(air, scale, lines);
}

void dig_lines_finish(struct dig_lines *const lines)
{
    if (lines == NULL) {
        return;
    }
    for (size_t d = 0; d < lines->digs; d++) {
        free(lines->normal[d].slope_rest);
        free(lines->normal[d].slope2);
    }
    free(lines->column);
    free(lines->at);
    free(lines->dig);
    free(lines->normal);
    free(lines->trust);
    *lines = (struct dig_lines){ .columns = 0 };
}

bool dig_lines_is_bent(const struct dig_lines *const lines, const size_t column)
{
    const struct dig_lines_column *const c     = &lines->column[column];
    const struct dig_effect *const       known = dig_effect_of(c->effect);
    return known != NULL && known->parameter[c->parameter].bent; // a file error is no effect
}

void dig_lines_correct(const struct dig_lines *const lines, const double at[],
                       struct dig_correction correction[])
{
    assert(lines != NULL && at != NULL && correction != NULL);
    double value[DIG_MACHINE_EFFECTS][DIG_MODEL_PARAMETERS_MAX];
    double file[DIG_FILE_ERRORS] = { 0.0 };
    for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
        dig_effect_absent(dig_effect_of((enum dig_effect_id)e), value[e]);
    }
    for (size_t c = 0; c < lines->columns; c++) {
        const struct dig_lines_column *const column = &lines->column[c];
        if (column->effect == DIG_EFFECT_UNLISTED) {
            file[column->parameter] = column->scale * at[c];
        } else if (column->segment < 0) {
            value[column->effect][column->parameter] += column->scale * at[c];
        }
    }
    memcpy(&lines->air->file, file, sizeof file);
    for (size_t s = 0; s < lines->air->segments; s++) {
        correction[s] = (struct dig_correction){ .delay_s = 0.0 };
        for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
            if (e != DIG_EFFECT_PAYLOAD || is_carrying(&lines->air->segment[s])) {
                dig_effect_of((enum dig_effect_id)e)->correct(value[e], &correction[s]);
            }
        }
    }
    struct dig_correction common = { .delay_s = 0.0 };
    dig_effect_of(DIG_EFFECT_PAYLOAD)->correct(value[DIG_EFFECT_PAYLOAD], &common);
    for (size_t c = 0; c < lines->columns; c++) {
        if (lines->column[c].segment >= 0) {
            dig_lines_carry(lines->column[c].scale * at[c], &common.payload,
                            &correction[lines->column[c].segment].payload);
        }
    }
}

// How every row changes with some columns at once, by a central difference.
static void slope_of(const struct dig_lines *const lines, const size_t columns,
                     const size_t column[], double *const at, struct dig_correction correction[],
                     double *const less, double *const slope)
{
    for (int way = -1; way <= 1; way += 2) {
        for (size_t c = 0; c < columns; c++) {
            at[column[c]] += way < 0 ? -step : 2.0 * step;
        }
        dig_lines_correct(lines, at, correction);
        dig_air_rest(lines->air, correction, true, way < 0 ? less : slope);
    }
    for (size_t c = 0; c < columns; c++) {
        at[column[c]] -= step;
    }
    for (size_t r = 0; r < lines->air->rows; r++) {
        slope[r] = (slope[r] - less[r]) / (2.0 * step);
    }
}

// All slopes. A segment has one column of its own at most, so that all of these are moved at once
// and each takes its segment's rows.
static void fill_slopes(const struct dig_lines *const lines, const unsigned set, double *const at,
                        struct dig_correction correction[], double *const less, double *const all,
                        size_t own[], double *const slope)
{
    const size_t rows = lines->air->rows;
    size_t       owns = 0;
    memset(slope, 0, lines->columns * rows * sizeof *slope);
    for (size_t c = 0; c < lines->columns; c++) {
        if (((set >> lines->column[c].effect) & 1U) == 0) {
            continue;
        }
        if (lines->column[c].segment >= 0) {
            own[owns++] = c;
        } else {
            slope_of(lines, 1, &c, at, correction, less, &slope[c * rows]);
        }
    }
    if (owns > 0) {
        slope_of(lines, owns, own, at, correction, less, all);
    }
    for (size_t i = 0; i < owns; i++) {
        const struct dig_air_segment *const s = &lines->air->segment[lines->column[own[i]].segment];
        memcpy(&slope[own[i] * rows + s->first_row], &all[s->first_row], s->rows * sizeof *slope);
    }
}

static void sum_up(const struct dig_lines *const lines, double rest[], double slope[])
{
    for (size_t r = 0; r < lines->air->rows; r++) {
        rest[r] *= lines->trust[r];
        for (size_t c = 0; c < lines->columns; c++) {
            slope[c * lines->air->rows + r] *= lines->trust[r];
        }
    }

    const size_t n    = lines->columns;
    const size_t rows = lines->air->rows;
    for (size_t d = 0; d < lines->digs; d++) {
        struct dig_lines_normal *const normal = &lines->normal[d];
        normal->rows                          = 0;
        normal->rest2                         = 0.0;
        memset(normal->slope_rest, 0, n * sizeof(double));
        memset(normal->slope2, 0, n * n * sizeof(double));
    }
    for (size_t s = 0; s < lines->air->segments; s++) {
        struct dig_lines_normal *const      normal  = &lines->normal[lines->dig[s]];
        const struct dig_air_segment *const segment = &lines->air->segment[s];
        const size_t                        from    = segment->first_row;
        const size_t                        to      = from + segment->rows;
        normal->rows += segment->rows;
        for (size_t r = from; r < to; r++) {
            normal->rest2 += rest[r] * rest[r];
        }
        for (size_t a = 0; a < n; a++) {
            const double *const left = &slope[a * rows];
            for (size_t r = from; r < to; r++) {
                normal->slope_rest[a] += left[r] * rest[r];
            }
            for (size_t b = 0; b <= a; b++) {
                const double *const right = &slope[b * rows];
                double              sum   = 0.0;
                for (size_t r = from; r < to; r++) {
                    sum += left[r] * right[r];
                }
                normal->slope2[a * n + b] += sum;
            }
        }
    }
    for (size_t d = 0; d < lines->digs; d++) {
        for (size_t a = 0; a < n; a++) {
            for (size_t b = 0; b < a; b++) {
                lines->normal[d].slope2[b * n + a] = lines->normal[d].slope2[a * n + b];
            }
        }
    }
}

enum dig_status dig_lines_update(struct dig_lines *const lines, const unsigned set)
{
    assert(lines != NULL);
    const size_t                 rows = lines->air->rows + 1;
    struct dig_correction *const correction =
        malloc((lines->air->segments + 1) * sizeof *correction);
    double *const   rest   = malloc(3 * rows * sizeof *rest);
    double *const   slope  = malloc(lines->columns * rows * sizeof *slope);
    size_t *const   own    = malloc((lines->air->segments + 1) * sizeof *own);
    enum dig_status status = DIG_ENOMEM;
    if (correction != NULL && rest != NULL && slope != NULL && own != NULL) {
        dig_lines_correct(lines, lines->at, correction);
        dig_air_calm(lines->air, correction);
        fill_slopes(lines, set, lines->at, correction, rest + rows, rest + 2 * rows, own, slope);
        dig_lines_correct(lines, lines->at, correction);
        dig_air_rest(lines->air, correction, false, rest);
        sum_up(lines, rest, slope);
        status = DIG_OK;
    }
    free(correction);
    free(rest);
    free(slope);
    free(own);
    return status;
}

enum dig_status dig_lines_rest(const struct dig_lines *const lines, const double at[],
                               double rest[])
{
    assert(lines != NULL && at != NULL && rest != NULL);
    struct dig_correction *const correction =
        malloc((lines->air->segments + 1) * sizeof *correction);
    if (correction == NULL) {
        return DIG_ENOMEM;
    }
    dig_lines_correct(lines, at, correction);
    dig_air_rest(lines->air, correction, false, rest);
    free(correction);
    return DIG_OK;
}

double dig_lines_rest2(const struct dig_lines *const lines, const double at[])
{
    assert(lines != NULL && at != NULL);
    double *const rest  = malloc((lines->air->rows + 1) * sizeof *rest);
    double        rest2 = INFINITY;
    if (rest != NULL && dig_lines_rest(lines, at, rest) == DIG_OK) {
        rest2 = 0.0;
        for (size_t r = 0; r < lines->air->rows; r++) {
            rest2 += pow(lines->trust[r] * rest[r], 2.0);
        }
    }
    free(rest);
    return rest2;
}

// Adds what may be wrong with the form of what an effect explains of every row, in its sigmas: rows
// of a joint follow each other every DIG_JOINTS rows at most.
static void add_form(const struct dig_air *const air, const enum dig_effect_id effect,
                     const double explained[], double wrong[])
{
    const struct dig_effect *const known = dig_effect_of(effect);
    for (size_t r = 0; r < air->rows; r++) {
        const double here = fabs(explained[r]);
        double       most = here;
        for (size_t back = 1; back <= DIG_JOINTS; back++) {
            if (back <= r && air->row[r - back].joint == air->row[r].joint &&
                air->row[r - back].segment == air->row[r].segment) {
                most = fmax(most, fabs(explained[r - back]));
            }
            if (r + back < air->rows && air->row[r + back].joint == air->row[r].joint &&
                air->row[r + back].segment == air->row[r].segment) {
                most = fmax(most, fabs(explained[r + back]));
            }
        }
        wrong[r] += known->wrong_share * here + known->wrong_step * (most - here);
    }
}

// Chi-squared of sums over one segment and joint each: what is slow shows here best.
static double slow_rest2(const struct dig_lines *const lines, const double rest[],
                         const double wrong[])
{
    double sum = 0.0;
    for (size_t s = 0; s < lines->air->segments; s++) {
        const struct dig_air_segment *const segment = &lines->air->segment[s];

        double of[DIG_JOINTS]    = { 0.0 };
        double off[DIG_JOINTS]   = { 0.0 };
        double count[DIG_JOINTS] = { 0.0 };
        for (size_t r = segment->first_row; r < segment->first_row + segment->rows; r++) {
            const enum dig_joint j = lines->air->row[r].joint;
            of[j] += rest[r];
            off[j] += wrong[r];
            count[j] += 1.0;
        }
        for (int j = 0; j < DIG_JOINTS; j++) {
            sum += count[j] > 0.0 ? of[j] * of[j] / (count[j] + off[j] * off[j]) : 0.0;
        }
    }
    return sum;
}

// The values without those of one effect; false when it has none.
static bool leave_out(const struct dig_lines *const lines, const enum dig_effect_id effect,
                      double at[])
{
    bool any = false;
    for (size_t c = 0; c < lines->columns; c++) {
        const bool mine = lines->column[c].effect == effect;
        any             = any || (mine && fabs(lines->at[c]) > 0.0);
        at[c]           = mine ? 0.0 : lines->at[c];
    }
    return any;
}

enum dig_status dig_lines_judge(struct dig_lines *const lines, double *const slow)
{
    assert(lines != NULL && slow != NULL);
    const size_t                 rows = lines->air->rows + 1;
    struct dig_correction *const correction =
        malloc((lines->air->segments + 1) * sizeof *correction);
    double *const at   = malloc((lines->columns + 1) * sizeof *at);
    double *const rest = calloc(3 * rows, sizeof *rest);
    if (correction == NULL || at == NULL || rest == NULL) {
        free(correction);
        free(at);
        free(rest);
        return DIG_ENOMEM;
    }
    double *const explained = rest + rows;
    double *const wrong     = rest + 2 * rows;
    dig_lines_correct(lines, lines->at, correction);
    dig_air_rest(lines->air, correction, false, rest);
    for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
        const enum dig_effect_id effect = (enum dig_effect_id)e;
        if (leave_out(lines, effect, at)) {
            dig_lines_correct(lines, at, correction);
            dig_air_rest(lines->air, correction, false, explained);
            for (size_t r = 0; r < lines->air->rows; r++) {
                explained[r] -= rest[r];
            }
            add_form(lines->air, effect, explained, wrong);
        }
    }
    dig_lines_correct(lines, lines->at, correction);
    dig_air_held(lines->air, correction, explained);
    for (size_t r = 0; r < lines->air->rows; r++) {
        wrong[r] += explained[r];
    }
    for (size_t r = 0; r < lines->air->rows; r++) {
        lines->trust[r] = 1.0 / hypot(1.0, wrong[r]);
    }
    *slow = slow_rest2(lines, rest, wrong);
    free(correction);
    free(at);
    free(rest);
    return DIG_OK;
}
