#include "closed_loop/machine/machine_unlike.h"

#include "core/chance.h"

#include <assert.h>
#include <math.h>

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
