// A shift for people, as one page, and for programs, as a table of its digs.

#ifndef DIG_TOOLS_DIGREPORT_SHIFT_PAGE_H
#define DIG_TOOLS_DIGREPORT_SHIFT_PAGE_H

#include "core/model.h"
#include "tools/digreport/shift.h"

/// What a report says beside the shift. Texts are escaped.
struct digreport_shift_subject {
    const char             *title, *machine, *scene; // the last two "": not known
    const struct dig_model *model;                   // NULL: none was given
    size_t                  logs;
};

#define DIGREPORT_TIME 32

/// "2026-11-24T12:34:56Z"; nothing but zeros where there is no such time.
void digreport_time(int64_t time_us, char text[DIGREPORT_TIME]);

/// One sentence: digs, gravel, error, health. Of the messages it holds numbers alone.
void digreport_shift_sentence(const struct digreport_shift *shift, FILE *to);

/// The page: needs gnuplot. Fails as dig_plot_figure().
DIG_MUST_CHECK enum dig_status digreport_shift_html(const struct digreport_shift         *shift,
                                                    const struct digreport_shift_subject *subject,
                                                    FILE *to, struct dig_error *error);

/// Digs, gravels and troubles as one JSON object.
void digreport_shift_json(const struct digreport_shift *shift, FILE *to);

/// The digs as CSV, a line each; a number that is not known is left out.
void digreport_shift_csv(const struct digreport_shift *shift, FILE *to);

#endif // DIG_TOOLS_DIGREPORT_SHIFT_PAGE_H
