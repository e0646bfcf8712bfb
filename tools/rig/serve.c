#include "tools/rig/commands.h"

#include "tools/rig/bus/fault.h"
#include "tools/rig/buses.h"
#include "tools/rig/sensors.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

static const double tick_s = 1.0 / DIG_RIG_TICK_Hz;

static int64_t now_ns(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void sleep_until(const int64_t deadline_ns)
{
    const struct timespec deadline = {
        .tv_sec  = (time_t)(deadline_ns / 1000000000),
        .tv_nsec = (long)(deadline_ns % 1000000000),
    };
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, NULL) == EINTR) {
    }
}

// A pending request to end is taken between two ticks; no handler, no global.
static bool is_asked_to_end(const sigset_t *const signals)
{
    const struct timespec at_once = { 0, 0 };
    return sigtimedwait(signals, NULL, &at_once) > 0;
}

struct progress {
    bool    terminal;
    int64_t next_ns;
};

static void print_progress(struct progress *const progress, const double done_s,
                           const double total_s, const double speed)
{
    const int64_t now = now_ns();
    if (now < progress->next_ns) {
        return;
    }
    progress->next_ns = now + (progress->terminal ? 500000000 : 5000000000);
    (void)fprintf(stderr, "%sdigrig: %.1f s of %.1f s, %.0f s left%s",
                  progress->terminal ? "\r" : "", fmax(0.0, done_s), total_s,
                  fmax(0.0, (total_s - done_s) / speed), progress->terminal ? "   " : "\n");
}

static void print_counts(const char *const name, const uint64_t count[256])
{
    printf("\"%s\": {", name);
    const char *comma = "";
    for (int f = 0; f < 256; f++) {
        if (count[f] > 0) {
            printf("%s\"%d\": %llu", comma, f, (unsigned long long)count[f]);
            comma = ", ";
        }
    }
    printf("}");
}

static void report(const struct dig_rig_buses *const buses, const int64_t ticks,
                   const int64_t worst_ns, const bool json)
{
    const struct dig_rig_requests *const requests = &buses->requests;
    uint64_t                             served   = 0;
    uint64_t                             refused  = 0;
    for (int f = 0; f < 256; f++) {
        served += requests->served[f];
        refused += requests->refused[f];
    }
    (void)fprintf(stderr,
                  "digrig: %lld ticks, the latest %.2f ms late; CAN frames %llu sent, %llu lost; "
                  "Modbus requests %llu served, %llu refused, %llu unanswered\n",
                  (long long)ticks, 1e-6 * (double)worst_ns, (unsigned long long)buses->frames_sent,
                  (unsigned long long)buses->frames_lost, (unsigned long long)served,
                  (unsigned long long)refused, (unsigned long long)requests->unanswered);
    if (!json) {
        return;
    }
    printf("{\"ticks\": %lld, \"worst_late_ms\": %.3f, \"can_sent\": %llu, \"can_lost\": %llu, ",
           (long long)ticks, 1e-6 * (double)worst_ns, (unsigned long long)buses->frames_sent,
           (unsigned long long)buses->frames_lost);
    print_counts("modbus_served", requests->served);
    printf(", ");
    print_counts("modbus_refused", requests->refused);
    printf(", \"modbus_unanswered\": %llu, \"modbus_clients\": %llu, ",
           (unsigned long long)requests->unanswered, (unsigned long long)requests->clients);
    printf("\"modbus_excepted\": %llu, \"modbus_damaged\": %llu, ",
           (unsigned long long)requests->excepted, (unsigned long long)requests->damaged);
    printf("\"can_dropped\": %llu, \"can_doubled\": %llu, \"can_overtaken\": %llu, "
           "\"can_damaged\": %llu}\n",
           (unsigned long long)buses->wire.dropped, (unsigned long long)buses->wire.doubled,
           (unsigned long long)buses->wire.overtaken, (unsigned long long)buses->wire.damaged);
    (void)fflush(stdout);
}

struct player {
    const struct dig_machine     *machine;
    const struct dig_rig_options *options;
    const struct dig_rig_track   *track;
    struct dig_rig_noise          noise;
    struct dig_sample             last; // what was sent before, for a bus that freezes
};

// What the bus says at `tick` of the motion; before it (tick < 0) the machine stands at the start.
static void play(struct player *const player, struct dig_rig_buses *const buses, const int64_t tick)
{
    const struct dig_rig_options *const options = player->options;
    const int64_t                       rows    = (int64_t)player->track->rows;
    const int64_t                       row     = tick < 0 ? 0 : tick % rows;
    const double                        time_s  = (double)tick / DIG_RIG_TICK_Hz;
    const bool frozen = dig_rig_fault_amount(&options->faults, DIG_RIG_FAULT_FROZEN, time_s) > 0.0;
    if (!frozen) {
        const struct dig_sample before = player->last;
        player->last                   = dig_rig_sense(player->machine, &player->track->row[row],
                                                       llround(1e9 * time_s), options->noise ? &player->noise : NULL);
        dig_rig_fault_spoil(&options->faults, time_s, &player->last);
        dig_rig_fault_hold(&options->faults, time_s, &before, &player->last);
    }
    dig_rig_buses_send(buses, tick, &player->last, !frozen);
}

enum dig_status dig_rig_serve(const struct dig_machine *const     machine,
                              const struct dig_rig_options *const options,
                              const struct dig_rig_track *const   track,
                              struct dig_error *const             error)
{
    // Blocked before any thread starts, so that every thread inherits it.
    sigset_t signals;
    (void)sigemptyset(&signals);
    (void)sigaddset(&signals, SIGTERM);
    (void)sigaddset(&signals, SIGINT);
    (void)pthread_sigmask(SIG_BLOCK, &signals, NULL);

    struct dig_rig_buses  buses;
    const enum dig_status status = dig_rig_buses_open(options, &buses, error);
    if (status != DIG_OK) {
        return status;
    }
    struct player player = {
        .machine = machine,
        .options = options,
        .track   = track,
        .noise   = dig_rig_noise_init(options->seed),
    };
    struct progress progress = { .terminal = !options->quiet && isatty(STDERR_FILENO) == 1 };
    const int64_t   rows     = (int64_t)track->rows;
    const int64_t   first    = -llround(options->start_delay_s * options->speed / tick_s);
    const double    real_ns  = 1e9 * tick_s / options->speed;
    const int64_t   begin_ns = now_ns();
    int64_t         worst_ns = 0;
    int64_t         tick     = first;
    while (!is_asked_to_end(&signals) && (options->loop || tick < rows)) {
        const int64_t deadline_ns = begin_ns + llround((double)(tick - first) * real_ns);
        sleep_until(deadline_ns);
        const int64_t late_ns = now_ns() - deadline_ns;
        worst_ns              = late_ns > worst_ns ? late_ns : worst_ns;
        play(&player, &buses, tick);
        if (!options->quiet) {
            print_progress(&progress, (double)tick * tick_s, (double)rows * tick_s, options->speed);
        }
        tick++;
    }
    if (progress.terminal) {
        (void)fprintf(stderr, "\n");
    }
    dig_rig_buses_close(&buses);
    report(&buses, tick - first, worst_ns, options->json);
    return DIG_OK;
}
