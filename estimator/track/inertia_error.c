#include "estimator/track/inertia_error.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// Newtons per kilogram of the links.
static const double unmodelled_mps2 = 0.1;

void dig_inertia_error_add(const struct dig_machine *const machine, const double lambda,
                           struct dig_observation *const dig)
{
    assert(machine != NULL && lambda > 0.0 && dig != NULL);
    double mass_kg = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        mass_kg += machine->link[j].mass_kg;
    }
    const double doubt_N = unmodelled_mps2 * mass_kg / pow(lambda, 3.0);
    for (int c = 0; dig->forces && c + 1 < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            dig->force_sigma_N[c][k] = hypot(dig->force_sigma_N[c][k], doubt_N);
        }
    }
}
