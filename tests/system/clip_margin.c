// clip_margin MACHINE.yaml RECORDING.csv…: for every chamber as recorded, and cut off at nine
// tenths and at half of its highest reading, whether it is refused and the log10 of the chance that
// decides (closed_loop/machine_digs/recording_faults.h).

#include "closed_loop/machine_digs/recording_faults.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The readings of one chamber cut off at a limit; whether that is refused is told beside.
static double cut_at(const struct dig_machine *const machine, struct dig_machine_recording *const r,
                     const int signal, const double limit_Pa, int *const refused)
{
    struct dig_sample *const whole = malloc(r->rows * sizeof *whole);
    if (whole == NULL) {
        abort();
    }
    memcpy(whole, r->row, r->rows * sizeof *whole);
    for (size_t i = 0; i < r->rows; i++) {
        r->row[i].value[signal] = fmin(r->row[i].value[signal], limit_Pa);
    }
    struct dig_clip clip;
    *refused            = dig_saturation_find(machine, r, &clip) ? 1 : 0;
    const double chance = dig_saturation_log10_chance(r, (enum dig_signal)signal);
    memcpy(r->row, whole, r->rows * sizeof *whole);
    free(whole);
    return chance;
}

static double highest(const struct dig_machine_recording *const r, const int signal)
{
    double most = 0.0;
    for (size_t i = 0; i < r->rows; i++) {
        most = r->row[i].valid[signal] ? fmax(most, r->row[i].value[signal]) : most;
    }
    return most;
}

static void tell(const struct dig_machine *const machine, struct dig_machine_recording *const r,
                 const char *const file, const int signal)
{
    static const double share[] = { 1.0, 0.9, 0.5 };

    const int    drive = (signal - DIG_SIGNAL_BOOM_HEAD_Pa) / 2;
    const double peak  = highest(r, signal);
    for (size_t k = 0; k < sizeof share / sizeof share[0]; k++) {
        // What is cut into the return side's pressure is another matter.
        if (share[k] < 1.0 && 0.5 * peak < 1.3 * machine->cylinder[drive].back_Pa) {
            continue;
        }
        int          refused = 0;
        const double chance  = cut_at(machine, r, signal, share[k] * peak, &refused);
        (void)printf("%s %s %.1f %d %.2f\n", file, dig_signal_name((enum dig_signal)signal),
                     share[k], refused, chance);
    }
}

int main(const int argc, char *argv[])
{
    struct dig_machine machine;
    struct dig_error   error = { "" };
    if (argc < 3 || dig_machine_read(argv[1], &machine, &error) != DIG_OK) {
        (void)fprintf(stderr, "clip_margin: %s\n", error.text);
        return 2;
    }
    for (int f = 2; f < argc; f++) {
        struct dig_machine_recording r;
        if (dig_machine_recording_read(argv[f], &r, &error) != DIG_OK) {
            (void)fprintf(stderr, "clip_margin: %s\n", error.text);
            return 2;
        }
        for (int s = DIG_SIGNAL_BOOM_HEAD_Pa; s <= DIG_SIGNAL_BUCKET_ROD_Pa; s++) {
            tell(&machine, &r, argv[f], s);
        }
        dig_machine_recording_finish(&r);
    }
    return 0;
}
