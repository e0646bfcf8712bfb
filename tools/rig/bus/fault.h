// Faults injected into a bus, each at a given time.
//
//   not-available@5:2   from 5 s on, for 2 s, every signal reads "not available"
//   frozen@5:2          values and alive counter stand still
//   missing@5:2         no frame is sent, no request answered
//   out-of-range@5      from 5 s to the end: pressures of 60 MPa, angles of 12 rad, of a force
//                       sensor's rig 1e6 of all else, or the most the bus can say
//   stuck-pressures@5:2 the pressures stand, angles and alive counter go on
//   stuck-angles@5:2    the angles stand, the rest goes on
//   drop=0.1@5:2        that share of frames is lost, of requests is not answered
//   duplicate=0.1@5:2   CAN: that share of frames is sent twice
//   reorder=0.1@5:2     CAN: that share of frames is sent after the next of its kind
//   corrupt=0.1@5:2     that share of frames has one bit flipped; RTU: rubbish goes before that
//                       share of answers; TCP: they are answers to another request
//   delay=0.05@5:2      CAN: frames are held back and sent in bursts, every so many seconds
//   exception=0.1@5:2   Modbus: that share of requests is answered with exception 6, busy
//   slow=0.1@5:2        Modbus: every answer comes that many (real) seconds late
//   far@5:2             Modbus: requests of registers from 1000 on get exception 6
//   far-silent@5:2      Modbus: they get no answer

#ifndef DIG_TOOLS_RIG_BUS_FAULT_H
#define DIG_TOOLS_RIG_BUS_FAULT_H

#include "core/error.h"
#include "core/sample.h"

#include <stddef.h>

enum dig_rig_fault_kind {
    DIG_RIG_FAULT_NOT_AVAILABLE,
    DIG_RIG_FAULT_FROZEN,
    DIG_RIG_FAULT_MISSING,
    DIG_RIG_FAULT_OUT_OF_RANGE,
    DIG_RIG_FAULT_STUCK_PRESSURES,
    DIG_RIG_FAULT_STUCK_ANGLES,
    DIG_RIG_FAULT_DROP,
    DIG_RIG_FAULT_DUPLICATE,
    DIG_RIG_FAULT_REORDER,
    DIG_RIG_FAULT_CORRUPT,
    DIG_RIG_FAULT_DELAY,
    DIG_RIG_FAULT_EXCEPTION,
    DIG_RIG_FAULT_SLOW,
    DIG_RIG_FAULT_FAR,
    DIG_RIG_FAULT_FAR_SILENT
};

struct dig_rig_fault {
    enum dig_rig_fault_kind kind;
    double begin_s, end_s; // machine time since the motion began; end INFINITY: never
    double amount;         // a share, or seconds; 1 for kinds that have none
};

#define DIG_RIG_FAULTS_MAX 16

/// Zeroed: none.
struct dig_rig_faults {
    size_t               faults;
    struct dig_rig_fault fault[DIG_RIG_FAULTS_MAX];
};

/// Adds KIND[=AMOUNT]@T[:DURATION] as above. DIG_EINVAL says what was expected.
DIG_MUST_CHECK enum dig_status dig_rig_fault_add(const char *text, struct dig_rig_faults *faults,
                                                 struct dig_error *error);

/// The amount of the fault of that kind that is on at time_s; 0: none is. A loop counts time on.
double dig_rig_fault_amount(const struct dig_rig_faults *faults, enum dig_rig_fault_kind kind,
                            double time_s);

/// Makes every signal of the sample not available, or out of range, as the faults at time_s say.
void dig_rig_fault_spoil(const struct dig_rig_faults *faults, double time_s,
                         struct dig_sample *sample);

/// Makes what is stuck at time_s stand as it stood before.
void dig_rig_fault_hold(const struct dig_rig_faults *faults, double time_s,
                        const struct dig_sample *before, struct dig_sample *sample);

#endif // DIG_TOOLS_RIG_BUS_FAULT_H
