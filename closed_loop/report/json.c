#include "closed_loop/report/json.h"

#include "closed_loop/report/markup.h"
#include "core/text.h"

void dig_json_put(FILE *const to, const char *const format, ...)
{
    static const struct dig_markup json = { dig_text_put_json, "null" };
    va_list                        values;
    va_start(values, format);
    dig_markup_put(to, &json, format, values);
    va_end(values);
}
