// What a tick of the daemon's real-time thread costs: the very loop, estimator and table, fed with
// a machine recording over and over at 1 kHz, on this thread's CPU clock.
//
//   daemon_tick TABLE.sqlite MACHINE.yaml RECORDING.csv [TICKS [PASSES]]
//
// Digs are matched by the daemon's own matcher between ticks, which is not counted. What a machine
// takes off a thread (interrupts, a neighbour on the core's other thread, a host that gives the
// core to someone else) is on that clock, too. So after every tick the clock is held against
// arithmetic that always is the same and costs as much as a tick, and all is done over in PASSES
// processes: what a tick costs in each of them it costs of itself. Prints
//   tick MEAN_us P99_us P999_us WORST_us SECOND_WORST_us TICKS DIGS MATCHES   of the first pass
//   still MEAN_us WORST_us SECOND_WORST_us                                    the arithmetic there
//   least WORST_us SECOND_WORST_us PASSES      of what every tick took at least in any of them

#include "core/recording.h"
#include "files/machine_yaml.h"
#include "files/recording_csv.h"
#include "firmware_host/matching/fit.h"
#include "firmware_host/threads/rt.h"
#include "tables/load.h"
#include "tests/wires.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define STEP_ns    1000000LL
#define PASSES_MAX 16

struct bench {
    struct dig_machine           machine;
    struct dig_curve_set        *set;
    struct dig_machine_recording recording;
    struct dig_estimator        *estimator;
    struct dig_config            config;
    struct wires                 wires;
    struct dig_early_match       early;
    struct dig_recorded_dig     *buffer[2];
    struct dig_loop              loop;
    struct dig_fit               fit;
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
    struct dig_loop_settings settings = wires_loop_settings(b->set);
    settings.tick_s                   = 1e-9 * (double)STEP_ns;
    settings.prediction_s             = 1.0 / 15.0;
    dig_loop_init(&b->loop, &settings, &b->wires.handoffs, b->estimator);
    for (int i = 0; i < 2; i++) {
        b->buffer[i] = calloc(1, dig_recorded_dig_size());
        (void)dig_ring_push(&b->wires.handoffs.spares, &b->buffer[i]);
    }
    wires_init_fit(&b->wires, &b->config, b->set, &b->early, &b->fit);
    b->fit.machine                  = &b->machine;
    b->fit.matcher.lambda           = b->machine.link[DIG_JOINT_BUCKET].length_m / b->set->tooth_m;
    b->fit.track_settings.expires_s = 1e9;
    b->fit.matcher.tick_generation  = &b->loop.generation;
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
    struct dig_record            record;
    struct dig_prediction_record predictions;
    struct dig_fit_result        result;
    while (dig_ring_pop(&b->wires.handoffs.records, &record)) {
    }
    (void)dig_latest_take(&b->wires.handoffs.predictions, &predictions);
    (void)dig_fit_once(&b->fit);
    (void)dig_ring_pop(&b->wires.handoffs.results, &result);
}

// What the passes tell their parent.
struct told {
    long long digs, matches;
    float     cost_us[]; // [2 * ticks]: of the ticks, of the arithmetic after each
};

// A chain that no compiler and no processor shortens: some five microseconds.
static double still(void)
{
    volatile double x = 1.0;
    for (int i = 0; i < 700; i++) {
        x = x * 0.999 + 0.001;
    }
    return x;
}

// Memory that a pass has in common with its parent; NULL when there is none.
static struct told *share(const long ticks)
{
    FILE *const  file = tmpfile();
    const size_t size = sizeof(struct told) + 2 * (size_t)ticks * sizeof(float);
    void        *told = MAP_FAILED;
    if (file != NULL && ftruncate(fileno(file), (off_t)size) == 0) {
        told = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, fileno(file), 0);
    }
    if (file != NULL) {
        (void)fclose(file);
    }
    return told != MAP_FAILED ? told : NULL;
}

static int pass(char *argv[], const long ticks, struct told *const told)
{
    struct bench *const b = create(argv);
    if (b == NULL) {
        return 2;
    }
    const struct dig_rt_settings rt = { .priority = 80, .lock_memory = true, .cpu = -1 };
    (void)dig_rt_enter(&rt);
    size_t row = 0;
    for (long i = 0; i < ticks; i++) {
        const struct dig_reading reading = reading_at(&b->recording, i * STEP_ns, &row);
        (void)dig_ring_push(&b->wires.handoffs.readings, &reading);
        const double begin_us = cpu_us();
        dig_loop_tick(&b->loop, (i + 1) * STEP_ns);
        const double ticked_us = cpu_us();
        (void)still();
        told->cost_us[i]         = (float)(ticked_us - begin_us);
        told->cost_us[ticks + i] = (float)(cpu_us() - ticked_us);
        be_the_others(b);
    }
    told->digs    = atomic_load(&b->fit.count.seen);
    told->matches = atomic_load(&b->fit.count.matches);
    return 0;
}

static int ascending(const void *const a, const void *const b)
{
    const float x = *(const float *)a;
    const float y = *(const float *)b;
    return (x > y) - (x < y);
}

static double mean(const long n, const float cost_us[])
{
    double sum = 0.0;
    for (long i = 0; i < n; i++) {
        sum += (double)cost_us[i] / (double)n;
    }
    return sum;
}

static void print(const long ticks, const int passes, struct told *const told[])
{
    float *const tick  = told[0]->cost_us;
    float *const other = tick + ticks;
    float *const least = malloc((size_t)ticks * sizeof *least);
    memcpy(least, tick, (size_t)ticks * sizeof *least);
    for (int p = 1; p < passes; p++) {
        for (long i = 0; i < ticks; i++) {
            least[i] = fminf(least[i], told[p]->cost_us[i]);
        }
    }
    qsort(tick, (size_t)ticks, sizeof *tick, ascending);
    qsort(other, (size_t)ticks, sizeof *other, ascending);
    qsort(least, (size_t)ticks, sizeof *least, ascending);
    (void)printf("tick %.2f %.1f %.1f %.1f %.1f %ld %lld %lld\n", mean(ticks, tick),
                 (double)tick[ticks - ticks / 100], (double)tick[ticks - ticks / 1000],
                 (double)tick[ticks - 1], (double)tick[ticks - 2], ticks, told[0]->digs,
                 told[0]->matches);
    (void)printf("still %.2f %.1f %.1f\n", mean(ticks, other), (double)other[ticks - 1],
                 (double)other[ticks - 2]);
    (void)printf("least %.1f %.1f %d\n", (double)least[ticks - 1], (double)least[ticks - 2],
                 passes);
    free(least);
}

int main(const int argc, char *argv[])
{
    const long ticks  = argc > 4 ? atol(argv[4]) : 1000000;
    const int  passes = argc > 5 ? atoi(argv[5]) : 3;
    if (argc < 4 || ticks < 1000 || passes < 1 || passes > PASSES_MAX) {
        (void)fprintf(stderr, "usage: daemon_tick TABLE MACHINE RECORDING [TICKS [PASSES]]\n");
        return 2;
    }
    struct told *told[PASSES_MAX];
    for (int p = 0; p < passes; p++) {
        told[p] = share(ticks);
        if (told[p] == NULL) {
            return 1;
        }
        const pid_t child = fork();
        if (child == 0) {
            _exit(pass(argv, ticks, told[p]));
        }
        int status = 1;
        if (child < 0 || waitpid(child, &status, 0) != child || status != 0) {
            return 1;
        }
    }
    print(ticks, passes, told);
    return 0;
}
