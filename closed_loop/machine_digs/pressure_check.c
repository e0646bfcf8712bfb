#include "closed_loop/machine_digs/pressure_check.h"

#include "core/sample.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

// Half way, by factors, from what digs of the lightest gravel reach to what kPa would read.
static const double least_share = 0.01;

// A relief valve opens, and holds its pressure within some tenths.
static const double most_share = 2.0;

// Single readings may be spikes.
static const double spikes = 0.01;

struct chamber {
    double least, most; // of relief_Pa
    size_t readings, beyond;
};

static struct chamber read(const struct dig_machine_recording *const recording, const size_t signal,
                           const double relief_Pa)
{
    struct chamber c = { INFINITY, -INFINITY, 0, 0 };
    for (size_t i = 0; i < recording->rows; i++) {
        if (recording->row[i].valid[signal]) {
            const double share = recording->row[i].value[signal] / relief_Pa;
            c.least            = fmin(c.least, share);
            c.most             = fmax(c.most, share);
            c.readings++;
            c.beyond += share > most_share ? 1 : 0;
        }
    }
    return c;
}

// Two readings tell nothing.
static bool is_dead(const struct chamber *const c)
{
    return c->readings > 2 && !(c->most > c->least);
}

static enum dig_status check_relief(const struct chamber *const c, const size_t signal,
                                    struct dig_error *const error)
{
    return (double)c->beyond > spikes * (double)c->readings
               ? dig_error_set(error, DIG_EINVAL,
                               "%s reaches %.3g times what opens its relief valve, expected Pa",
                               dig_signal_name((enum dig_signal)signal), c->most)
               : DIG_OK;
}

static enum dig_status check_drive(const struct dig_machine_recording *const recording,
                                   const size_t signal, const double relief_Pa, double *const most,
                                   struct dig_error *const error)
{
    const struct chamber head   = read(recording, signal, relief_Pa);
    const struct chamber rod    = read(recording, signal + 1, relief_Pa);
    enum dig_status      status = check_relief(&head, signal, error);
    if (status == DIG_OK) {
        status = check_relief(&rod, signal + 1, error);
    }
    *most = fmax(*most, fmax(head.most, rod.most));
    return status == DIG_OK && is_dead(&head) && is_dead(&rod)
               ? dig_error_set(error, DIG_EINVAL,
                               "%s and %s never change, expected what a sensor reads",
                               dig_signal_name((enum dig_signal)signal),
                               dig_signal_name((enum dig_signal)(signal + 1)))
               : status;
}

enum dig_status dig_pressure_check(const struct dig_machine *const           machine,
                                   const struct dig_machine_recording *const recording,
                                   struct dig_error *const                   error)
{
    assert(machine != NULL && recording != NULL);
    double          most   = -INFINITY; // none
    enum dig_status status = DIG_OK;
    for (size_t j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        status = check_drive(recording, DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j,
                             machine->cylinder[j].relief_Pa, &most, error);
    }
    if (status == DIG_OK && isfinite(most) && most < least_share) {
        return dig_error_set(error, DIG_EINVAL,
                             "pressures reach %.2g of what opens a relief valve at most, expected "
                             "Pa, not bar or MPa",
                             most);
    }
    return status;
}
