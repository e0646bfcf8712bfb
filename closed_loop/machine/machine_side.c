#include "closed_loop/machine/machine_side.h"

#include "closed_loop/machine/machine_search.h"
#include "closed_loop/recordings/reading_noise.h"
#include "estimator/effects/effect.h"
#include "estimator/track/window.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// Why the moment of a dig is not told.
static enum dig_status explain(const struct dig_machine_dig *const dig,
                               const struct dig_curve_set *const set, const enum dig_status status,
                               struct dig_error *const why)
{
    double gap_s = 0.0;
    size_t after = dig->contact;
    for (size_t i = dig->contact; i + 1 < dig->samples && i < dig->end; i++) {
        const double s = dig->time_s[i + 1] - dig->time_s[i];
        after          = s > gap_s ? i : after;
        gap_s          = fmax(gap_s, s);
    }
    if (status != DIG_ENOMATCH) {
        return dig_error_set(why, status, "%s", dig_status_str(status));
    }
    const double most_s = sqrt(dig->lambda) * dig_window_hole_s(set->smooth_half_s / dig->pace);
    if (gap_s > most_s) {
        return dig_error_set(why, status,
                             "its moment is not told: no whole sample for %.2g s after t_s %.9g, "
                             "expected none missing in its dig for more than %.2g s",
                             gap_s, 1e-9 * (double)dig->sample[after].time_ns, most_s);
    }
    return dig_error_set(why, status,
                         "its moment is not told: a pressure at relief or a drive at its stop for "
                         "more than a tenth of the dig");
}

enum dig_status dig_machine_side_create(const struct dig_machine *const   machine,
                                        const struct dig_curve_set *const set, const size_t digs,
                                        const struct dig_machine_recording recording[],
                                        struct dig_measured                measured[],
                                        struct dig_machine_side **const    side,
                                        struct dig_error *const            error)
{
    assert(machine != NULL && set != NULL && side != NULL);
    assert(digs == 0 || (recording != NULL && measured != NULL));
    struct dig_machine_side *const made = calloc(1, sizeof *made);
    if (made == NULL || digs > DIG_MEASURED_MAX) {
        free(made);
        return dig_error_set(error, made == NULL ? DIG_ENOMEM : DIG_EINVAL,
                             "%zu machine recordings, expected at most %d", digs, DIG_MEASURED_MAX);
    }
    made->machine = *machine;
    made->set     = set;
    dig_reading_noise_raise(&made->machine, digs, recording);
    for (size_t d = 0; d < digs; d++) {
        struct dig_error why    = { "" };
        enum dig_status  status = dig_machine_dig_make(&made->machine, set, &recording[d],
                                                       measured[d].trajectory, &made->dig[d], &why);
        if (status == DIG_OK) {
            made->digs = d + 1;
            status     = dig_machine_dig_measure(&made->machine, set, &made->dig[d],
                                                 &(struct dig_correction){ .delay_s = 0.0 },
                                                 DIG_MEASURE_WITH_SIGMA, &measured[d]);
            status     = status == DIG_OK ? status : explain(&made->dig[d], set, status, &why);
        }
        if (status != DIG_OK) {
            (void)dig_error_set(error, status, "%s: %s", measured[d].name, why.text);
            dig_machine_side_destroy(made);
            return status;
        }
        made->used[d]               = measured[d].use != DIG_USE_HOLDOUT;
        measured[d].made.attack_rad = made->dig[d].track.turn_m / set->tooth_m;
        measured[d].depth_share     = 1.0;
    }
    *side = made;
    return DIG_OK;
}

void dig_machine_side_destroy(struct dig_machine_side *const side)
{
    if (side == NULL) {
        return;
    }
    for (size_t d = 0; d < side->digs; d++) {
        dig_machine_dig_finish(&side->dig[d]);
    }
    if (side->begun) {
        dig_machine_search_finish(&side->search);
    }
    free(side);
}

const struct dig_machine *dig_machine_side_machine(const struct dig_machine_side *const side)
{
    return &side->machine;
}

// What the effects of the machine among these, and what the file has wrong, say of one dig.
static enum dig_status correction_of(const struct dig_machine_side *const side,
                                     const size_t effects, const struct dig_model_effect effect[],
                                     const double *const file, const size_t dig,
                                     struct dig_correction *const correction)
{
    struct dig_correction sum = { .delay_s = 0.0 };
    if (file != NULL) {
        dig_file_correct(file, &sum);
    }
    for (size_t e = 0; e < effects; e++) {
        const enum dig_effect_id id = effect[e].effect;
        if (!dig_effect_is_of_machine(id)) {
            continue;
        }
        double value[DIG_MODEL_PARAMETERS_MAX];
        if (dig_effect_values(&effect[e], value) != DIG_OK) {
            return DIG_ENOMATCH;
        }
        if (id == DIG_EFFECT_PAYLOAD) {
            // The first dig lacks the common one.
            dig_lines_carry(value, dig > 0, side->own_payload_kg[dig], &sum.payload);
        } else {
            dig_effect_of(id)->correct(value, &sum);
        }
    }
    *correction = sum;
    return DIG_OK;
}

enum dig_status dig_machine_side_apply(const struct dig_machine_side *const side,
                                       const size_t effects, const struct dig_model_effect effect[],
                                       const double              file[DIG_FILE_ERRORS],
                                       const enum dig_apply      apply,
                                       const struct dig_measured measured[],
                                       double machine[][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    assert(side != NULL && (side->digs == 0 || (measured != NULL && machine != NULL)));
    enum dig_status status = DIG_OK;
    for (size_t d = 0; d < side->digs && status == DIG_OK; d++) {
        struct dig_correction correction;
        struct dig_measured   corrected = measured[d];
        if (apply != DIG_APPLY_TO_ALL && measured[d].use == DIG_USE_HOLDOUT) {
            continue;
        }
        status = correction_of(side, effects, effect, file, d, &correction);
        if (status == DIG_OK) {
            status = dig_machine_dig_measure(
                &side->machine, side->set, &side->dig[d], &correction,
                apply == DIG_APPLY_ROUGHLY ? DIG_MEASURE_ROUGHLY : DIG_MEASURE_VALUES, &corrected);
        }
        for (int c = 0; c < DIG_FORCE_CHANNELS && status == DIG_OK; c++) {
            const bool both = measured[d].measured[c] && corrected.measured[c];
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                // As it was measured: what another approach adds may be taken off by now.
                const double value = measured[d].value[c][k] + measured[d].added.value[c][k];
                machine[d][c][k]   = both ? value - corrected.value[c][k] : 0.0;
            }
        }
    }
    return status;
}
