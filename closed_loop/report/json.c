#include "closed_loop/report/json.h"

#include <math.h>

void dig_json_number(FILE *const to, const double value)
{
    if (isfinite(value)) {
        (void)fprintf(to, "%.6g", value);
    } else {
        (void)fputs("null", to);
    }
}

void dig_json_member(FILE *const to, const char *const before, const char *const name,
                     const double value)
{
    (void)fprintf(to, "%s\"%s\": ", before, name);
    dig_json_number(to, value);
}

void dig_json_string(FILE *const to, const char *const text)
{
    (void)fputc('"', to);
    for (const char *c = text; *c != '\0'; c++) {
        if (*c == '"' || *c == '\\') {
            (void)fprintf(to, "\\%c", *c);
        } else if ((unsigned char)*c < 0x20U) {
            (void)fprintf(to, "\\u%04x", (unsigned)*c);
        } else {
            (void)fputc(*c, to);
        }
    }
    (void)fputc('"', to);
}
