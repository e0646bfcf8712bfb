#include "files/lcm/predicted_curve.h"

#include "core/name.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static bool are_moments(const double moment_Nm[DIG_PREDICTED_POINTS])
{
    int i = 0;
    while (i < DIG_PREDICTED_POINTS && fabs(moment_Nm[i]) <= DIG_MOMENT_MOST_Nm) {
        i++;
    }
    return i == DIG_PREDICTED_POINTS;
}

bool dig_predicted_curve_take(const digsight_prediction_t *const m,
                              struct dig_predicted_curve *const  curve)
{
    assert(m != NULL && curve != NULL);
    if (!m->valid || m->points != DIG_PREDICTED_POINTS || !dig_name_ok(m->trajectory) ||
        strlen(m->trajectory) >= sizeof curve->trajectory ||
        !(m->from_progress >= 0.0 && m->from_progress < m->to_progress && m->to_progress <= 1.0) ||
        !are_moments(m->moment_Nm) || !are_moments(m->sigma_Nm)) {
        return false;
    }
    *curve = (struct dig_predicted_curve){ .from           = m->from_progress,
                                           .to             = m->to_progress,
                                           .peak_Nm        = m->peak_Nm,
                                           .peak_sigma_Nm  = m->peak_sigma_Nm,
                                           .energy_J       = m->energy_J,
                                           .energy_sigma_J = m->energy_sigma_J };
    (void)snprintf(curve->trajectory, sizeof curve->trajectory, "%s", m->trajectory);
    memcpy(curve->moment_Nm, m->moment_Nm, sizeof curve->moment_Nm);
    memcpy(curve->sigma_Nm, m->sigma_Nm, sizeof curve->sigma_Nm);
    return true;
}

bool dig_predicted_curve_at(const struct dig_predicted_curve *const curve, const double progress,
                            double *const moment_Nm, double *const sigma_Nm)
{
    assert(curve != NULL && moment_Nm != NULL && sigma_Nm != NULL);
    static const double rounding = 1e-9; // an end that is computed is an end
    const double        last     = DIG_PREDICTED_POINTS - 1;
    const double        place    = (progress - curve->from) / (curve->to - curve->from) * last;
    if (!(place >= -rounding && place <= last + rounding)) {
        return false;
    }
    const size_t i = (size_t)fmin(fmax(floor(place), 0.0), last - 1.0);
    const double f = place - (double)i;
    *moment_Nm     = (1.0 - f) * curve->moment_Nm[i] + f * curve->moment_Nm[i + 1];
    *sigma_Nm      = (1.0 - f) * curve->sigma_Nm[i] + f * curve->sigma_Nm[i + 1];
    return true;
}
