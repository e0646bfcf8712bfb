#include "closed_loop/machine/machine_fit.h"

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

void dig_lines_carry(const double common[], const bool carries, const double own_kg,
                     struct dig_added_mass *const payload)
{
    struct dig_correction all = { .delay_s = 0.0 };
    dig_effect_of(DIG_EFFECT_PAYLOAD)->correct(common, &all);
    const double share = own_kg / (telling_kg + fmax(all.payload.mass_kg, 0.0));
    *payload           = carries ? all.payload : (struct dig_added_mass){ .mass_kg = 0.0 };
    payload->moment_kgm.x += share * all.payload.moment_kgm.x;
    payload->moment_kgm.y += share * all.payload.moment_kgm.y;
    payload->mass_kg += own_kg;
}

static void add_column(struct dig_lines *const lines, const enum dig_effect_id effect,
                       const size_t parameter, const int segment, const double scale)
{
    lines->column[lines->columns++] =
        (struct dig_lines_column){ effect, parameter, segment, scale };
}

static void list_columns(struct dig_lines *const lines, const double file_scale[])
{
    for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
        const struct dig_effect *const effect = dig_effect_of((enum dig_effect_id)e);
        for (size_t p = 0; p < effect->parameters; p++) {
            add_column(lines, effect->id, p, -1, effect->parameter[p].scale);
        }
    }
    const double scale = own_share * dig_effect_of(DIG_EFFECT_PAYLOAD)->parameter[0].scale;
    for (size_t s = 0; s < lines->air->segments; s++) {
        add_column(lines, DIG_EFFECT_PAYLOAD, 0, (int)s, scale);
    }
    for (size_t p = 0; p < DIG_FILE_ERRORS; p++) {
        if (file_scale[p] > 0.0) {
            add_column(lines, DIG_EFFECT_UNLISTED, p, -1, file_scale[p]);
        }
    }
}

static void number_digs(struct dig_lines *const lines)
{
    for (size_t s = 0; s < lines->air->segments; s++) {
        const bool same = s > 0 && lines->air->segment[s].dig == lines->air->segment[s - 1].dig;
        lines->digs += same ? 0 : 1;
        lines->dig[s] = lines->digs - 1;
    }
}

enum dig_status dig_lines_make(struct dig_air *const air, const double file_scale[DIG_FILE_ERRORS],
                               struct dig_lines *const lines)
{
    assert(air != NULL && air->segments <= DIG_LINES_SEGMENTS_MAX && lines != NULL);
    *lines = (struct dig_lines){ .air = air };
    list_columns(lines, file_scale);
    number_digs(lines);
    const size_t n    = lines->columns;
    const size_t one  = n * n + n;
    const size_t rows = air->rows + 1;
    lines->normals    = malloc((lines->digs * one + n * n + (6 + 3 * n) * rows) * sizeof(double));
    lines->correction = malloc((air->segments + 1) * sizeof *lines->correction);
    lines->joint_row  = malloc(rows * sizeof *lines->joint_row);
    if (lines->normals == NULL || lines->correction == NULL || lines->joint_row == NULL) {
        dig_lines_finish(lines);
        return DIG_ENOMEM;
    }
    lines->trust = lines->normals + lines->digs * one;
    lines->work  = lines->trust + rows;
    lines->joint = lines->work + (3 + n) * rows;
    for (size_t d = 0; d < lines->digs; d++) {
        lines->normal[d].slope2     = lines->normals + d * one;
        lines->normal[d].slope_rest = lines->normal[d].slope2 + n * n;
    }
    for (size_t r = 0; r < air->rows; r++) {
        lines->trust[r] = 1.0;
    }
    return DIG_OK;
}

void dig_lines_finish(struct dig_lines *const lines)
{
    if (lines != NULL) {
        free(lines->normals);
        free(lines->correction);
        free(lines->joint_row);
        *lines = (struct dig_lines){ .columns = 0 };
    }
}

size_t dig_lines_first(const struct dig_lines *const lines, const enum dig_effect_id effect)
{
    size_t c = 0;
    while (lines->column[c].effect != effect) {
        c++;
    }
    return c;
}

bool dig_lines_is_bent(const struct dig_lines *const lines, const size_t column)
{
    const struct dig_lines_column *const c     = &lines->column[column];
    const struct dig_effect *const       known = dig_effect_of(c->effect);
    return known != NULL && known->parameter[c->parameter].bent; // a file error is no effect
}

void dig_lines_file(const struct dig_lines *const lines, const double at[],
                    double file[DIG_FILE_ERRORS])
{
    assert(lines != NULL && at != NULL && file != NULL);
    memset(file, 0, DIG_FILE_ERRORS * sizeof file[0]);
    for (size_t c = 0; c < lines->columns; c++) {
        const struct dig_lines_column *const column = &lines->column[c];
        if (column->effect == DIG_EFFECT_UNLISTED) {
            file[column->parameter] = column->scale * at[c];
        }
    }
}

void dig_lines_correct(const struct dig_lines *const lines, const double at[],
                       struct dig_correction correction[])
{
    assert(lines != NULL && at != NULL && correction != NULL);
    double value[DIG_MACHINE_EFFECTS][DIG_MODEL_PARAMETERS_MAX];
    double file[DIG_FILE_ERRORS];
    double own_kg[DIG_LINES_SEGMENTS_MAX];
    for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
        dig_effect_absent(dig_effect_of((enum dig_effect_id)e), value[e]);
    }
    for (size_t c = 0; c < lines->columns; c++) {
        const struct dig_lines_column *const column = &lines->column[c];
        if (column->segment >= 0) {
            own_kg[column->segment] = column->scale * at[c];
        } else if (column->effect != DIG_EFFECT_UNLISTED) {
            value[column->effect][column->parameter] += column->scale * at[c];
        }
    }
    dig_lines_file(lines, at, file);
    for (size_t s = 0; s < lines->air->segments; s++) {
        correction[s] = (struct dig_correction){ .delay_s = 0.0 };
        dig_file_correct(file, &correction[s]);
        for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
            if (e != DIG_EFFECT_PAYLOAD) {
                dig_effect_of((enum dig_effect_id)e)->correct(value[e], &correction[s]);
            }
        }
        dig_lines_carry(value[DIG_EFFECT_PAYLOAD], is_carrying(&lines->air->segment[s]), own_kg[s],
                        &correction[s].payload);
    }
}

// How every row changes with columns [first, first + columns) at once, by a central difference.
static void slope_of(struct dig_lines *const lines, const size_t first, const size_t columns,
                     double less[], double slope[])
{
    for (int way = -1; way <= 1; way += 2) {
        for (size_t c = first; c < first + columns; c++) {
            lines->at[c] += way < 0 ? -step : 2.0 * step;
        }
        dig_lines_correct(lines, lines->at, lines->correction);
        dig_air_rest(lines->air, lines->correction, true, way < 0 ? less : slope);
    }
    for (size_t c = first; c < first + columns; c++) {
        lines->at[c] -= step;
    }
    for (size_t r = 0; r < lines->air->rows; r++) {
        slope[r] = (slope[r] - less[r]) / (2.0 * step);
    }
}

// All slopes. Every segment has one column of its own, in their order, so that all of these are
// moved at once and each takes its segment's rows.
static void fill_slopes(struct dig_lines *const lines, const unsigned set, double less[],
                        double all[], double slope[])
{
    const size_t rows = lines->air->rows;
    size_t       own  = 0;
    size_t       owns = 0;
    memset(slope, 0, lines->columns * rows * sizeof *slope);
    for (size_t c = 0; c < lines->columns; c++) {
        if (((set >> lines->column[c].effect) & 1U) == 0) {
            continue;
        }
        if (lines->column[c].segment >= 0) {
            own = owns++ == 0 ? c : own;
        } else {
            slope_of(lines, c, 1, less, &slope[c * rows]);
        }
    }
    if (owns > 0) {
        slope_of(lines, own, owns, less, all);
    }
    for (size_t i = 0; i < owns; i++) {
        const struct dig_air_segment *const s = &lines->air->segment[i];
        memcpy(&slope[(own + i) * rows + s->first_row], &all[s->first_row],
               s->rows * sizeof *slope);
    }
}

static void sum_up(struct dig_lines *const lines, double rest[], double slope[])
{
    const size_t n    = lines->columns;
    const size_t rows = lines->air->rows;
    for (size_t r = 0; r < rows; r++) {
        rest[r] *= lines->trust[r];
        for (size_t c = 0; c < n; c++) {
            slope[c * rows + r] *= lines->trust[r];
        }
    }
    memset(lines->normals, 0, lines->digs * (n * n + n) * sizeof *lines->normals);
    for (size_t d = 0; d < lines->digs; d++) {
        lines->normal[d].rows  = 0;
        lines->normal[d].rest2 = 0.0;
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
}

void dig_lines_update(struct dig_lines *const lines, const unsigned set)
{
    assert(lines != NULL);
    const size_t  rows  = lines->air->rows;
    double *const rest  = lines->work;
    double *const slope = rest + 3 * rows;
    dig_lines_correct(lines, lines->at, lines->correction);
    dig_air_calm(lines->air, lines->correction);
    fill_slopes(lines, set, rest + rows, rest + 2 * rows, slope);
    dig_lines_rest(lines, lines->at, rest);
    sum_up(lines, rest, slope);
}

const double *dig_lines_slope(const struct dig_lines *const lines, const size_t column)
{
    assert(lines != NULL && column < lines->columns);
    return lines->work + (3 + column) * lines->air->rows;
}

void dig_lines_rest(const struct dig_lines *const lines, const double at[], double rest[])
{
    assert(lines != NULL && at != NULL && rest != NULL);
    dig_lines_correct(lines, at, lines->correction);
    dig_air_rest(lines->air, lines->correction, false, rest);
}

double dig_lines_rest2(const struct dig_lines *const lines, const double at[])
{
    assert(lines != NULL && at != NULL);
    double *const rest  = lines->work;
    double        rest2 = 0.0;
    dig_lines_rest(lines, at, rest);
    for (size_t r = 0; r < lines->air->rows; r++) {
        rest2 += pow(lines->trust[r] * rest[r], 2.0);
    }
    return rest2;
}
