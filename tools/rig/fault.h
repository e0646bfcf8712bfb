// What goes wrong on a bus, on purpose and at a given time.
//
//   not-available@5:2   from 5 s on, for 2 s, every signal reads "not available"
//   nan@5:2             the same: neither bus has another way to say it
//   frozen@5:2          values and alive counter stand still
//   missing@5:2         no frame is sent, no request answered
//   out-of-range@5      from 5 s to the end: pressures of 60 MPa, angles of 12 rad, or the most the
//                       bus can say

#ifndef DIG_TOOLS_RIG_FAULT_H
#define DIG_TOOLS_RIG_FAULT_H

#include "core/error.h"
#include "core/sample.h"

#include <stdbool.h>
#include <stddef.h>

enum dig_rig_fault_kind {
    DIG_RIG_FAULT_NOT_AVAILABLE,
    DIG_RIG_FAULT_FROZEN,
    DIG_RIG_FAULT_MISSING,
    DIG_RIG_FAULT_OUT_OF_RANGE
};

struct dig_rig_fault {
    enum dig_rig_fault_kind kind;
    double begin_s, end_s; // machine time since the motion began; end INFINITY: never
};

/// Parses KIND@T[:DURATION] as above. DIG_EINVAL says what was expected.
DIG_MUST_CHECK enum dig_status dig_rig_fault_parse(const char *text, struct dig_rig_fault *fault,
                                                   struct dig_error *error);

/// True when a fault of that kind is on at time_s. A loop counts time on.
bool dig_rig_fault_is_on(size_t faults, const struct dig_rig_fault fault[],
                         enum dig_rig_fault_kind kind, double time_s);

/// Makes every signal of the sample not available, or out of range, as the faults at time_s say.
void dig_rig_fault_spoil(size_t faults, const struct dig_rig_fault fault[], double time_s,
                         struct dig_sample *sample);

#endif // DIG_TOOLS_RIG_FAULT_H
