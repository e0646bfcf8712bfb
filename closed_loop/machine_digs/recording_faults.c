#include "closed_loop/machine_digs/recording_faults.h"

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

// Half way, by factors, from what digs of the lightest gravel reach to what kPa would read.
static const double lowest_share = 0.01;

// A relief valve opens, and holds its pressure within some tenths.
static const double relief_share = 2.0;

// Single readings may be spikes.
static const double spikes = 0.01;

struct chamber {
    double least, most; // of relief_Pa
    size_t readings, beyond;
};

static struct chamber read_chamber(const struct dig_machine_recording *const recording,
                                   const size_t signal, const double relief_Pa)
{
    struct chamber c = { INFINITY, -INFINITY, 0, 0 };
    for (size_t i = 0; i < recording->rows; i++) {
        if (recording->row[i].valid[signal]) {
            const double share = recording->row[i].value[signal] / relief_Pa;
            c.least            = fmin(c.least, share);
            c.most             = fmax(c.most, share);
            c.readings++;
            c.beyond += share > relief_share ? 1 : 0;
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
    const struct chamber head   = read_chamber(recording, signal, relief_Pa);
    const struct chamber rod    = read_chamber(recording, signal + 1, relief_Pa);
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
    if (status == DIG_OK && isfinite(most) && most < lowest_share) {
        return dig_error_set(error, DIG_EINVAL,
                             "pressures reach %.2g of what opens a relief valve at most, expected "
                             "Pa, not bar or MPa",
                             most);
    }
    return status;
}

// As much of a pressure at its highest value is no load that comes and goes.
static const double least_s      = 1.0;
static const double over_below   = 10.0; // samples at the top over samples just below it
static const double over_back    = 3.0;
static const double just_below   = 0.01; // of the highest value
static const double steps_below  = 1.5;  // or of the step that the readings make there
static const double same_to_this = 1e-6;
static const double least_pairs  = 50.0; // of readings that tell how often one repeats

// The highest value below one; 0 where there is none.
static double highest_below(const struct dig_machine_recording *const recording, const int signal,
                            const double below_Pa)
{
    double most = 0.0;
    for (size_t i = 0; i < recording->rows; i++) {
        if (recording->row[i].valid[signal] && recording->row[i].value[signal] < below_Pa) {
            most = fmax(most, recording->row[i].value[signal]);
        }
    }
    return most;
}

static double highest(const struct dig_machine_recording *const recording, const int signal)
{
    return highest_below(recording, signal, INFINITY);
}

// Below this chance readings that stay equal are no accident of noise and steps.
static const double least_log10 = -3.0;

// Where more readings repeat the one before than this, or some repeat as long elsewhere, noise does
// not show through the steps, and a load that stands still reads the same for as long as it stands.
static const double most_repeated = 0.7;

double dig_saturation_log10_chance(const struct dig_machine_recording *const recording,
                                   const enum dig_signal                     signal)
{
    assert(recording != NULL);
    const double most     = highest(recording, signal);
    double       readings = 0.0;
    double       pairs    = 0.0;
    double       repeated = 0.0;
    double       run      = 0.0;
    double       longest  = 0.0;
    double       same     = 1.0;
    double       below    = 1.0; // longest run of equal readings that are not the highest
    double       before   = most;
    for (size_t i = 0; i < recording->rows; i++) {
        const double value = recording->row[i].value[signal];
        if (!recording->row[i].valid[signal]) {
            continue;
        }
        const bool top = value >= most * (1.0 - same_to_this);
        run            = top ? run + 1.0 : 0.0;
        longest        = fmax(longest, run);
        readings += 1.0;
        if (!top && before < most * (1.0 - same_to_this)) {
            const bool again = fabs(value - before) <= same_to_this * most;

            same  = again ? same + 1.0 : 1.0;
            below = fmax(below, same);
            pairs += 1.0;
            repeated += again ? 1.0 : 0.0;
        }
        before = value;
    }
    const double share = (repeated + 1.0) / (pairs + 2.0);
    const bool   noisy = pairs > least_pairs && share <= most_repeated && longest > below;
    return most > 0.0 && noisy ? fmin(log10(readings) + (longest - 1.0) * log10(share), 0.0) : 0.0;
}

static bool is_clipped(const struct dig_machine *const           machine,
                       const struct dig_machine_recording *const recording, const int signal,
                       struct dig_clip *const clip)
{
    const int    drive  = (signal - DIG_SIGNAL_BOOM_HEAD_Pa) / 2;
    const double most   = highest(recording, signal);
    const double next   = highest_below(recording, signal, most * (1.0 - same_to_this));
    const double near   = fmax(just_below * most, steps_below * (most - next));
    double       at_top = 0.0;
    double       below  = 0.0;
    for (size_t i = 0; i < recording->rows; i++) {
        const double value = recording->row[i].value[signal];
        const bool   top   = value >= most * (1.0 - same_to_this);
        if (recording->row[i].valid[signal] && value > most - near) {
            at_top += top ? 1.0 : 0.0;
            below += top ? 0.0 : 1.0;
        }
    }
    const int64_t whole_ns =
        recording->row[recording->rows - 1].time_ns - recording->row[0].time_ns;
    const double step_s = 1e-9 * (double)whole_ns / (double)(recording->rows - 1);
    *clip               = (struct dig_clip){ (enum dig_signal)signal, most, at_top * step_s };
    const bool piled_up = most > over_back * machine->cylinder[drive].back_Pa &&
                          clip->time_s >= least_s && at_top > over_below * below;
    return piled_up ||
           dig_saturation_log10_chance(recording, (enum dig_signal)signal) < least_log10;
}

bool dig_saturation_find(const struct dig_machine *const           machine,
                         const struct dig_machine_recording *const recording,
                         struct dig_clip *const                    clip)
{
    assert(machine != NULL && recording != NULL && clip != NULL);
    bool found = false;
    for (int s = DIG_SIGNAL_BOOM_HEAD_Pa; s <= DIG_SIGNAL_BUCKET_ROD_Pa && recording->rows > 1;
         s++) {
        struct dig_clip one;
        if (is_clipped(machine, recording, s, &one) && (!found || one.time_s > clip->time_s)) {
            *clip = one;
            found = true;
        }
    }
    return found;
}
