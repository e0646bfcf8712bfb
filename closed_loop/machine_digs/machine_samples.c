// Selects the samples of a machine's recording that can be used: in time, with all angles, and with
// the pressures of the bucket's drive and of every other drive that half of the samples have.

#include "closed_loop/machine_digs/machine_dig.h"
#include "closed_loop/machine_digs/recording_faults.h"
#include "core/sample.h"
#include "estimator/track/steady.h"
#include "estimator/wrench/cylinder.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

enum { LEAST_SAMPLES = 50 };

// Rates from angles within this of a sample.
static const double rates_half_s = 0.12;

// Of the samples that tell the moment: a drive that fewer tell as well is left out.
static const double told_share = 0.5;

// Of the bucket's length: a step of an angle that takes the tooth no farther is as good as none.
static const double shown_share = 0.01;

// Vertices of the path that is smoothed lie as far apart, in tooth lengths, as those that a dig is
// found by.
static const double spacing_share = 0.025;

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

static void take(const struct dig_machine_dig *const dig, const size_t signal, double value[])
{
    for (size_t i = 0; i < dig->samples; i++) {
        value[i] = dig->sample[i].value[signal];
    }
}

static void put(const struct dig_machine_dig *const dig, const size_t signal, const double value[])
{
    for (size_t i = 0; i < dig->samples; i++) {
        dig->sample[i].value[signal] = value[i];
    }
}

// Where an angle arrives in steps that the path shows, its joint went from one to the next: else
// one that turns steadily stands, and then turns faster than any.
static void undo_steps(const struct dig_machine *const     machine,
                       const struct dig_machine_dig *const dig, double number[])
{
    double reach_m = 0.0;
    for (size_t j = DIG_JOINTS; j-- > 0;) {
        reach_m += machine->link[j].length_m;
        take(dig, DIG_SIGNAL_BOOM_rad + j, number);
        dig_steady_readings(
            dig->samples, shown_share * machine->link[DIG_JOINT_BUCKET].length_m / reach_m, number);
        put(dig, DIG_SIGNAL_BOOM_rad + j, number);
    }
}

// Noise of the angles is smoothed as far as that of the path that they make has to be.
static void smooth(const struct dig_machine *const machine, const struct dig_machine_dig *const dig,
                   double number[])
{
    const size_t                 n       = dig->samples;
    const double                 tooth_m = machine->link[DIG_JOINT_BUCKET].length_m;
    double *const                pose    = number + 4 * n + 1;
    double *const                room[]  = { number, number + n, number + 2 * n };
    double *const                sum     = number + 3 * n;
    const struct dig_steady_axis axis[]  = { { pose, 1, 1.0 },
                                             { pose + n, 1, 1.0 },
                                             { pose + 2 * n, 1, tooth_m } };
    for (size_t i = 0; i < n; i++) {
        const struct dig_front front =
            dig_front_place(machine, &dig->sample[i].value[DIG_SIGNAL_BOOM_rad]);
        pose[i]         = front.pin_m[DIG_JOINT_BUCKET].x;
        pose[n + i]     = front.pin_m[DIG_JOINT_BUCKET].y;
        pose[2 * n + i] = front.attitude_rad[DIG_JOINT_BUCKET];
    }
    const size_t far = dig_steady_smooth(n, axis, spacing_share * tooth_m, room, sum);
    for (size_t s = DIG_SIGNAL_BOOM_rad; s <= DIG_SIGNAL_BUCKET_rad; s++) {
        take(dig, s, number);
        dig_steady_average(n, far, number, sum);
        put(dig, s, number);
    }
}

// The angles as the joints turned, where their sensors read them in steps or with noise. Across a
// jump nothing turned.
static enum dig_status steady(const struct dig_machine *const machine,
                              struct dig_machine_dig *const   dig)
{
    struct dig_pose_jump jump;
    if (dig_pose_jump_find(dig->samples, dig->sample, &jump)) {
        return DIG_OK;
    }
    double *const number = malloc((7 * dig->samples + 1) * sizeof *number);
    if (number == NULL) {
        return DIG_ENOMEM;
    }
    undo_steps(machine, dig, number);
    smooth(machine, dig, number);
    free(number);
    return DIG_OK;
}

void dig_machine_dig_finish(struct dig_machine_dig *const dig)
{
    if (dig != NULL) {
        free(dig->sample);
        free(dig->time_s);
        free(dig->rates);
        *dig = (struct dig_machine_dig){ .samples = 0 };
    }
}

enum dig_status dig_machine_dig_make_air(const struct dig_machine *const           machine,
                                         const struct dig_machine_recording *const recording,
                                         struct dig_machine_dig *const             dig,
                                         struct dig_error *const                   error)
{
    assert(machine != NULL && recording != NULL && dig != NULL);
    const size_t           rows      = recording->rows + 1;
    double *const          joint_rad = malloc(DIG_JOINTS * rows * sizeof *joint_rad);
    struct dig_machine_dig made      = {
             .sample     = malloc(rows * sizeof *made.sample),
             .time_s     = malloc(rows * sizeof *made.time_s),
             .rates      = malloc(rows * sizeof *made.rates),
             .trajectory = -1,
    };
    enum dig_status status = DIG_OK;
    if (joint_rad == NULL || made.sample == NULL || made.time_s == NULL || made.rates == NULL) {
        status = dig_error_set(error, DIG_ENOMEM, "%zu samples", recording->rows);
        goto done;
    }
    made.samples = copy_complete(recording, made.sample);
    if (made.samples < LEAST_SAMPLES) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%zu samples with all angles and the bucket cylinder's pressures, "
                               "expected %d at least",
                               made.samples, LEAST_SAMPLES);
        goto done;
    }
    status = steady(machine, &made);
    if (status != DIG_OK) {
        (void)dig_error_set(error, status, "%zu samples", made.samples);
        goto done;
    }
    for (size_t i = 0; i < made.samples; i++) {
        made.time_s[i] = 1e-9 * (double)(made.sample[i].time_ns - made.sample[0].time_ns);
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            joint_rad[DIG_JOINTS * i + j] = made.sample[i].value[(size_t)DIG_SIGNAL_BOOM_rad + j];
        }
    }
    dig_rates_centred(made.samples, made.time_s, joint_rad, rates_half_s,
                      dig_reading_sigma(machine->angle_step_rad, machine->angle_sigma_rad),
                      made.rates);
    made.before_end = made.contact = made.end = made.after = made.after_end = made.samples;
done:
    free(joint_rad);
    if (status == DIG_OK) {
        *dig = made;
    } else {
        dig_machine_dig_finish(&made);
    }
    return status;
}

size_t dig_machine_dig_sample_at(const struct dig_machine_dig *const dig, const double time_s)
{
    size_t i = 0;
    while (i < dig->samples && dig->time_s[i] < time_s) {
        i++;
    }
    return i;
}

bool dig_machine_dig_pitch(const struct dig_machine_dig *const dig, const size_t from,
                           const size_t to, double *const rad)
{
    double sum   = 0.0;
    double count = 0.0;
    for (size_t i = from; i < to && i < dig->samples; i++) {
        if (dig->sample[i].valid[DIG_SIGNAL_PITCH_rad]) {
            sum += dig->sample[i].value[DIG_SIGNAL_PITCH_rad];
            count += 1.0;
        }
    }
    *rad = count > 0.0 ? sum / count : 0.0;
    return count > 0.0;
}

struct dig_between dig_machine_dig_between(const struct dig_machine_dig *const dig,
                                           const double time_s, const size_t near)
{
    assert(dig != NULL && dig->samples >= 2);
    size_t i = near < dig->samples - 2 ? near : dig->samples - 2;
    while (i > 0 && dig->time_s[i] > time_s) {
        i--;
    }
    while (i + 2 < dig->samples && dig->time_s[i + 1] <= time_s) {
        i++;
    }
    const double f = (time_s - dig->time_s[i]) / (dig->time_s[i + 1] - dig->time_s[i]);
    return (struct dig_between){ i, fmin(fmax(f, 0.0), 1.0) };
}

struct dig_rates dig_machine_dig_rates(const struct dig_machine_dig *const dig,
                                       const struct dig_between            at)
{
    return dig_rates_between(&dig->rates[at.sample], &dig->rates[at.sample + 1], at.fraction);
}
