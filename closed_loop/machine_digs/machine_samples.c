#include "closed_loop/machine_digs/machine_samples.h"

#include "core/sample.h"
#include "estimator/wrench/cylinder.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// Rates from angles within this of a sample.
static const double rates_half_s = 0.12;

// Of the samples that tell the moment: a drive that fewer tell as well is left out.
static const double told_share = 0.5;

static bool is_read(const struct dig_sample *const sample, const size_t signal)
{
    return sample->valid[signal] && isfinite(sample->value[signal]);
}

static bool has_drive(const struct dig_sample *const sample, const size_t joint)
{
    const size_t head = (size_t)DIG_SIGNAL_BOOM_HEAD_Pa + DIG_CHAMBERS * joint;
    return is_read(sample, head + DIG_CHAMBER_HEAD) && is_read(sample, head + DIG_CHAMBER_ROD);
}

// The angles and the bucket's drive: less than that tells no moment.
static bool has_moment(const struct dig_sample *const sample)
{
    bool has = has_drive(sample, DIG_JOINT_BUCKET);
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        has = has && is_read(sample, (size_t)DIG_SIGNAL_BOOM_rad + j);
    }
    return has;
}

// Drives that a recording tells by and large: a machine may have its pressures at the bucket alone.
static void find_drives(const struct dig_machine_recording *const recording, bool told[DIG_JOINTS])
{
    double samples         = 0.0;
    double has[DIG_JOINTS] = { 0.0 };
    for (size_t i = 0; i < recording->rows; i++) {
        samples += has_moment(&recording->row[i]) ? 1.0 : 0.0;
        for (size_t j = 0; j < DIG_JOINTS && has_moment(&recording->row[i]); j++) {
            has[j] += has_drive(&recording->row[i], j) ? 1.0 : 0.0;
        }
    }
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        told[j] = has[j] > told_share * samples;
    }
}

// Samples with all that the recording tells, in time; without the rest of it.
static size_t copy_complete(const struct dig_machine_recording *const recording,
                            struct dig_sample                         sample[])
{
    size_t n = 0;
    bool   told[DIG_JOINTS];
    find_drives(recording, told);
    for (size_t i = 0; i < recording->rows; i++) {
        bool ok = has_moment(&recording->row[i]);
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            ok = ok && (!told[j] || has_drive(&recording->row[i], j));
        }
        if (!ok || (n > 0 && recording->row[i].time_ns <= sample[n - 1].time_ns)) {
            continue;
        }
        sample[n] = recording->row[i];
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            const size_t head = (size_t)DIG_SIGNAL_BOOM_HEAD_Pa + DIG_CHAMBERS * j;

            sample[n].valid[head + DIG_CHAMBER_HEAD] = told[j];
            sample[n].valid[head + DIG_CHAMBER_ROD]  = told[j];
        }
        n++;
    }
    return n;
}

enum dig_status dig_machine_samples_take(const struct dig_machine *const           machine,
                                         const struct dig_machine_recording *const recording,
                                         struct dig_machine_dig *const             dig,
                                         struct dig_error *const                   error)
{
    assert(machine != NULL && recording != NULL && dig != NULL);
    const size_t  rows      = recording->rows + 1;
    double *const joint_rad = malloc(DIG_JOINTS * rows * sizeof *joint_rad);
    *dig                    = (struct dig_machine_dig){
                           .sample = malloc(rows * sizeof *dig->sample),
                           .time_s = malloc(rows * sizeof *dig->time_s),
                           .rates  = malloc(rows * sizeof *dig->rates),
    };
    if (joint_rad == NULL || dig->sample == NULL || dig->time_s == NULL || dig->rates == NULL) {
        free(joint_rad);
        return dig_error_set(error, DIG_ENOMEM, "%zu samples", recording->rows);
    }
    dig->samples = copy_complete(recording, dig->sample);
    for (size_t i = 0; i < dig->samples; i++) {
        dig->time_s[i] = 1e-9 * (double)(dig->sample[i].time_ns - dig->sample[0].time_ns);
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            joint_rad[DIG_JOINTS * i + j] = dig->sample[i].value[(size_t)DIG_SIGNAL_BOOM_rad + j];
        }
    }
    dig_rates_centred(dig->samples, dig->time_s, joint_rad, rates_half_s,
                      dig_reading_sigma(machine->angle_step_rad, machine->angle_sigma_rad),
                      dig->rates);
    free(joint_rad);
    return dig->samples >= 50
               ? DIG_OK
               : dig_error_set(error, DIG_EINVAL,
                               "%zu samples with all angles and the bucket cylinder's pressures, "
                               "expected 50 at least",
                               dig->samples);
}

size_t dig_machine_dig_sample_at(const struct dig_machine_dig *const dig, const double time_s)
{
    size_t i = 0;
    while (i < dig->samples && dig->time_s[i] < time_s) {
        i++;
    }
    return i;
}
