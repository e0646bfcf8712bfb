#include "tools/rig/fault.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char             *name;
    enum dig_rig_fault_kind kind;
} kinds[] = {
    { "not-available", DIG_RIG_FAULT_NOT_AVAILABLE },
    { "nan", DIG_RIG_FAULT_NOT_AVAILABLE },
    { "frozen", DIG_RIG_FAULT_FROZEN },
    { "missing", DIG_RIG_FAULT_MISSING },
    { "out-of-range", DIG_RIG_FAULT_OUT_OF_RANGE },
};

enum dig_status dig_rig_fault_parse(const char *const text, struct dig_rig_fault *const fault,
                                    struct dig_error *const error)
{
    const char *const at = strchr(text, '@');
    for (size_t i = 0; at != NULL && i < sizeof kinds / sizeof kinds[0]; i++) {
        const size_t length = (size_t)(at - text);
        if (strlen(kinds[i].name) != length || strncmp(text, kinds[i].name, length) != 0) {
            continue;
        }
        char        *end        = NULL;
        const double begin_s    = strtod(at + 1, &end);
        double       duration_s = INFINITY;
        bool         ok         = end != at + 1 && begin_s >= 0.0 && isfinite(begin_s);
        if (ok && *end == ':') {
            const char *const number = end + 1;
            duration_s               = strtod(number, &end);
            ok                       = end != number && duration_s > 0.0;
        }
        if (ok && *end == '\0') {
            *fault = (struct dig_rig_fault){ kinds[i].kind, begin_s, begin_s + duration_s };
            return DIG_OK;
        }
    }
    return dig_error_set(error, DIG_EINVAL,
                         "fault: \"%s\", expected not-available, nan, frozen, missing or "
                         "out-of-range, then @SECONDS[:DURATION]",
                         text);
}

bool dig_rig_fault_is_on(const size_t faults, const struct dig_rig_fault fault[],
                         const enum dig_rig_fault_kind kind, const double time_s)
{
    for (size_t i = 0; i < faults; i++) {
        if (fault[i].kind == kind && time_s >= fault[i].begin_s && time_s < fault[i].end_s) {
            return true;
        }
    }
    return false;
}

void dig_rig_fault_spoil(const size_t faults, const struct dig_rig_fault fault[],
                         const double time_s, struct dig_sample *const sample)
{
    static const double far_Pa  = 60e6;
    static const double far_rad = 12.0;

    if (dig_rig_fault_is_on(faults, fault, DIG_RIG_FAULT_OUT_OF_RANGE, time_s)) {
        for (int s = DIG_SIGNAL_BOOM_rad; s <= DIG_SIGNAL_BUCKET_ROD_Pa; s++) {
            sample->value[s] = s < DIG_SIGNAL_BOOM_HEAD_Pa ? far_rad : far_Pa;
        }
    }
    if (dig_rig_fault_is_on(faults, fault, DIG_RIG_FAULT_NOT_AVAILABLE, time_s)) {
        for (int s = 0; s < DIG_SIGNALS; s++) {
            sample->valid[s] = false;
            sample->value[s] = 0.0;
        }
    }
}
