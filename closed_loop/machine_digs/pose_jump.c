#include "closed_loop/machine_digs/pose_jump.h"

#include "core/machine.h"

#include <assert.h>
#include <math.h>

// No joint of an excavator turns as fast, and no angle sensor scatters as far.
static const double fastest_radps = 3.0;
static const double scatter_rad   = 0.1;

// From before, over the sample after it, to the next: one wrong sample changes only some of these.
static double least_step_rad(const struct dig_sample *const before, const size_t signal)
{
    const double previous = before[-1].value[signal];
    const double last     = before[0].value[signal];
    const double first    = before[1].value[signal];
    const double second   = before[2].value[signal];
    return fmin(fabs(first - last), fmin(fabs(first - previous), fabs(second - last)));
}

bool dig_pose_jump_find(const size_t samples, const struct dig_sample sample[],
                        struct dig_pose_jump *const jump)
{
    assert(sample != NULL && jump != NULL);
    for (size_t i = 1; i + 2 < samples; i++) {
        const double time_s = 1e-9 * (double)(sample[i + 2].time_ns - sample[i - 1].time_ns);
        for (size_t s = DIG_SIGNAL_BOOM_rad; s < (size_t)DIG_SIGNAL_BOOM_rad + DIG_JOINTS; s++) {
            if (least_step_rad(&sample[i], s) > scatter_rad + fastest_radps * time_s) {
                *jump = (struct dig_pose_jump){ i, (enum dig_signal)s,
                                                sample[i + 1].value[s] - sample[i].value[s] };
                return true;
            }
        }
    }
    return false;
}
