// A design (closed_loop/design/design.h) for people and for programs. Keys: docs/formats/trace.md.

#ifndef DIG_CLOSED_LOOP_REPORT_DESIGN_REPORT_H
#define DIG_CLOSED_LOOP_REPORT_DESIGN_REPORT_H

#include "closed_loop/design/design.h"
#include "core/curve.h"

#include <stdio.h>

/// A table, the recommendation, and whether the simulation bears it out.
void dig_design_text(const struct dig_design *design, const struct dig_curve_set *set, FILE *to);

/// One JSON object and a line feed.
void dig_design_json(const struct dig_design *design, const struct dig_curve_set *set, FILE *to);

#endif // DIG_CLOSED_LOOP_REPORT_DESIGN_REPORT_H
