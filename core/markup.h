// Formats of a text in which what is put in must be marked up: JSON, and pages.

#ifndef DIG_CORE_MARKUP_H
#define DIG_CORE_MARKUP_H

#include "core/curve.h"

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

/// A piece of JSON by its format: %s is a string with its quotes, a number that is not finite null,
/// for JSON knows no NaN.
__attribute__((format(printf, 2, 3))) void dig_json_put(FILE *to, const char *format, ...);

/// The axes of a gravel, each as a member of the object that is being put.
void dig_json_gravel(FILE *to, const struct dig_gravel *gravel);

#endif // DIG_CORE_MARKUP_H
