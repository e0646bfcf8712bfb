#include "closed_loop/design/design_view.h"

#include "closed_loop/numeric/dense.h"

#include <math.h>
#include <string.h>

static const double step = 0.02; // of the derivatives, in places

enum dig_status dig_design_look(const struct dig_design_table *const table, const size_t t,
                                const double place[DIG_AXES], const size_t n,
                                struct dig_design_view *const v)
{
    double feature[2][DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    v->n = n;
    dig_design_covariance(table, t, place, n, v->lower);
    if (dig_cholesky(n, v->lower) != DIG_OK) {
        return DIG_EINVAL;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        for (int side = 0; side < 2; side++) {
            double at[DIG_AXES];
            memcpy(at, place, sizeof at);
            at[a] += side == 0 ? -step : step;
            dig_response_surface_features(table->surface, t, at, feature[side], amplitude);
        }
        for (size_t k = 0; k < n; k++) {
            v->slope[a][k] = (feature[1][k] - feature[0][k]) / (2.0 * step);
        }
        dig_lower_solve(n, v->lower, v->slope[a]);
    }
    for (size_t a = 0; a < DIG_AXES; a++) {
        for (size_t b = 0; b < DIG_AXES; b++) {
            const double sum                  = dig_product(n, v->slope[a], v->slope[b]);
            v->normal[a * DIG_AXES + b]       = sum;
            v->normal_lower[a * DIG_AXES + b] = sum + (a == b ? DIG_DESIGN_PRIOR : 0.0);
        }
    }
    return dig_cholesky(DIG_AXES, v->normal_lower);
}

double dig_design_bits(const double normal[DIG_AXES * DIG_AXES])
{
    double m[DIG_AXES * DIG_AXES];
    for (size_t i = 0; i < DIG_DESIGN_SQUARE; i++) {
        m[i] = normal[i] / DIG_DESIGN_PRIOR + (i % (DIG_AXES + 1) == 0 ? 1.0 : 0.0);
    }
    return dig_cholesky(DIG_AXES, m) == DIG_OK ? 0.5 * dig_lower_log_det(DIG_AXES, m) / log(2.0)
                                               : 0.0;
}

void dig_design_take_gravel_off(const struct dig_design_view *const v, double d[])
{
    double g[DIG_AXES];
    for (size_t a = 0; a < DIG_AXES; a++) {
        g[a] = dig_product(v->n, v->slope[a], d);
    }
    dig_cholesky_solve(DIG_AXES, v->normal_lower, g);
    for (size_t k = 0; k < v->n; k++) {
        for (size_t a = 0; a < DIG_AXES; a++) {
            d[k] -= v->slope[a][k] * g[a];
        }
    }
}
