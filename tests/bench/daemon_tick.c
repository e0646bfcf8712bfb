// What a tick of the daemon's real-time thread costs: the very loop, estimator and table, fed with
// a machine recording over and over at 1 kHz, on this thread's CPU clock.
//
//   daemon_tick TABLE.sqlite MACHINE.yaml RECORDING.csv [TICKS]
//
// Digs are matched by the daemon's own matcher between ticks, which is not counted. Prints
//   tick MEAN_us P99_us P999_us WORST_us SECOND_WORST_us TICKS DIGS MATCHES
// and with -v before the arguments each tick above 40 us.

#include "core/recording.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "firmware_host/fit.h"
#include "firmware_host/rt.h"
#include "tables/load.h"
#include "tests/wires.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define STEP_ns 1000000LL
#define BINS    20000 // of 0.1 us

struct bench {
    struct dig_machine           machine;
    struct dig_curve_set        *set;
    struct dig_machine_recording recording;
    struct dig_estimator        *estimator;
    struct dig_config            config;
    struct wires                 wires;
    struct dig_early             early;
    struct dig_raw              *raw[2];
    struct dig_loop              loop;
    struct dig_fit               fit;
    int64_t                      count[BINS];
    double                       sum_us, worst_us, second_us;
};

static double cpu_us(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

// The recording at time_ns, linear between its rows, repeated without end.
static struct dig_reading reading_at(const struct dig_machine_recording *const r,
                                     const int64_t time_ns, size_t *const row)
{
    const int64_t length_ns = r->row[r->rows - 1].time_ns - r->row[0].time_ns;
    const int64_t at_ns     = time_ns % length_ns;
    if (r->row[*row].time_ns > at_ns) {
        *row = 0;
    }
    while (r->row[*row + 1].time_ns < at_ns) {
        (*row)++;
    }
    const struct dig_sample *const a = &r->row[*row];
    const struct dig_sample *const b = a + 1;
    const double       f       = (double)(at_ns - a->time_ns) / (double)(b->time_ns - a->time_ns);
    struct dig_reading reading = { .time_ns = time_ns + STEP_ns };
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        reading.state[i] =
            (uint8_t)(a->valid[i] && b->valid[i] ? DIG_READING_OK : DIG_READING_NOT_AVAILABLE);
        reading.value[i] = a->value[i] + f * (b->value[i] - a->value[i]);
    }
    return reading;
}

static void connect(struct bench *const b)
{
    wires_init(&b->wires);
    const struct dig_loop_ports ports    = wires_loop_ports(&b->wires);
    struct dig_loop_settings    settings = wires_loop_settings(b->set);
    settings.tick_s                      = 1e-9 * (double)STEP_ns;
    settings.prediction_s                = 1.0 / 15.0;
    dig_loop_init(&b->loop, &settings, &ports, b->estimator);
    for (int i = 0; i < 2; i++) {
        b->raw[i] = calloc(1, dig_raw_size());
        (void)dig_ring_push(&b->wires.spares, &b->raw[i]);
    }
    b->early.estimates = &b->wires.estimates;
    dig_early_forget(&b->early, b->set);
    wires_init_fit(&b->wires, &b->config, b->set, &b->fit);
    b->fit.machine                  = &b->machine;
    b->fit.early                    = &b->early;
    b->fit.lambda                   = b->machine.link[DIG_JOINT_BUCKET].length_m / b->set->tooth_m;
    b->fit.known_settings.expires_s = 1e9;
    b->fit.tick_generation          = &b->loop.generation;
}

static struct bench *create(char *argv[])
{
    struct dig_error    error = { "" };
    struct bench *const b     = calloc(1, sizeof *b);
    if (b == NULL || dig_table_load(argv[1], &b->set, &error) != DIG_OK ||
        dig_machine_read(argv[2], &b->machine, &error) != DIG_OK ||
        dig_machine_recording_read(argv[3], &b->recording, &error) != DIG_OK) {
        (void)fprintf(stderr, "daemon_tick: %s\n", error.text);
        return NULL;
    }
    struct dig_estimator_settings settings = dig_estimator_settings_default();
    settings.tick_s                        = 1e-9 * (double)STEP_ns;
    b->config.estimator                    = settings;
    b->config.match_evaluations            = 200;
    b->config.match_early_path             = 0.3;
    b->config.match_least_path             = 0.6;
    b->estimator                           = calloc(1, dig_estimator_size());
    if (b->estimator == NULL ||
        dig_estimator_init(b->estimator, &b->machine, b->set, &settings) != DIG_OK) {
        (void)fprintf(stderr, "daemon_tick: the estimator refuses machine or table\n");
        return NULL;
    }
    connect(b);
    return b;
}

// What the other threads do, between ticks and not counted.
static void be_the_others(struct bench *const b)
{
    struct dig_record     record;
    struct dig_outlook    outlook;
    struct dig_fit_result result;
    while (dig_ring_pop(&b->wires.records, &record)) {
    }
    (void)dig_latest_take(&b->wires.outlook, &outlook);
    (void)dig_fit_once(&b->fit);
    (void)dig_ring_pop(&b->wires.results, &result);
}

static void count(struct bench *const b, const double took_us)
{
    const size_t bin = (size_t)fmin(took_us * 10.0, BINS - 1);
    b->count[bin]++;
    b->sum_us += took_us;
    b->second_us = fmax(b->second_us, fmin(took_us, b->worst_us));
    b->worst_us  = fmax(b->worst_us, took_us);
}

static double quantile_us(const struct bench *const b, const long ticks, const double share)
{
    long below = 0;
    for (size_t i = 0; i < BINS; i++) {
        below += b->count[i];
        if ((double)below >= share * (double)ticks) {
            return 0.1 * (double)(i + 1);
        }
    }
    return b->worst_us;
}

int main(const int argc, char *argv[])
{
    const bool verbose = argc > 1 && strcmp(argv[1], "-v") == 0;
    argv += verbose;
    if (argc - verbose < 4) {
        (void)fprintf(stderr, "usage: daemon_tick [-v] TABLE MACHINE RECORDING [TICKS]\n");
        return 2;
    }
    const long          ticks = argc - verbose > 4 ? atol(argv[4]) : 1000000;
    struct bench *const b     = create(argv);
    if (b == NULL) {
        return 2;
    }
    const struct dig_rt_settings rt = { .priority = 80, .lock_memory = true, .cpu = -1 };
    (void)dig_rt_enter(&rt);
    size_t row = 0;
    for (long i = 0; i < ticks; i++) {
        const int64_t            now_ns  = (i + 1) * STEP_ns;
        const struct dig_reading reading = reading_at(&b->recording, i * STEP_ns, &row);
        (void)dig_ring_push(&b->wires.readings, &reading);
        const double begin_us = cpu_us();
        dig_loop_tick(&b->loop, now_ns);
        const double took_us = cpu_us() - begin_us;
        if (verbose && took_us > 40.0) {
            (void)printf("%9ld %7.1f us, phase %d, dig %u, trajectory %d\n", i, took_us,
                         (int)b->loop.estimate.phase, b->loop.estimate.dig_count,
                         b->loop.estimate.trajectory);
        }
        count(b, took_us);
        be_the_others(b);
    }
    (void)printf("tick %.2f %.1f %.1f %.1f %.1f %ld %lld %lld\n", b->sum_us / (double)ticks,
                 quantile_us(b, ticks, 0.99), quantile_us(b, ticks, 0.999), b->worst_us,
                 b->second_us, ticks, atomic_load(&b->fit.seen), atomic_load(&b->fit.matches));
    return 0;
}
