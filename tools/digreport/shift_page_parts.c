#include "tools/digreport/shift_page_parts.h"

#include <math.h>
#include <string.h>

double digreport_page_time(const struct digreport_page *const page, const int64_t time_us)
{
    return (double)(time_us - page->shift->first_us) / page->unit_us;
}

void digreport_page_time_cell(FILE *const to, const int64_t time_us)
{
    char text[DIGREPORT_TIME];
    digreport_time(time_us, text);
    (void)fprintf(to, "<th>%.8s</th>", text + strlen("2026-11-24T"));
}

bool digreport_page_any(const size_t n, const double value[])
{
    size_t i = 0;
    while (i < n && !isfinite(value[i])) {
        i++;
    }
    return i < n;
}
