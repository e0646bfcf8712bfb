#include "closed_loop/report/plot.h"

#include "closed_loop/report/html.h"
#include "core/process.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

// In pixels: the whole picture, and what stands around gnuplot's.
enum { WIDTH = 480, LINE = 20, LEFT = 22, SAMPLE = 28, LETTER = 8, GAP = 16 };

static void put_data(FILE *const to, const size_t index, const struct dig_plot_series *const s)
{
    (void)fprintf(to, "$s%zu << EOD\n", index);
    for (size_t i = 0; i < s->n; i++) {
        const double high = s->style == DIG_PLOT_BAND ? s->high[i] : 0.0;
        if (isfinite(s->x[i]) && isfinite(s->y[i]) && isfinite(high)) {
            (void)fprintf(to, "%.6g %.6g %.6g\n", s->x[i], s->y[i], high);
        } else {
            (void)fprintf(to, "\n");
        }
    }
    (void)fprintf(to, "EOD\n");
}

// Up to ten gnuplot would mark halves and fifths.
static bool marks_each(const struct dig_plot *const plot)
{
    double most = 0.0;
    for (size_t i = 0; i < plot->series; i++) {
        for (size_t k = 0; k < plot->s[i].n; k++) {
            most = isfinite(plot->s[i].y[k]) ? fmax(most, plot->s[i].y[k]) : most;
        }
    }
    return plot->counts && most <= 10.0;
}

// Nothing of this is a caller's text.
static void put_script(FILE *const to, const struct dig_plot *const plot, const unsigned height)
{
    static const char *const how[] = {
        [DIG_PLOT_LINE]   = "using 1:2 with lines lw 2",
        [DIG_PLOT_DASHED] = "using 1:2 with lines lw 2 dt (8,5)",
        [DIG_PLOT_DOTTED] = "using 1:2 with lines lw 2 dt (2,4)",
        [DIG_PLOT_POINTS] = "using 1:2 with points pt 7 ps 0.6",
        [DIG_PLOT_BAND]   = "using 1:2:3 with filledcurves fs transparent solid 0.25 noborder",
    };
    (void)fprintf(to,
                  "set terminal svg size %d,%u noenhanced font 'sans-serif,14'\n"
                  "unset key\nset grid lc rgb 0xdddddd\nset border %d lc rgb 0x666666\n"
                  "set tics nomirror\n",
                  plot->right_label != NULL ? WIDTH - 2 * LEFT : WIDTH - LEFT, height,
                  plot->right_label != NULL ? 11 : 3);
    if (plot->right_label != NULL) {
        (void)fprintf(to, "set rmargin 7\nset y2tics\nset link y2 via y*%.9g inverse y/%.9g\n",
                      plot->right_factor, plot->right_factor);
    }
    if (plot->x_to > 0.0) {
        (void)fprintf(to, "set xrange [0:%.9g]\n", plot->x_to);
    }
    (void)fputs(marks_each(plot) ? "set ytics 1\n" : "", to);
    (void)fputs(plot->from_zero ? "set yrange [*<0:*]\n" : "", to);
    for (size_t i = 0; i < plot->series; i++) {
        put_data(to, i, &plot->s[i]);
    }
    for (size_t i = 0; i < plot->series; i++) {
        (void)fprintf(to, "%s $s%zu %s lc rgb 0x%06x notitle", i == 0 ? "plot" : ",", i,
                      how[plot->s[i].style], plot->s[i].rgb & 0xffffffU);
    }
    (void)fprintf(to, "\n");
}

// Runs gnuplot on the script, its standard output going to svg. -d: no start-up file of the user's.
static enum dig_status run_gnuplot(FILE *const script, FILE *const svg,
                                   struct dig_error *const error)
{
    const char *const        argv[]  = { "gnuplot", "-d", "-", NULL };
    const struct dig_process process = { .argv = argv, .in = script, .out = svg };
    struct dig_error         why     = { "" };
    return dig_process_run(&process, &why) == DIG_OK
               ? DIG_OK
               : dig_error_set(error, DIG_EIO, "%s (package gnuplot-nox)", why.text);
}

// What gnuplot drew, without the <svg> element it stands in: a page's style for pictures would
// scale an inner one anew.
static enum dig_status copy_drawing(FILE *const from, FILE *const to, struct dig_error *const error)
{
    enum { BEFORE, IN_TAG, INSIDE, BEHIND } at = BEFORE;
    char line[4096];
    rewind(from);
    while (at != BEHIND && fgets(line, sizeof line, from) != NULL) {
        if (at == INSIDE) {
            // Its title and who made it would be read aloud, and shown where there are no pictures.
            const bool about = strncmp(line, "<title>", 7) == 0 || strncmp(line, "<desc>", 6) == 0;
            at               = strncmp(line, "</svg>", 6) == 0 ? BEHIND : INSIDE;
            if (at == INSIDE && !about && fputs(line, to) == EOF) {
                return dig_error_set(error, DIG_EIO, "writing a plot: %s", strerror(errno));
            }
        } else {
            const char *const tag = at == BEFORE ? strstr(line, "<svg") : line;
            if (tag != NULL) {
                at = strchr(tag, '>') != NULL ? INSIDE : IN_TAG;
            }
        }
    }
    return at == BEHIND ? DIG_OK : dig_error_set(error, DIG_EIO, "gnuplot wrote no picture");
}

// About as wide as the text is; letters differ.
static unsigned width_of(const char *const text)
{
    unsigned letters = 0;
    for (const char *c = text; *c != '\0'; c++) {
        letters += ((unsigned char)*c & 0xc0U) != 0x80U ? 1U : 0U;
    }
    return letters * LETTER;
}

static void put_text(FILE *const to, const unsigned x, const unsigned y, const char *const more,
                     const char *const text)
{
    (void)fprintf(to, "<text x=\"%u\" y=\"%u\"%s>", x, y, more);
    dig_html_text(to, text);
    (void)fputs("</text>\n", to);
}

// Upwards, about its middle.
static void put_turned(FILE *const to, const unsigned x, const unsigned y, const char *const text)
{
    char turned[64];
    (void)snprintf(turned, sizeof turned, " text-anchor=\"middle\" transform=\"rotate(-90 %u %u)\"",
                   x, y);
    put_text(to, x, y, turned, text);
}

static void put_sample(FILE *const to, const struct dig_plot_series *const s, const unsigned x,
                       const unsigned y)
{
    if (s->style == DIG_PLOT_BAND) {
        (void)fprintf(to,
                      "<rect x=\"%u\" y=\"%u\" width=\"%d\" height=\"10\" fill=\"#%06x\" "
                      "fill-opacity=\"0.25\"/>\n",
                      x, y - 10, SAMPLE - 8, s->rgb);
    } else if (s->style == DIG_PLOT_POINTS) {
        (void)fprintf(to, "<circle cx=\"%u\" cy=\"%u\" r=\"3\" fill=\"#%06x\"/>\n", x + 10, y - 5,
                      s->rgb);
    } else {
        (void)fprintf(to, "<path d=\"M%u %uh%d\" stroke=\"#%06x\" stroke-width=\"2\"%s/>\n", x,
                      y - 5, SAMPLE - 8, s->rgb,
                      s->style == DIG_PLOT_DASHED   ? " stroke-dasharray=\"8 5\""
                      : s->style == DIG_PLOT_DOTTED ? " stroke-dasharray=\"2 4\""
                                                    : "");
    }
}

// A curve of which nothing is known is in no key.
static bool in_key(const struct dig_plot_series *const s)
{
    size_t i = 0;
    while (i < s->n && !isfinite(s->y[i])) {
        i++;
    }
    return s->title != NULL && i < s->n;
}

// The key from line y on, as many lines as it takes; to may be NULL, to count them.
static unsigned put_key(FILE *const to, const struct dig_plot *const plot, const unsigned y)
{
    unsigned x     = 3 * LEFT;
    unsigned lines = 0;
    for (size_t i = 0; i < plot->series; i++) {
        const struct dig_plot_series *const s = &plot->s[i];
        if (!in_key(s)) {
            continue;
        }
        const unsigned wide = SAMPLE + width_of(s->title);
        if (lines == 0 || x + wide > WIDTH) {
            x = 3 * LEFT;
            lines++;
        }
        if (to != NULL) {
            put_sample(to, s, x, y + (lines - 1) * LINE);
            put_text(to, x + SAMPLE, y + (lines - 1) * LINE, "", s->title);
        }
        x += wide + GAP;
    }
    return lines;
}

static enum dig_status put_picture(const struct dig_plot *const plot, FILE *const drawing,
                                   const unsigned above, const unsigned below, FILE *const to,
                                   struct dig_error *const error)
{
    const unsigned height = plot->height;
    (void)fprintf(to,
                  "<figure>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
                  "xmlns:xlink=\"http://www.w3.org/1999/xlink\" viewBox=\"0 0 %d %u\" "
                  "font-family=\"sans-serif\" font-size=\"14\">\n"
                  "<rect width=\"%d\" height=\"%u\" fill=\"#ffffff\"/>\n",
                  WIDTH, height, WIDTH, height);
    put_text(to, WIDTH / 2, LINE - 2, " text-anchor=\"middle\"", plot->title);
    put_turned(to, LINE - 4, height / 2, plot->y_label);
    if (plot->right_label != NULL) {
        put_turned(to, WIDTH - 8, height / 2, plot->right_label);
    }
    put_text(to, WIDTH / 2, height - below + LINE - 6, " text-anchor=\"middle\"", plot->x_label);
    (void)put_key(to, plot, height - below + 2 * LINE - 2);
    (void)fprintf(to, "<g transform=\"translate(%d %u)\" fill=\"none\">\n", LEFT, above);
    const enum dig_status status = copy_drawing(drawing, to, error);
    (void)fputs("</g>\n</svg>\n</figure>\n", to);
    return status;
}

void dig_plot_of_dig(const double unit, const double measured[DIG_CURVE_POINTS], const double first,
                     const double last, const double model[DIG_CURVE_POINTS],
                     const double sigma[DIG_CURVE_POINTS], struct dig_plot_dig *const dig)
{
    assert(measured != NULL && model != NULL && sigma != NULL && dig != NULL);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress = (double)k / (DIG_CURVE_POINTS - 1);
        const double half     = unit * DIG_PLOT_BAND_SIGMAS * sigma[k];
        dig->x[k]             = 100.0 * progress;
        dig->model[k]         = unit * model[k];
        dig->low[k]           = dig->model[k] - half;
        dig->high[k]          = dig->model[k] + half;
        dig->measured[k] = progress >= first && progress <= last ? unit * measured[k] : (double)NAN;
    }
}

static enum dig_status put_figure(const struct dig_plot *const plot, FILE *const to,
                                  struct dig_error *const error)
{
    assert(plot != NULL && to != NULL && plot->series <= DIG_PLOT_SERIES_MAX && plot->height > 0);
    const unsigned above = plot->title[0] == '\0' ? 0 : LINE;
    const unsigned below = LINE + 4 + LINE * put_key(NULL, plot, 0);

    FILE *const     script  = tmpfile();
    FILE *const     drawing = script != NULL ? tmpfile() : NULL;
    enum dig_status status  = DIG_EIO;
    if (drawing == NULL) {
        (void)dig_error_set(error, DIG_EIO, "temporary file: %s", strerror(errno));
        goto done;
    }
    put_script(script, plot, plot->height - above - below);
    if (fflush(script) != 0 || fseek(script, 0, SEEK_SET) != 0) {
        (void)dig_error_set(error, DIG_EIO, "temporary file: %s", strerror(errno));
        goto done;
    }
    status = run_gnuplot(script, drawing, error);
    if (status == DIG_OK) {
        status = put_picture(plot, drawing, above, below, to, error);
    }
done:
    if (drawing != NULL) {
        (void)fclose(drawing);
    }
    if (script != NULL) {
        (void)fclose(script);
    }
    return status;
}

void dig_plot_figure(const struct dig_plot *const plot, FILE *const to,
                     struct dig_conditions *const c)
{
    c->status = c->status == DIG_OK ? put_figure(plot, to, c->error) : c->status;
}
