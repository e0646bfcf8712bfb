// What every page has: escaped text and one style.

#ifndef DIG_CLOSED_LOOP_REPORT_HTML_H
#define DIG_CLOSED_LOOP_REPORT_HTML_H

#include <stdio.h>

/// text as HTML or SVG, between tags or inside a quoted attribute: markup is escaped, a control
/// character or a byte that is not UTF-8 becomes U+FFFD. Every text on a page goes through here.
void dig_html_text(FILE *to, const char *text);

/// A piece of a page by its format: %s goes through dig_html_text(), a number that is not finite is
/// a dash. What else there is: core/markup.h.
__attribute__((format(printf, 2, 3))) void dig_html_put(FILE *to, const char *format, ...);

/// As dig_html_text(), without the folders of files that are named in it: they are somebody's
/// machine.
void dig_html_without_folders(FILE *to, const char *text);

/// From the doctype to the <h1>, both with this title; a sentence in <p class=result> comes next.
/// The style makes phones, desktops and paper happy; it styles table (.words: to the left, .wide:
/// of many columns), figure, .result, .grid (plots side by side where there is room), .bar, .muted.
void dig_html_begin(FILE *to, const char *title);

/// The footer, note (HTML) in it, and the end.
void dig_html_end(FILE *to, const char *note);

#endif // DIG_CLOSED_LOOP_REPORT_HTML_H
