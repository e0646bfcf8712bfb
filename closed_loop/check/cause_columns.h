// Maps the columns of the equations of free air to the causes that the check of a machine file
// names.

#ifndef DIG_CLOSED_LOOP_CHECK_CAUSE_COLUMNS_H
#define DIG_CLOSED_LOOP_CHECK_CAUSE_COLUMNS_H

#include "closed_loop/check/machine_causes.h"
#include "closed_loop/machine/machine_lines.h"

/// The cause that a column belongs to (-1: none), and 1 sigma of its prior: as allowed (tolerance)
/// and as a cause (wrong), in the unit of the column's scale (docs/numerics/machine_side.md).
struct dig_cause_column {
    int    cause;
    double tolerance, wrong;
};

struct dig_cause_column dig_cause_column_of(const struct dig_machine      *machine,
                                            const struct dig_lines_column *column);

#endif // DIG_CLOSED_LOOP_CHECK_CAUSE_COLUMNS_H
