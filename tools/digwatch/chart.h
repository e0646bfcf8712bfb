// The moment of the last seconds, scrolling: measured, predicted, and the band of 90 % of digs. In
// braille, 2 by 4 dots a cell; in ASCII one mark a cell.

#ifndef DIG_TOOLS_DIGWATCH_CHART_H
#define DIG_TOOLS_DIGWATCH_CHART_H

#include "tools/digwatch/grid.h"
#include "tools/digwatch/model.h"

/// Half the width of the band that holds 90 % of digs, in sigma.
#define DIGWATCH_BAND_SIGMAS 1.645

/// Draws into rows [top, top + rows) over the whole width, the newest at the right edge, a scale at
/// the left and the time below; two slots of time a column. Returns the unit of its scale in N·m:
/// 1, or 1000 where the moments are large.
double digwatch_chart(const struct digwatch_model *model, struct digwatch_grid *grid, int top,
                      int rows);

#endif // DIG_TOOLS_DIGWATCH_CHART_H
