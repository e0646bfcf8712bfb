// A screen as cells, before a terminal shows it. What is put into it never holds a control
// character, and each character takes one column: text from messages goes through here.

#ifndef DIG_TOOLS_DIGWATCH_GRID_H
#define DIG_TOOLS_DIGWATCH_GRID_H

#include <stdbool.h>
#include <stdint.h>

#define DIGWATCH_ROWS_MAX    100
#define DIGWATCH_COLUMNS_MAX 320

enum digwatch_ink {
    DIGWATCH_PLAIN,
    DIGWATCH_TITLE,
    DIGWATCH_FAINT,
    DIGWATCH_MEASURED,
    DIGWATCH_PREDICTED,
    DIGWATCH_GOOD,
    DIGWATCH_BAD,
    DIGWATCH_INKS
};

struct digwatch_cell {
    uint32_t          glyph; // a code point
    enum digwatch_ink ink;
};

struct digwatch_grid {
    int                  rows, columns;
    bool                 ascii; // nothing but ASCII is put
    struct digwatch_cell cell[DIGWATCH_ROWS_MAX][DIGWATCH_COLUMNS_MAX];
};

/// Blanks; sizes beyond the most are cut to it.
void digwatch_grid_init(struct digwatch_grid *grid, int rows, int columns, bool ascii);

/// One cell; outside the grid nothing happens.
void digwatch_grid_set(struct digwatch_grid *grid, int row, int column, uint32_t glyph,
                       enum digwatch_ink ink);

/// Puts text (UTF-8) into a row from column on, cut at the edge; returns the column behind it.
/// Latin, Greek and Cyrillic letters stay; all else that is not printable ASCII becomes '?', as its
/// width is the terminal's to say.
__attribute__((format(printf, 5, 6))) int digwatch_grid_put(struct digwatch_grid *grid, int row,
                                                            int column, enum digwatch_ink ink,
                                                            const char *format, ...);

/// The same, broken at blanks into as many rows as it takes, up to `last`; returns the row behind.
int digwatch_grid_wrap(struct digwatch_grid *grid, int row, int column, int last,
                       enum digwatch_ink ink, const char *text);

#endif // DIG_TOOLS_DIGWATCH_GRID_H
