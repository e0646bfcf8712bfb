#include "tools/rig/bus/fault.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char             *name;
    enum dig_rig_fault_kind kind;
    double                  most; // of its amount; 0: it has none
} kinds[] = {
    { "not-available", DIG_RIG_FAULT_NOT_AVAILABLE, 0.0 },
    { "frozen", DIG_RIG_FAULT_FROZEN, 0.0 },
    { "missing", DIG_RIG_FAULT_MISSING, 0.0 },
    { "out-of-range", DIG_RIG_FAULT_OUT_OF_RANGE, 0.0 },
    { "stuck-pressures", DIG_RIG_FAULT_STUCK_PRESSURES, 0.0 },
    { "stuck-angles", DIG_RIG_FAULT_STUCK_ANGLES, 0.0 },
    { "drop", DIG_RIG_FAULT_DROP, 1.0 },
    { "duplicate", DIG_RIG_FAULT_DUPLICATE, 1.0 },
    { "reorder", DIG_RIG_FAULT_REORDER, 1.0 },
    { "corrupt", DIG_RIG_FAULT_CORRUPT, 1.0 },
    { "delay", DIG_RIG_FAULT_DELAY, 10.0 },
    { "exception", DIG_RIG_FAULT_EXCEPTION, 1.0 },
    { "slow", DIG_RIG_FAULT_SLOW, 10.0 },
    { "far", DIG_RIG_FAULT_FAR, 0.0 },
    { "far-silent", DIG_RIG_FAULT_FAR_SILENT, 0.0 },
};

// The number at text, in (0, most]; NULL behind it when it is none.
static const char *read_number(const char *const text, const double most, double *const number)
{
    char *end = NULL;
    *number   = strtod(text, &end);
    return end != text && *number > 0.0 && *number <= most ? end : NULL;
}

// @T[:DURATION] to the end of the text.
static bool read_time(const char *const text, double *const begin_s, double *const end_s)
{
    char *end         = NULL;
    *begin_s          = strtod(text + 1, &end);
    double duration_s = INFINITY;
    bool   ok         = *text == '@' && end != text + 1 && *begin_s >= 0.0 && isfinite(*begin_s);
    if (ok && *end == ':') {
        const char *const number = end + 1;
        duration_s               = strtod(number, &end);
        ok                       = end != number && duration_s > 0.0;
    }
    *end_s = *begin_s + duration_s;
    return ok && *end == '\0';
}

enum dig_status dig_rig_fault_add(const char *const text, struct dig_rig_faults *const faults,
                                  struct dig_error *const error)
{
    if (faults->faults == DIG_RIG_FAULTS_MAX) {
        return dig_error_set(error, DIG_EINVAL, "--fault: more than %d", DIG_RIG_FAULTS_MAX);
    }
    const size_t length = strcspn(text, "=@");
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (strlen(kinds[i].name) != length || strncmp(text, kinds[i].name, length) != 0) {
            continue;
        }
        struct dig_rig_fault read = { .kind = kinds[i].kind, .amount = 1.0 };
        const char          *at   = text + length;
        if ((*at == '=') != (kinds[i].most > 0.0)) {
            break;
        }
        at = *at == '=' ? read_number(at + 1, kinds[i].most, &read.amount) : at;
        if (at != NULL && read_time(at, &read.begin_s, &read.end_s)) {
            faults->fault[faults->faults++] = read;
            return DIG_OK;
        }
    }
    return dig_error_set(
        error, DIG_EINVAL,
        "--fault %s: expected not-available, frozen, missing, "
        "out-of-range, stuck-pressures, stuck-angles, far, far-silent, or drop, duplicate, "
        "reorder, corrupt, exception with =SHARE, or delay, slow with =SECONDS; "
        "then @SECONDS[:DURATION]",
        text);
}

double dig_rig_fault_amount(const struct dig_rig_faults *const faults,
                            const enum dig_rig_fault_kind kind, const double time_s)
{
    for (size_t i = 0; i < faults->faults; i++) {
        const struct dig_rig_fault *const f = &faults->fault[i];
        if (f->kind == kind && time_s >= f->begin_s && time_s < f->end_s) {
            return f->amount;
        }
    }
    return 0.0;
}

void dig_rig_fault_spoil(const struct dig_rig_faults *const faults, const double time_s,
                         struct dig_sample *const sample)
{
    static const double far_Pa     = 60e6;
    static const double far_rad    = 12.0;
    static const double far_of_rig = 1e6; // m, N, Nm

    if (dig_rig_fault_amount(faults, DIG_RIG_FAULT_OUT_OF_RANGE, time_s) > 0.0) {
        for (int s = DIG_SIGNAL_BOOM_rad; s <= DIG_SIGNAL_BUCKET_ROD_Pa; s++) {
            sample->value[s] = s < DIG_SIGNAL_BOOM_HEAD_Pa ? far_rad : far_Pa;
        }
        for (int s = DIG_SIGNAL_PIN_X_m; s <= DIG_SIGNAL_SENSOR_MY_Nm; s++) {
            sample->value[s] = far_of_rig;
        }
    }
    if (dig_rig_fault_amount(faults, DIG_RIG_FAULT_NOT_AVAILABLE, time_s) > 0.0) {
        for (int s = 0; s < DIG_SIGNALS; s++) {
            sample->valid[s] = false;
            sample->value[s] = 0.0;
        }
    }
}

void dig_rig_fault_hold(const struct dig_rig_faults *const faults, const double time_s,
                        const struct dig_sample *const before, struct dig_sample *const sample)
{
    for (int s = DIG_SIGNAL_BOOM_rad; s <= DIG_SIGNAL_BUCKET_ROD_Pa; s++) {
        const enum dig_rig_fault_kind kind = s < DIG_SIGNAL_BOOM_HEAD_Pa
                                                 ? DIG_RIG_FAULT_STUCK_ANGLES
                                                 : DIG_RIG_FAULT_STUCK_PRESSURES;
        if (dig_rig_fault_amount(faults, kind, time_s) > 0.0) {
            sample->value[s] = before->value[s];
            sample->valid[s] = before->valid[s];
        }
    }
}
