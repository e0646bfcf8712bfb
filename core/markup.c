#include "core/markup.h"

#include "core/text.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

// The value of one conversion, by what stands behind its '%'; what is behind that.
static const char *put_value(FILE *const to, const struct dig_markup *const markup, const char *c,
                             va_list *const values)
{
    int    digits = 6;
    double number = 0.0;
    if (*c == '.') {
        digits = c[1] == '*' ? va_arg(*values, int) : c[1] - '0';
        c += 2;
    }
    switch (*c) {
    case 's': markup->text(to, va_arg(*values, const char *)); break;
    case 'i': (void)fputs(va_arg(*values, int) != 0 ? "true" : "false", to); break;
    case 'd': (void)fprintf(to, "%d", va_arg(*values, int)); break;
    case 'u': (void)fprintf(to, "%u", va_arg(*values, unsigned)); break;
    case 'l': (void)fprintf(to, "%ld", va_arg(*values, long)); return c + strlen("ld");
    case 'z': (void)fprintf(to, "%zu", va_arg(*values, size_t)); return c + strlen("zu");
    case 'f':
    case 'g':
        number = va_arg(*values, double);
        if (!isfinite(number)) {
            (void)fputs(markup->none, to);
        } else {
            (void)fprintf(to, *c == 'f' ? "%.*f" : "%.*g", digits, number);
        }
        break;
    default: assert(*c == '%'); (void)fputc(*c, to);
    }
    return c + 1;
}

void dig_markup_put(FILE *const to, const struct dig_markup *const markup, const char *format,
                    va_list values)
{
    assert(to != NULL && markup != NULL && format != NULL);
    va_list left;
    va_copy(left, values); // of which a pointer may be taken
    while (*format != '\0') {
        const size_t plain = strcspn(format, "%");
        (void)fwrite(format, 1, plain, to);
        format += plain;
        format = *format == '%' ? put_value(to, markup, format + 1, &left) : format;
    }
    va_end(left);
}

void dig_json_put(FILE *const to, const char *const format, ...)
{
    static const struct dig_markup json = { dig_text_put_json, "null" };
    va_list                        values;
    va_start(values, format);
    dig_markup_put(to, &json, format, values);
    va_end(values);
}

void dig_json_gravel(FILE *const to, const struct dig_gravel *const gravel)
{
    assert(gravel != NULL);
    dig_json_put(to, "\"friction\": %.9g, \"rolling\": %.9g, \"density_kgpm3\": %.9g",
                 gravel->value[DIG_AXIS_FRICTION], gravel->value[DIG_AXIS_ROLLING],
                 gravel->value[DIG_AXIS_DENSITY_kgpm3]);
}
