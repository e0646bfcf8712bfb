#include "closed_loop/clipped.h"

#include <assert.h>
#include <math.h>

static const double least_s      = 1.0;
static const double over_below   = 10.0; // samples at the top over samples just below it
static const double over_back    = 2.0;
static const double just_below   = 0.01; // of the highest value
static const double same_to_this = 1e-6;

static double highest(const struct dig_machine_recording *const recording, const int signal)
{
    double most = 0.0;
    for (size_t i = 0; i < recording->rows; i++) {
        if (recording->row[i].valid[signal]) {
            most = fmax(most, recording->row[i].value[signal]);
        }
    }
    return most;
}

static bool is_clipped(const struct dig_machine *const           machine,
                       const struct dig_machine_recording *const recording, const int signal,
                       struct dig_clip *const clip)
{
    const int    drive  = (signal - DIG_SIGNAL_BOOM_HEAD_Pa) / 2;
    const double most   = highest(recording, signal);
    const double near   = fmax(just_below * most, 1.5 * machine->pressure_step_Pa);
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
    return most > over_back * machine->cylinder[drive].back_Pa && clip->time_s >= least_s &&
           at_top > over_below * below;
}

bool dig_clipped_find(const struct dig_machine *const           machine,
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
