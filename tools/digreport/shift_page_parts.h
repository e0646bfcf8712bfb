// The parts of a shift's page.

#ifndef DIG_TOOLS_DIGREPORT_SHIFT_PAGE_PARTS_H
#define DIG_TOOLS_DIGREPORT_SHIFT_PAGE_PARTS_H

#include "tools/digreport/shift_page.h"

#include <stdbool.h>

struct digreport_page {
    const struct digreport_shift         *shift;
    const struct digreport_shift_subject *subject;
    double                                unit_us; // of the time axis
    char                                  x_label[64];
};

/// Where a time stands on the time axis.
double digreport_page_time(const struct digreport_page *page, int64_t time_us);

/// The time of the day, the first cell of a row.
void digreport_page_time_cell(FILE *to, int64_t time_us);

/// True where a value is finite: a picture of none is left out.
bool digreport_page_any(size_t n, const double value[]);

/// Number, peak, energy and error of the digs over time, and a table of them. DIG_ENOMEM, or as
/// dig_plot_figure().
void digreport_page_digs(const struct digreport_page *page, FILE *to, struct dig_conditions *c);

/// The gravel over time, and a table of what was identified. Fails likewise.
void digreport_page_gravels(const struct digreport_page *page, FILE *to, struct dig_conditions *c);

#endif // DIG_TOOLS_DIGREPORT_SHIFT_PAGE_PARTS_H
