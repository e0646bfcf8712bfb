// The whole screen: what is known, laid out for 80 by 24 and more.

#ifndef DIG_TOOLS_DIGWATCH_SCREEN_H
#define DIG_TOOLS_DIGWATCH_SCREEN_H

#include "tools/digwatch/grid.h"
#include "tools/digwatch/model.h"

/// The least that is drawn; a smaller grid asks for more.
#define DIGWATCH_ROWS_LEAST    18
#define DIGWATCH_COLUMNS_LEAST 80

struct digwatch_view {
    const char *source;   // what is watched, for people
    double      silent_s; // since the last message
    bool        ended;    // a log, at its end
    const char *damage;   // of the log; "": none
};

/// Draws into a grid that was just made.
void digwatch_screen(const struct digwatch_model *model, const struct digwatch_view *view,
                     struct digwatch_grid *grid);

#endif // DIG_TOOLS_DIGWATCH_SCREEN_H
