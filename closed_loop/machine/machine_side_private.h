// Inside of the machine side, for closed_loop/machine/.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_SIDE_PRIVATE_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_SIDE_PRIVATE_H

#include "closed_loop/machine/machine_side.h"
#include "closed_loop/recordings/machine_dig.h"

struct dig_machine_side {
    struct dig_machine          machine;
    const struct dig_curve_set *set;
    size_t                      digs;
    struct dig_machine_dig      dig[DIG_MEASURED_MAX];
    bool                        used[DIG_MEASURED_MAX];           // to trace in
    double                      own_payload_kg[DIG_MEASURED_MAX]; // beyond the digs' common one
};

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_SIDE_PRIVATE_H
