// The parts of a JSON text that every report writes.

#ifndef DIG_CLOSED_LOOP_REPORT_JSON_H
#define DIG_CLOSED_LOOP_REPORT_JSON_H

#include <stdio.h>

/// Six digits; what is not finite is null, for JSON knows no NaN.
void dig_json_number(FILE *to, double value);

/// What stands before it, the name quoted, a colon, the number.
void dig_json_member(FILE *to, const char *before, const char *name, double value);

/// The same of a text, as dig_text_put_json() writes it.
void dig_json_text(FILE *to, const char *before, const char *name, const char *text);

#endif // DIG_CLOSED_LOOP_REPORT_JSON_H
