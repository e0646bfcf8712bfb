// Formats of a text in which what is put in must be marked up: pages and JSON.

#ifndef DIG_CLOSED_LOOP_REPORT_MARKUP_H
#define DIG_CLOSED_LOOP_REPORT_MARKUP_H

#include <stdarg.h>
#include <stdio.h>

struct dig_markup {
    void (*text)(FILE *to, const char *text);
    const char *none; // in place of a number that is not finite
};

/// As vfprintf(), but that %s puts a text as the markup has it, %f and %g a number or none, %i true
/// or false. Besides there are %d, %u, %ld, %zu and %%. No widths; behind a point one digit, or *.
__attribute__((format(printf, 3, 0))) void dig_markup_put(FILE *to, const struct dig_markup *markup,
                                                          const char *format, va_list values);

#endif // DIG_CLOSED_LOOP_REPORT_MARKUP_H
