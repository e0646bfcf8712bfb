// JSON as every report writes it.

#ifndef DIG_CLOSED_LOOP_REPORT_JSON_H
#define DIG_CLOSED_LOOP_REPORT_JSON_H

#include <stdio.h>

/// A piece of JSON by its format: %s is a string with its quotes, %i true or false, a number that
/// is not finite null, for JSON knows no NaN. What else there is: closed_loop/report/markup.h.
__attribute__((format(printf, 2, 3))) void dig_json_put(FILE *to, const char *format, ...);

#endif // DIG_CLOSED_LOOP_REPORT_JSON_H
