#include "tools/digreport/shift_page.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <time.h>

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
    double                               error;
    double                               floor;
    const size_t                         n = digreport_shift_error(shift, &error, &floor);
    const struct digreport_gravel *const g = digreport_shift_gravel_at(shift, INT64_MAX);
    (void)fprintf(to, "%zu dig%s in ", shift->digs, shift->digs == 1 ? "" : "s");
    put_duration(shift->last_us - shift->first_us, to);
    if (g != NULL) {
        (void)fprintf(
            to,
            "; the gravel at the end: friction %.2f (%.2f to %.2f), rolling friction %.2f "
            "(%.2f to %.2f), density %.0f (%.0f to %.0f) kg/m3",
            g->gravel.value[0], g->low.value[0], g->high.value[0], g->gravel.value[1],
            g->low.value[1], g->high.value[1], g->gravel.value[2], g->low.value[2],
            g->high.value[2]);
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

static void put_number(const double value, FILE *const to)
{
    (void)fputc(',', to);
    if (isfinite(value)) {
        (void)fprintf(to, "%.6g", value);
    }
}

static void put_gravel(const struct digreport_gravel *const g, FILE *const to)
{
    for (int a = 0; a < DIG_AXES; a++) {
        put_number(g != NULL ? g->gravel.value[a] : (double)NAN, to);
        put_number(g != NULL ? g->low.value[a] : (double)NAN, to);
        put_number(g != NULL ? g->high.value[a] : (double)NAN, to);
    }
}

void digreport_shift_csv(const struct digreport_shift *const shift, FILE *const to)
{
    assert(shift != NULL && to != NULL);
    const double to_rig = pow(shift->lambda, -4.0);
    (void)fputs("time_utc,dig,trajectory,duration_s,peak_Nm,predicted_peak_Nm,"
                "predicted_peak_sigma_Nm,energy_J,predicted_energy_J,predicted_energy_sigma_J,"
                "rig_peak_Nm,rig_energy_J,error,noise_floor,friction,friction_low,friction_high,"
                "rolling,rolling_low,rolling_high,density_kgpm3,density_low_kgpm3,"
                "density_high_kgpm3\n",
                to);
    for (size_t i = 0; i < shift->digs; i++) {
        const struct digreport_dig *const d        = &shift->dig[i];
        const time_t                      seconds  = (time_t)(d->time_us / 1000000);
        char                              time[32] = "";
        struct tm                         utc;
        if (gmtime_r(&seconds, &utc) != NULL) {
            (void)strftime(time, sizeof time, "%Y-%m-%dT%H:%M:%SZ", &utc);
        }
        (void)fprintf(to, "%s,%" PRId32 ",%s", time, d->number, d->trajectory);
        const double number[] = { d->duration_s,
                                  d->peak_Nm,
                                  d->predicted_peak_Nm,
                                  d->predicted_peak_sigma_Nm,
                                  d->energy_J,
                                  d->predicted_energy_J,
                                  d->predicted_energy_sigma_J,
                                  to_rig * d->peak_Nm,
                                  to_rig * d->energy_J,
                                  d->error,
                                  d->noise_floor };
        for (size_t k = 0; k < sizeof number / sizeof number[0]; k++) {
            put_number(number[k], to);
        }
        put_gravel(digreport_shift_gravel_at(shift, d->time_us), to);
        (void)fputc('\n', to);
    }
}
