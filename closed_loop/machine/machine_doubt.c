#include "closed_loop/machine/machine_doubt.h"

#include "closed_loop/machine/machine_fit.h"
#include "core/chance.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// What a gain and an offset may grow by with one sigma of what they follow: as an error that stays
// (estimator/effects/pressure_offset.c).
static const double gain_scale      = 0.05;
static const double offset_scale_Pa = 3e5;

// Temperatures closer than this tell nothing.
static const double least_range_degC = 1.0;

// As in machine_fit.c, in scales.
static const double width[] = { 1.0, 0.25, 0.0625, 0.015625 };

// All gains alike, as of one supply or one oil; or every chamber's own and every drive's offset.
// Each as it is on average and as it follows what was recorded.
enum {
    WIDTHS  = sizeof width / sizeof width[0],
    OWN     = 3,
    HALF    = 1 + OWN * DIG_JOINTS,
    COLUMNS = 2 * HALF,
    FORMS   = 2
};

enum follows { FOLLOWS_TEMPERATURE, FOLLOWS_ORDER, FOLLOWS };

static const char *const follows_text[FOLLOWS] = { "the oil's temperature",
                                                   "time, from dig to dig" };

// What was recorded at one row: false where it was not.
static bool state_of(const struct dig_air *const air, const struct dig_air_row *const row,
                     const enum follows what, double *const z)
{
    if (what == FOLLOWS_ORDER) {
        const struct dig_air_segment *const segment = &air->segment[row->segment];
        *z = (double)segment->dig + (segment->after ? 0.5 : 0.0);
        return true;
    }
    *z = 0.0;
    for (size_t p = row->first; p < row->first + row->points; p++) {
        const struct dig_sample *const sample = &air->point[p].sample;
        if (!sample->valid[DIG_SIGNAL_TEMPERATURE_degC]) {
            return false;
        }
        *z += sample->value[DIG_SIGNAL_TEMPERATURE_degC] / (double)row->points;
    }
    return true;
}

// The same of all rows, mean 0 and sigma 1; false where it says nothing.
static bool states(const struct dig_air *const air, const enum follows what, double z[])
{
    double mean  = 0.0;
    double least = INFINITY;
    double most  = -INFINITY;
    for (size_t r = 0; r < air->rows; r++) {
        if (!state_of(air, &air->row[r], what, &z[r])) {
            return false;
        }
        mean += z[r] / (double)air->rows;
        least = fmin(least, z[r]);
        most  = fmax(most, z[r]);
    }
    double square = 0.0;
    for (size_t r = 0; r < air->rows; r++) {
        z[r] -= mean;
        square += z[r] * z[r] / (double)air->rows;
    }
    if (!(most - least >= (what == FOLLOWS_TEMPERATURE ? least_range_degC : 0.5))) {
        return false;
    }
    for (size_t r = 0; r < air->rows; r++) {
        z[r] /= sqrt(square);
    }
    return true;
}

// What one row does with every column at its scale, in the row's sigmas.
static void slopes_of(const struct dig_air *const air, const struct dig_air_row *const row,
                      const double share, double slope[HALF])
{
    const struct dig_cylinder *const cylinder = &air->machine.cylinder[row->joint];
    const double area_m2[DIG_CHAMBERS] = { [DIG_CHAMBER_HEAD] = dig_cylinder_head_m2(cylinder),
                                           [DIG_CHAMBER_ROD]  = -dig_cylinder_rod_m2(cylinder) };
    double       push_N[DIG_CHAMBERS]  = { 0.0 };
    for (size_t p = row->first; p < row->first + row->points; p++) {
        for (size_t c = 0; c < DIG_CHAMBERS; c++) {
            push_N[c] += cylinder->count * area_m2[c] *
                         air->point[p].calm_Pa[DIG_CHAMBERS * (size_t)row->joint + c] /
                         (double)row->points;
        }
    }
    const double unit = share / row->sigma_N;
    memset(slope, 0, HALF * sizeof slope[0]);
    slope[0]          = unit * gain_scale * (push_N[DIG_CHAMBER_HEAD] + push_N[DIG_CHAMBER_ROD]);
    double *const own = &slope[1 + OWN * (size_t)row->joint];
    own[0]            = unit * gain_scale * push_N[DIG_CHAMBER_HEAD];
    own[1]            = unit * gain_scale * push_N[DIG_CHAMBER_ROD];
    own[2]            = unit * offset_scale_Pa * cylinder->count * area_m2[DIG_CHAMBER_HEAD];
}

// The equations of all rows.
static void sum_up(const struct dig_lines *const lines, const double rest[], const double z[],
                   struct dig_fit *const fit)
{
    memset(fit->slope2, 0, (size_t)COLUMNS * COLUMNS * sizeof fit->slope2[0]);
    memset(fit->slope_rest, 0, COLUMNS * sizeof fit->slope_rest[0]);
    for (size_t r = 0; r < lines->air->rows; r++) {
        double slope[COLUMNS];
        slopes_of(lines->air, &lines->air->row[r], lines->trust[r], slope);
        for (size_t a = 0; a < HALF; a++) {
            slope[HALF + a] = z[r] * slope[a];
        }
        for (size_t a = 0; a < COLUMNS; a++) {
            fit->slope_rest[a] += slope[a] * lines->trust[r] * rest[r];
            for (size_t b = 0; b <= a; b++) {
                fit->slope2[a * COLUMNS + b] += slope[a] * slope[b];
            }
        }
    }
}

// The evidence of one form.
static double evidence(const struct dig_fit *const fit, const size_t form, const bool follows,
                       const double share)
{
    double widths[COLUMNS] = { 0.0 };
    for (size_t a = form == 0 ? 0 : 1; a < (form == 0 ? 1 : HALF); a++) {
        widths[a]        = share;
        widths[HALF + a] = follows ? share : 0.0;
    }
    return dig_fit_solve_each(fit, widths, DIG_FIT_NOTHING).log_evidence;
}

struct dig_machine_drift dig_machine_drift_ask(const struct dig_lines *const lines, const double s2)
{
    assert(lines != NULL && s2 > 0.0);
    struct dig_machine_drift drift = { .log_evidence = -INFINITY, .log_lead = -INFINITY };
    double *const            rest  = lines->work;
    double *const            z     = rest + lines->air->rows;
    double                   tried = 0.0;
    double                   slope2[COLUMNS * COLUMNS];
    double                   work[COLUMNS * COLUMNS];
    struct dig_fit fit = { .lines.columns = COLUMNS, .slope2 = slope2, .s2 = s2, .work = work };
    for (size_t c = 0; c < COLUMNS; c++) {
        fit.lines.column[c].effect = DIG_EFFECT_UNLISTED; // none of the list is like these
    }
    dig_lines_rest(lines, lines->absent, rest);
    for (int what = 0; what < FOLLOWS; what++) {
        if (!states(lines->air, (enum follows)what, z)) {
            continue;
        }
        sum_up(lines, rest, z, &fit);
        double stays = 0.0; // the best without what follows
        double found = -INFINITY;
        for (size_t i = 0; i < (size_t)FORMS * WIDTHS; i++) {
            const size_t form  = i / WIDTHS;
            const double share = width[i % WIDTHS];
            stays              = fmax(stays, evidence(&fit, form, false, share));
            found              = fmax(found, evidence(&fit, form, true, share));
            tried += 1.0;
        }
        if (found - stays > drift.log_lead) {
            drift = (struct dig_machine_drift){ found, found - stays, follows_text[what] };
        }
    }
    drift.log_evidence -= log(fmax(tried, 1.0));
    drift.log_lead -= log(fmax(tried, 1.0));
    return drift;
}

// Less of an error than this share of its prior free air does not tell.
static const double least_told = 1e-3;

struct dig_machine_unlike dig_machine_unlike_ask(const struct dig_fit *const fit,
                                                 const double                level)
{
    assert(fit != NULL && level > 0.0);
    const size_t              n      = fit->lines.columns;
    struct dig_machine_unlike unlike = { .is = false };
    double                    widths[DIG_LINES_COLUMNS_MAX];
    double                    most2  = 0.0;
    double                    errors = 0.0;
    dig_fit_widths(fit, 0, 0.0, widths);
    (void)dig_fit_solve_each(fit, widths, DIG_FIT_COVARIANCE);
    for (size_t c = 0; c < n; c++) {
        const double told = 1.0 - fit->covariance[(n + 1) * c];
        if (fit->lines.column[c].effect != DIG_EFFECT_UNLISTED || !(told > least_told)) {
            continue;
        }
        errors += 1.0;
        if (fit->at[c] * fit->at[c] / told > most2) {
            most2         = fit->at[c] * fit->at[c] / told;
            unlike.column = c;
        }
    }
    // Chi-squared of one degree of freedom.
    unlike.p  = fmin(errors * dig_chance_gamma_tail(1.0, 2.0, most2), 1.0);
    unlike.is = errors > 0.0 && unlike.p < level;
    if (unlike.is) {
        widths[unlike.column] = DIG_UNLIKE_WIDTH;
        unlike.log_evidence =
            dig_fit_solve_each(fit, widths, DIG_FIT_NOTHING).log_evidence - log(errors);
    }
    return unlike;
}
