#include "tools/digwatch/screen.h"

#include "tools/digwatch/chart.h"
#include "tools/digwatch/trouble.h"

#include <assert.h>
#include <math.h>
#include <string.h>
#include <time.h>

#define HEAD_ROWS    2
#define VALUE_ROWS   7
#define TROUBLE_ROWS 5
#define BAR_COLUMNS  22
#define VALUE_COLUMN 10

static int clock_column(const struct digwatch_grid *const grid)
{
    return grid->columns - 31;
}

static void put_clock(const struct digwatch_model *const model, struct digwatch_grid *const grid)
{
    const time_t seconds = (time_t)(model->time_us / 1000000);
    struct tm    utc;
    char         text[32] = "";
    if (model->messages == 0 || seconds < 0 || gmtime_r(&seconds, &utc) == NULL ||
        strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &utc) == 0) {
        text[0] = '\0'; // of no time that people have
    }
    (void)digwatch_grid_put(grid, 0, clock_column(grid), DIGWATCH_PLAIN, "%.23s", text);
    (void)digwatch_grid_put(grid, 0, grid->columns - 7, DIGWATCH_FAINT, "q: quit");
}

static void put_head(const struct digwatch_model *const model,
                     const struct digwatch_view *const view, struct digwatch_grid *const grid)
{
    const int column = digwatch_grid_put(grid, 0, 0, DIGWATCH_TITLE, "digwatch ");
    (void)digwatch_grid_put(grid, 0, column, DIGWATCH_PLAIN, "%.*s%s",
                            clock_column(grid) - column - (view->ended ? 13 : 1), view->source,
                            view->ended ? ", at its end" : "");
    put_clock(model, grid);
    if (model->any_health) {
        const struct digwatch_health *const h = &model->health;
        (void)digwatch_grid_put(
            grid, 1, 0, DIGWATCH_PLAIN, "%s, %.*s; %d dig%s (%d aborted), %d identified", h->state,
            grid->columns - 45, h->input, h->digs, h->digs == 1 ? "" : "s", h->aborted, h->matches);
    }
}

static void put_chart_title(const double unit_Nm, struct digwatch_grid *const grid, const int row)
{
    int column =
        digwatch_grid_put(grid, row, 0, DIGWATCH_TITLE, "Moment about the bucket pin, %s  ",
                          unit_Nm > 1.0 ? "kNm" : "Nm");
    column = digwatch_grid_put(grid, row, column, DIGWATCH_MEASURED, "%s measured  ",
                               grid->ascii ? "#" : "--");
    column = digwatch_grid_put(grid, row, column, DIGWATCH_PREDICTED, "%s predicted  ",
                               grid->ascii ? "-" : "..");
    if (!grid->ascii) {
        digwatch_grid_set(grid, row, column++, 0x2591, DIGWATCH_FAINT);
    }
    (void)digwatch_grid_put(grid, row, column, DIGWATCH_FAINT, "%s 90 %% of digs",
                            grid->ascii ? "." : "");
}

static void put_name(struct digwatch_grid *const grid, const int row, const char *const name)
{
    (void)digwatch_grid_put(grid, row, 0, DIGWATCH_TITLE, "%s", name);
}

static void put_phase(const struct digwatch_estimate *const e, struct digwatch_grid *const grid,
                      const int row)
{
    static const char *const phases[]  = { "in the air", "contact", "dig", "exit" };
    static const char *const motions[] = { "", ", penetration", ", drag", ", curl", ", lift" };
    put_name(grid, row, "Phase");
    const bool known = e->phase >= 0 && e->phase <= 3 && e->motion >= 0 && e->motion <= 4;
    (void)digwatch_grid_put(grid, row, VALUE_COLUMN, DIGWATCH_PLAIN, "%s%s",
                            known ? phases[e->phase] : "?", known ? motions[e->motion] : "");
    if (e->trajectory[0] == '\0') {
        return;
    }
    const int column =
        digwatch_grid_put(grid, row, VALUE_COLUMN + 20, DIGWATCH_PLAIN, "%-10.20s ", e->trajectory);
    if (!isfinite(e->progress)) {
        return;
    }
    for (int i = 0; i < BAR_COLUMNS; i++) {
        const bool done = i < (int)lround(e->progress * BAR_COLUMNS);
        digwatch_grid_set(grid, row, column + i, done ? '=' : '-',
                          done ? DIGWATCH_PLAIN : DIGWATCH_FAINT);
    }
    (void)digwatch_grid_put(grid, row, column + BAR_COLUMNS, DIGWATCH_PLAIN, " %.0f %%",
                            100.0 * e->progress);
}

static void put_moment(const struct digwatch_estimate *const e, const double unit_Nm,
                       struct digwatch_grid *const grid, const int row)
{
    const char *const unit = unit_Nm > 1.0 ? "kNm" : "Nm";
    put_name(grid, row, "Moment");
    put_name(grid, row + 1, "Residual");
    if (!e->moment_valid) {
        (void)digwatch_grid_put(grid, row, VALUE_COLUMN, DIGWATCH_BAD, "not measured");
        return;
    }
    const int column =
        digwatch_grid_put(grid, row, VALUE_COLUMN, DIGWATCH_MEASURED, "%.2f +- %.2f %s",
                          e->moment_Nm / unit_Nm, e->sigma_Nm / unit_Nm, unit);
    if (!isfinite(e->predicted_Nm)) {
        (void)digwatch_grid_put(grid, row + 1, VALUE_COLUMN, DIGWATCH_FAINT,
                                "nothing is predicted");
        return;
    }
    const double off = e->moment_Nm - e->predicted_Nm;
    (void)digwatch_grid_put(
        grid, row, column, DIGWATCH_PREDICTED, ", predicted %.2f (%.2f to %.2f)",
        e->predicted_Nm / unit_Nm,
        (e->predicted_Nm - DIGWATCH_BAND_SIGMAS * e->predicted_sigma_Nm) / unit_Nm,
        (e->predicted_Nm + DIGWATCH_BAND_SIGMAS * e->predicted_sigma_Nm) / unit_Nm);
    (void)digwatch_grid_put(grid, row + 1, VALUE_COLUMN, DIGWATCH_PLAIN, "%+.2f %s, %+.1f sigma",
                            off / unit_Nm, unit, off / e->predicted_sigma_Nm);
}

static void put_errors(const struct digwatch_model *const model, struct digwatch_grid *const grid,
                       const int row)
{
    int column = VALUE_COLUMN + 27;
    if (model->now.whole2 > 0.0) {
        column = digwatch_grid_put(grid, row, column, DIGWATCH_PLAIN, "this dig %.0f %% off  ",
                                   100.0 * digwatch_error(&model->now));
    }
    if (model->before.whole2 > 0.0) {
        (void)digwatch_grid_put(grid, row, column, DIGWATCH_PLAIN, "the dig before %.0f %%",
                                100.0 * digwatch_error(&model->before));
    }
}

static void put_prediction(const struct digwatch_model *const model, const double unit_Nm,
                           struct digwatch_grid *const grid, const int row)
{
    const struct digwatch_prediction *const p = &model->prediction;
    put_name(grid, row, "Predicted");
    if (!digwatch_model_prediction_holds(model)) {
        (void)digwatch_grid_put(grid, row, VALUE_COLUMN, DIGWATCH_FAINT, "nothing%s%s",
                                p->valid || p->reason[0] != '\0' ? ": " : "",
                                p->valid ? "the last prediction is too old" : p->reason);
        return;
    }
    (void)digwatch_grid_put(grid, row, VALUE_COLUMN, DIGWATCH_PREDICTED,
                            "%s: peak %.1f +- %.1f %s, energy %.4g +- %.2g %s%s",
                            p->curve.trajectory, p->curve.peak_Nm / unit_Nm,
                            p->curve.peak_sigma_Nm / unit_Nm, unit_Nm > 1.0 ? "kNm" : "Nm",
                            p->curve.energy_J / unit_Nm, p->curve.energy_sigma_J / unit_Nm,
                            unit_Nm > 1.0 ? "kJ" : "J", p->outside ? " (nearest gravel)" : "");
}

static void put_gravel(const struct digwatch_model *const model, struct digwatch_grid *const grid,
                       const int row)
{
    static const char *const               name[DIG_AXES] = { "friction", "rolling", "density" };
    const struct dig_matched_gravel *const m              = &model->match;
    put_name(grid, row, "Gravel");
    if (!digwatch_model_match_holds(model)) {
        (void)digwatch_grid_put(grid, row, VALUE_COLUMN, DIGWATCH_FAINT,
                                "not known: dig a simple dig");
        return;
    }
    put_name(grid, row + 1, "  90 %");
    for (int a = 0; a < DIG_AXES; a++) {
        const int column = VALUE_COLUMN + 18 * a;
        const int digits = a == DIG_AXIS_DENSITY_kgpm3 ? 0 : 2;
        (void)digwatch_grid_put(grid, row, column, DIGWATCH_PLAIN, "%s %.*f%s", name[a], digits,
                                m->gravel.value[a], digits == 0 ? " kg/m3" : "");
        (void)digwatch_grid_put(grid, row + 1, column, DIGWATCH_PLAIN, "%.*f to %.*f", digits,
                                m->low.value[a], digits, m->high.value[a]);
    }
    const int column = VALUE_COLUMN + 18 * DIG_AXES + 4;
    (void)digwatch_grid_put(grid, row, column, DIGWATCH_PLAIN, "%d dig%s%s", m->digs,
                            m->digs == 1 ? "" : "s", m->going_on ? ", early" : "");
    (void)digwatch_grid_put(grid, row + 1, column, DIGWATCH_PLAIN, "%s",
                            m->forces ? "with force" : "moment alone");
    if (m->untold[0] != '\0') {
        (void)digwatch_grid_put(grid, row + 2, VALUE_COLUMN, DIGWATCH_PLAIN,
                                "a family resists alike; not told: %s", m->untold_words);
    }
}

static void put_troubles(const struct digwatch_model *const model,
                         const struct digwatch_view *const view, struct digwatch_grid *const grid,
                         int row)
{
    struct digwatch_trouble trouble[DIGWATCH_TROUBLES_MAX];
    const size_t            n = digwatch_troubles(model, view->silent_s, trouble);
    put_name(grid, row, "Health");
    if (view->damage[0] != '\0') {
        row =
            digwatch_grid_wrap(grid, row, VALUE_COLUMN, grid->rows - 1, DIGWATCH_BAD, view->damage);
    } else if (n == 0) {
        (void)digwatch_grid_put(grid, row, VALUE_COLUMN, DIGWATCH_GOOD, "good: nothing is wrong");
    }
    for (size_t i = 0; i < n && row < grid->rows; i++) {
        row = digwatch_grid_wrap(grid, row, VALUE_COLUMN, grid->rows - 1, DIGWATCH_BAD,
                                 trouble[i].what);
        row = digwatch_grid_wrap(grid, row, VALUE_COLUMN + 2, grid->rows - 1, DIGWATCH_PLAIN,
                                 trouble[i].todo);
    }
}

void digwatch_screen(const struct digwatch_model *const model,
                     const struct digwatch_view *const view, struct digwatch_grid *const grid)
{
    assert(model != NULL && view != NULL && grid != NULL);
    if (grid->rows < DIGWATCH_ROWS_LEAST || grid->columns < DIGWATCH_COLUMNS_LEAST) {
        (void)digwatch_grid_put(grid, 0, 0, DIGWATCH_PLAIN,
                                "%d x %d is too small: %d x %d at least. q: quit", grid->columns,
                                grid->rows, DIGWATCH_COLUMNS_LEAST, DIGWATCH_ROWS_LEAST);
        return;
    }
    // A quarter of what a taller window has beyond 80 by 24 is for more troubles.
    const int    more   = grid->rows > 24 ? (grid->rows - 24) / 4 : 0;
    const int    values = grid->rows - TROUBLE_ROWS - more - VALUE_ROWS;
    const int    chart  = HEAD_ROWS + 1;
    const double unit   = digwatch_chart(model, grid, chart, values - chart);
    put_head(model, view, grid);
    put_chart_title(unit, grid, HEAD_ROWS);
    if (model->any_estimate) {
        put_phase(&model->estimate, grid, values);
        put_moment(&model->estimate, unit, grid, values + 1);
    }
    put_errors(model, grid, values + 2);
    put_prediction(model, unit, grid, values + 3);
    put_gravel(model, grid, values + 4);
    put_troubles(model, view, grid, values + VALUE_ROWS);
}
