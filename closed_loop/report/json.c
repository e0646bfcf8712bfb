#include "closed_loop/report/json.h"

#include "core/text.h"

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

void dig_json_text(FILE *const to, const char *const before, const char *const name,
                   const char *const text)
{
    (void)fprintf(to, "%s\"%s\": ", before, name);
    dig_text_put_json(to, text);
}
