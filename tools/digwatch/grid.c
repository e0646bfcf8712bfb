#include "tools/digwatch/grid.h"

#include "core/text.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static int at_most(const int value, const int most)
{
    return value < 0 ? 0 : value > most ? most : value;
}

void digwatch_grid_init(struct digwatch_grid *const grid, const int rows, const int columns,
                        const bool ascii)
{
    assert(grid != NULL);
    grid->rows    = at_most(rows, DIGWATCH_ROWS_MAX);
    grid->columns = at_most(columns, DIGWATCH_COLUMNS_MAX);
    grid->ascii   = ascii;
    for (int r = 0; r < grid->rows; r++) {
        for (int c = 0; c < grid->columns; c++) {
            grid->cell[r][c] = (struct digwatch_cell){ ' ', DIGWATCH_PLAIN };
        }
    }
}

void digwatch_grid_set(struct digwatch_grid *const grid, const int row, const int column,
                       const uint32_t glyph, const enum digwatch_ink ink)
{
    assert(grid != NULL);
    if (row >= 0 && row < grid->rows && column >= 0 && column < grid->columns) {
        grid->cell[row][column] = (struct digwatch_cell){ glyph, ink };
    }
}

// The character at *text, which moves behind it; '?' for what may not be one column wide.
static uint32_t next_glyph(const char **const text, const bool ascii)
{
    const unsigned char *const c = (const unsigned char *)*text;
    const size_t               n = dig_text_character(*text);
    *text += n == 0 ? 1 : n;
    if (n == 1) {
        return c[0] >= ' ' ? c[0] : '?';
    }
    const uint32_t glyph = n == 2 ? (c[0] & 0x1fU) << 6 | (c[1] & 0x3fU) : 0;
    const bool     latin = glyph >= 0xa0 && glyph < 0x300 && glyph != 0xad; // a soft hyphen
    const bool     greek = glyph >= 0x370 && glyph < 0x483;                 // and Cyrillic
    const bool     more  = glyph >= 0x48a && glyph < 0x530;
    return !ascii && (latin || greek || more) ? glyph : '?';
}

int digwatch_grid_put(struct digwatch_grid *const grid, const int row, int column,
                      const enum digwatch_ink ink, const char *const format, ...)
{
    assert(format != NULL);
    char    text[DIGWATCH_COLUMNS_MAX * 2];
    va_list args;
    va_start(args, format);
    // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is the line above
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    for (const char *c = text; *c != '\0'; column++) {
        digwatch_grid_set(grid, row, column, next_glyph(&c, grid->ascii), ink);
    }
    return column;
}

// How much of text fits into width columns, and where the next line begins.
static size_t line_of(const char *const text, const size_t width, size_t *const next)
{
    const size_t length = strlen(text);
    size_t       end    = length;
    if (length > width) {
        end = width;
        while (end > 0 && text[end] != ' ') {
            end--;
        }
        end = end == 0 ? width : end;
    }
    *next = end;
    while (text[*next] == ' ') {
        ++*next;
    }
    return end;
}

int digwatch_grid_wrap(struct digwatch_grid *const grid, int row, const int column, const int last,
                       const enum digwatch_ink ink, const char *text)
{
    assert(grid != NULL && text != NULL);
    const int width = grid->columns - column;
    while (width > 0 && *text != '\0' && row <= last) {
        size_t       next = 0;
        const size_t size = line_of(text, (size_t)width, &next);
        (void)digwatch_grid_put(grid, row++, column, ink, "%.*s", (int)size, text);
        text += next;
    }
    return row;
}
