#include "core/markup.h"
#include "core/text.h"
#include "tools/digreport/shift_page.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

void digreport_time(const int64_t time_us, char text[const DIGREPORT_TIME])
{
    dig_text_utc(time_us / 1000000, DIGREPORT_TIME, text);
}

static void put_duration(const int64_t us, FILE *const to)
{
    const int64_t minutes = us / 60000000;
    if (minutes < 60) {
        (void)fprintf(to, "%" PRId64 " min", minutes > 0 ? minutes : 1);
    } else {
        (void)fprintf(to, "%" PRId64 " h %02" PRId64 " min", minutes / 60, minutes % 60);
    }
}

void digreport_shift_sentence(const struct digreport_shift *const shift, FILE *const to)
{
    assert(shift != NULL && to != NULL);
    double                                 error;
    double                                 floor;
    const size_t                           n = digreport_shift_error(shift, &error, &floor);
    const struct dig_matched_gravel *const g = digreport_shift_gravel_at(shift, INT64_MAX);
    (void)fprintf(to, "%zu dig%s in ", shift->digs, shift->digs == 1 ? "" : "s");
    put_duration(shift->last_us - shift->first_us, to);
    size_t aborted = 0;
    for (size_t i = 0; i < shift->digs; i++) {
        aborted += shift->dig[i].ended == DIGREPORT_ABORTED ? 1 : 0;
    }
    if (aborted > 0) {
        (void)fprintf(to, ", %zu aborted", aborted);
    }
    if (g != NULL) {
        const double *const at   = g->gravel.value;
        const double *const low  = g->low.value;
        const double *const high = g->high.value;
        (void)fprintf(to,
                      "; the gravel at the end: friction %.2f (%.2f to %.2f), rolling friction "
                      "%.2f (%.2f to %.2f), density %.0f (%.0f to %.0f) kg/m3",
                      at[0], low[0], high[0], at[1], low[1], high[1], at[2], low[2], high[2]);
    } else {
        (void)fputs("; no gravel was known at the end", to);
    }
    if (n > 0) {
        (void)fprintf(to, "; %zu prediction%s, off by %.0f %% (median; noise floor %.0f %%)", n,
                      n == 1 ? "" : "s", 100.0 * error, 100.0 * floor);
    } else {
        (void)fputs("; nothing was predicted", to);
    }
    (void)fprintf(to, "; health: %zu event%s.", shift->events, shift->events == 1 ? "" : "s");
}

struct number {
    const char *name;
    double      value;
};

enum { OF_GRAVEL = 9, OF_DIG = 11 };

static void numbers_of_gravel(const struct dig_matched_gravel *const g,
                              struct number                          number[const OF_GRAVEL])
{
    static const char *const name[OF_GRAVEL] = {
        "friction",     "friction_low",  "friction_high",     "rolling",           "rolling_low",
        "rolling_high", "density_kgpm3", "density_low_kgpm3", "density_high_kgpm3"
    };
    for (int i = 0; i < OF_GRAVEL; i++) {
        const struct dig_gravel *const end = g == NULL    ? NULL
                                             : i % 3 == 0 ? &g->gravel
                                             : i % 3 == 1 ? &g->low
                                                          : &g->high;
        number[i] = (struct number){ name[i], end != NULL ? end->value[i / 3] : (double)NAN };
    }
}

static void numbers_of_dig(const struct digreport_shift *const shift,
                           const struct digreport_dig *const d, struct number number[const OF_DIG])
{
    const double        to_rig      = pow(shift->lambda, -4.0); // infinite where it is not known
    const struct number all[OF_DIG] = {
        { "duration_s", d->duration_s },
        { "peak_Nm", d->peak_Nm },
        { "predicted_peak_Nm", d->predicted_peak_Nm },
        { "predicted_peak_sigma_Nm", d->predicted_peak_sigma_Nm },
        { "energy_J", d->energy_J },
        { "predicted_energy_J", d->predicted_energy_J },
        { "predicted_energy_sigma_J", d->predicted_energy_sigma_J },
        { "rig_peak_Nm", to_rig * d->peak_Nm },
        { "rig_energy_J", to_rig * d->energy_J },
        { "error", d->error },
        { "noise_floor", d->noise_floor },
    };
    memcpy(number, all, sizeof all);
}

void digreport_shift_csv(const struct digreport_shift *const shift, FILE *const to)
{
    assert(shift != NULL && to != NULL);
    struct number number[OF_DIG + OF_GRAVEL];
    numbers_of_dig(shift, &(struct digreport_dig){ .number = 0 }, number);
    numbers_of_gravel(NULL, number + OF_DIG);
    (void)fputs("time_utc,dig,trajectory,ended", to);
    for (int k = 0; k < OF_DIG + OF_GRAVEL; k++) {
        (void)fprintf(to, ",%s", number[k].name);
    }
    (void)fputc('\n', to);
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d = &shift->dig[i];
        char                              time[DIGREPORT_TIME];
        digreport_time(d->time_us, time);
        (void)fprintf(to, "%s,%" PRId32 ",%s,%s", time, d->number, d->trajectory,
                      digreport_ending_name(d->ended));
        numbers_of_dig(shift, d, number);
        numbers_of_gravel(digreport_shift_gravel_at(shift, d->time_us), number + OF_DIG);
        for (int k = 0; k < OF_DIG + OF_GRAVEL; k++) {
            (void)fprintf(to, isfinite(number[k].value) ? ",%.6g" : ",", number[k].value);
        }
        (void)fputc('\n', to);
    }
}

static void put_json_numbers(const int n, const struct number number[], FILE *const to)
{
    for (int k = 0; k < n; k++) {
        dig_json_put(to, ", %s: %g", number[k].name, number[k].value);
    }
    (void)fputc('}', to);
}

void digreport_shift_json(const struct digreport_shift *const shift, FILE *const to)
{
    assert(shift != NULL && to != NULL);
    struct number number[OF_DIG];
    char          from[DIGREPORT_TIME];
    char          until[DIGREPORT_TIME];
    digreport_time(shift->first_us, from);
    digreport_time(shift->last_us, until);
    dig_json_put(to,
                 "{\"from_utc\": %s, \"to_utc\": %s, \"lambda\": %g, \"misread\": %" PRId64
                 ", \"digs\": [",
                 from, until, shift->lambda > 0.0 ? shift->lambda : (double)NAN, shift->misread);
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d = &shift->dig[i];
        digreport_time(d->time_us, from);
        (void)fputs(i == 0 ? "\n " : ",\n ", to);
        dig_json_put(to,
                     "{\"time_utc\": %s, \"dig\": %" PRId32 ", \"trajectory\": %s, \"ended\": %s",
                     from, d->number, d->trajectory, digreport_ending_name(d->ended));
        numbers_of_dig(shift, d, number);
        put_json_numbers(OF_DIG, number, to);
    }
    (void)fputs("],\n\"gravels\": [", to);
    for (size_t i = 0; i < shift->gravels; i++) {
        const struct dig_matched_gravel *const g = &shift->gravel[i].match;
        digreport_time(shift->gravel[i].time_us, from);
        (void)fputs(i == 0 ? "\n " : ",\n ", to);
        dig_json_put(to,
                     "{\"time_utc\": %s, \"known\": %i, \"outside\": %i, \"forces\": %i, "
                     "\"digs\": %" PRId32 ", \"untold\": %s",
                     from, g->known, g->outside, g->forces, g->digs, g->untold);
        numbers_of_gravel(g->known ? g : NULL, number);
        put_json_numbers(OF_GRAVEL, number, to);
    }
    (void)fputs("],\n\"troubles\": [", to);
    for (size_t i = 0; i < shift->events; i++) {
        const struct digreport_event *const e = &shift->event[i];
        digreport_time(e->from_us, from);
        digreport_time(e->to_us, until);
        (void)fputs(i == 0 ? "\n " : ",\n ", to);
        dig_json_put(to,
                     "{\"from_utc\": %s, \"to_utc\": %s, \"count\": %" PRId64
                     ", \"what\": %s, \"todo\": %s}",
                     from, until, e->count, e->text != NULL ? e->text->what : e->said,
                     e->text != NULL ? e->text->todo : "");
    }
    (void)fputs("]}\n", to);
}
