#include "tools/digwatch/chart.h"

#include <assert.h>
#include <math.h>

#define SCALE_COLUMNS 9   // "-1234.5 |"
#define LEAST_Nm      1.0 // the scale spans at least as much

// A kind of dots: the bits of each cell, as braille numbers them.
struct cells {
    uint8_t bits[DIGWATCH_ROWS_MAX][DIGWATCH_COLUMNS_MAX];
};

struct dots {
    int          wide, high; // in dots, 2 by 4 a cell
    struct cells measured, predicted, band;
};

struct range {
    double low, high;
};

static void include(struct range *const range, const double value)
{
    if (isfinite(value)) {
        range->low  = fmin(range->low, value);
        range->high = fmax(range->high, value);
    }
}

// What is shown, to the next 1, 2 or 5 of its size: the scale does not flicker.
static struct range find_range(const struct digwatch_model *const model, const int wide)
{
    struct range range = { 0.0, LEAST_Nm };
    for (int back = 0; back < wide; back++) {
        const struct digwatch_slot slot = digwatch_model_slot(model, back);
        include(&range, slot.measured_Nm);
        include(&range, slot.predicted_Nm + DIGWATCH_BAND_SIGMAS * slot.sigma_Nm);
        include(&range, slot.predicted_Nm - DIGWATCH_BAND_SIGMAS * slot.sigma_Nm);
    }
    const double size = range.high - range.low;
    const double ten  = pow(10.0, floor(log10(size)) - 1.0);
    const double part = size / ten / 10.0; // 1 to 10
    const double step = ten * (part <= 1.0 ? 1.0 : part <= 2.0 ? 2.0 : part <= 5.0 ? 5.0 : 10.0);
    return (struct range){ step * floor(range.low / step), step * ceil(range.high / step) };
}

// The row of dots of a value, which may lie outside.
static int row_of(const struct range *const range, const int high, const double value_Nm)
{
    const double place = (range->high - value_Nm) / (range->high - range->low) * (high - 1);
    return (int)lround(fmin(fmax(place, -1.0), high));
}

// The dots of column x between two rows.
static void mark(struct cells *const kind, const int high, const int x, const int from,
                 const int to)
{
    static const uint8_t bit[4][2] = {
        { 0x01, 0x08 }, { 0x02, 0x10 }, { 0x04, 0x20 }, { 0x40, 0x80 }
    };
    for (int y = from < to ? from : to; y <= (from > to ? from : to); y++) {
        if (y >= 0 && y < high) {
            kind->bits[y / 4][x / 2] |= bit[y % 4][x % 2];
        }
    }
}

static void mark_all(const struct digwatch_model *const model, const struct range *const range,
                     struct dots *const dots)
{
    int before = -1; // the measured dot to the left; -1: none
    for (int x = 0; x < dots->wide; x++) {
        const struct digwatch_slot slot = digwatch_model_slot(model, dots->wide - 1 - x);
        const double               half = DIGWATCH_BAND_SIGMAS * slot.sigma_Nm;
        if (isfinite(slot.measured_Nm)) {
            const int y = row_of(range, dots->high, slot.measured_Nm);
            mark(&dots->measured, dots->high, x, before >= 0 ? before : y, y);
            before = y;
        } else {
            before = -1;
        }
        if (isfinite(slot.predicted_Nm) && isfinite(half)) {
            const int y = row_of(range, dots->high, slot.predicted_Nm);
            mark(&dots->predicted, dots->high, x, y, y);
            mark(&dots->band, dots->high, x, row_of(range, dots->high, slot.predicted_Nm + half),
                 row_of(range, dots->high, slot.predicted_Nm - half));
        }
    }
}

static void put_cell(struct digwatch_grid *const grid, const struct dots *const dots, const int top,
                     const int row, const int column)
{
    const unsigned measured  = dots->measured.bits[row][column];
    const unsigned predicted = dots->predicted.bits[row][column] & 0x47U; // every other dot: dotted
    const bool     band      = dots->band.bits[row][column] != 0;
    const enum digwatch_ink ink   = measured != 0    ? DIGWATCH_MEASURED
                                    : predicted != 0 ? DIGWATCH_PREDICTED
                                                     : DIGWATCH_FAINT;
    uint32_t                glyph = ' ';
    if (grid->ascii) {
        glyph = measured != 0 ? '#' : predicted != 0 ? '-' : band ? '.' : ' ';
    } else if ((measured | predicted) != 0) {
        glyph = 0x2800U | measured | predicted;
    } else if (band) {
        glyph = 0x2591; // light shade
    }
    digwatch_grid_set(grid, top + row, SCALE_COLUMNS + column, glyph, ink);
}

static void put_scale(struct digwatch_grid *const grid, const struct range *const range,
                      const double unit_Nm, const int top, const int rows)
{
    for (int row = 0; row < rows; row++) {
        digwatch_grid_set(grid, top + row, SCALE_COLUMNS - 1, '|', DIGWATCH_FAINT);
    }
    const int zero = row_of(range, 4 * rows, 0.0) / 4;
    (void)digwatch_grid_put(grid, top + zero, 0, DIGWATCH_PLAIN, "%7d", 0);
    (void)digwatch_grid_put(grid, top, 0, DIGWATCH_PLAIN, "%7.4g", range->high / unit_Nm);
    (void)digwatch_grid_put(grid, top + rows - 1, 0, DIGWATCH_PLAIN, "%7.4g", range->low / unit_Nm);
}

double digwatch_chart(const struct digwatch_model *const model, struct digwatch_grid *const grid,
                      const int top, const int rows)
{
    assert(model != NULL && grid != NULL && top >= 0 && rows >= 2 && top + rows < grid->rows);
    const int          columns = grid->columns - SCALE_COLUMNS;
    struct dots        dots    = { .wide = 2 * columns, .high = 4 * (rows - 1) };
    const struct range range   = find_range(model, dots.wide);
    const double       unit    = fmax(fabs(range.low), fabs(range.high)) < 1000.0 ? 1.0 : 1000.0;
    mark_all(model, &range, &dots);
    for (int row = 0; row < rows - 1; row++) {
        for (int column = 0; column < columns; column++) {
            put_cell(grid, &dots, top, row, column);
        }
    }
    put_scale(grid, &range, unit, top, rows - 1);
    (void)digwatch_grid_put(grid, top + rows - 1, SCALE_COLUMNS, DIGWATCH_FAINT,
                            "%.1f s before now", (double)dots.wide * 1e-9 * DIGWATCH_SLOT_ns);
    (void)digwatch_grid_put(grid, top + rows - 1, grid->columns - 3, DIGWATCH_FAINT, "now");
    return unit;
}
