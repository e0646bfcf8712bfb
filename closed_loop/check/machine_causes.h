// Errors of a machine's file or sensors as the equations of free air show them, with their sigma:
// for each joint the zero of its angle, factor and offset of its pressures, and the weight of its
// link; for all the delay of the pressures.
//
// All columns of the equations (machine_fit.h) always have a prior as wide as their tolerance;
// one that is named a cause has a wide one. Causes join while the evidence grows by more than
// log(causes / false alarm), as effects do (machine_fit.h).

#ifndef DIG_CLOSED_LOOP_CHECK_MACHINE_CAUSES_H
#define DIG_CLOSED_LOOP_CHECK_MACHINE_CAUSES_H

#include "closed_loop/air/machine_air.h"
#include "closed_loop/machine_digs/machine_dig.h"
#include "core/machine.h"
#include "core/status.h"

#include <stdbool.h>
#include <stddef.h>

enum dig_cause_kind {
    DIG_CAUSE_ZERO,   // rad that the angle reads too much
    DIG_CAUSE_FACTOR, // the chambers that carry the load read 1 + this times the pressure, in the
                      // mean
    DIG_CAUSE_OFFSET, // Pa that the drive reads too much, at its head side
    DIG_CAUSE_WEIGHT, // kg
    DIG_CAUSE_KINDS
};

/// Of each kind one a joint, [DIG_JOINTS * kind + joint], then the delay, s.
#define DIG_CAUSE_DELAY ((size_t)DIG_CAUSE_KINDS * DIG_JOINTS)
#define DIG_CAUSES      (DIG_CAUSE_DELAY + 1)

struct dig_cause {
    double value, sigma; // with a wide prior, beside the causes named
    double tolerance;    // 1 sigma of what it may be without being wrong
    bool   named;
    int    or_cause; // another that would do in its place; -1: none
};

struct dig_causes {
    struct dig_cause cause[DIG_CAUSES];
    double           rest[DIG_JOINTS];       // rms of the residual over sigma; NaN: no row
    double           rest_N[DIG_JOINTS];     // rms of the same at the rod
    double           rest_plain[DIG_JOINTS]; // and without any cause
};

/// Fits. air: made of one recording; the causes named are in *correction after it.
/// moves: joints of which causes are asked for. A second or two. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_causes_find(struct dig_air *air, const bool moves[DIG_JOINTS],
                                               struct dig_causes    *causes,
                                               struct dig_correction correction[]);

#endif // DIG_CLOSED_LOOP_CHECK_MACHINE_CAUSES_H
