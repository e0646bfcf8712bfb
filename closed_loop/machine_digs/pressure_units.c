#include "closed_loop/machine_digs/pressure_units.h"

#include <assert.h>
#include <math.h>

// Half way, by factors, from what digs of the lightest gravel reach to what kPa would read.
static const double least_share = 0.01;

enum dig_status dig_pressure_units_check(const struct dig_machine *const           machine,
                                         const struct dig_machine_recording *const recording,
                                         struct dig_error *const                   error)
{
    assert(machine != NULL && recording != NULL);
    double share    = 0.0;
    double greatest = -1.0; // none
    for (size_t i = 0; i < recording->rows; i++) {
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            for (size_t side = 0; side < 2; side++) {
                const size_t s = DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j + side;
                if (recording->row[i].valid[s]) {
                    const double value = recording->row[i].value[s];
                    greatest           = fmax(greatest, value);
                    share              = fmax(share, value / machine->cylinder[j].relief_Pa);
                }
            }
        }
    }
    if (greatest >= 0.0 && share < least_share) {
        return dig_error_set(error, DIG_EINVAL,
                             "pressures reach %.3g at most, %.2g of what opens a relief valve, "
                             "expected Pa, not bar or MPa",
                             greatest, share);
    }
    return DIG_OK;
}
