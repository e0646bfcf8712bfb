#include "tools/digreport/shift_page_parts.h"

#include <math.h>
#include <time.h>

double digreport_page_time(const struct digreport_page *const page, const int64_t time_us)
{
    return (double)(time_us - page->shift->first_us) / page->unit_us;
}

void digreport_page_time_cell(FILE *const to, const int64_t time_us)
{
    const time_t seconds = (time_t)(time_us / 1000000);
    struct tm    utc;
    char         text[32] = "";
    if (gmtime_r(&seconds, &utc) != NULL) {
        (void)strftime(text, sizeof text, "%H:%M:%S", &utc);
    }
    (void)fprintf(to, "<th>%s</th>", text);
}

bool digreport_page_any(const size_t n, const double value[])
{
    size_t i = 0;
    while (i < n && !isfinite(value[i])) {
        i++;
    }
    return i < n;
}
