#include "firmware_host/bus/input.h"

#include "core/units.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define FIRST_PAUSE   (DIG_NS_PER_S / 4)
#define LONGEST_PAUSE (5 * DIG_NS_PER_S)
#define SLICE         (DIG_NS_PER_S / 20)

int64_t dig_input_now_ns(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * DIG_NS_PER_S + t.tv_nsec;
}

void dig_input_pause(const struct dig_input *const input, const int64_t pause_ns)
{
    const int64_t end_ns = dig_input_now_ns() + pause_ns;
    while (!atomic_load(input->stop)) {
        const int64_t left_ns = end_ns - dig_input_now_ns();
        if (left_ns <= 0) {
            return;
        }
        const int64_t         slice_ns = left_ns < SLICE ? left_ns : SLICE;
        const struct timespec slice    = { .tv_nsec = (long)slice_ns };
        (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &slice, NULL);
    }
}

void dig_input_put(struct dig_input *const input, const struct dig_reading *const reading)
{
    if (!dig_ring_push(input->readings, reading)) {
        atomic_fetch_add(&input->overflow, 1);
    }
}

void dig_input_log(struct dig_input *const input, const struct dig_error *const error)
{
    struct dig_log_line note = { "" };
    if (error != NULL) {
        (void)snprintf(note.text, sizeof note.text, "%.199s", error->text);
    }
    dig_latest_put(input->log, &note);
}

// Reads an open source until it fails, ends, or all is to stop.
static void read_on(struct dig_input *const input, struct dig_error *const error)
{
    while (!atomic_load(input->stop) && !atomic_load(&input->ended)) {
        if (input->ops->read(input, error) != DIG_OK) {
            return;
        }
    }
}

void dig_input_run(struct dig_input *const input)
{
    assert(input != NULL && input->ops != NULL);
    int64_t pause_ns = FIRST_PAUSE;
    bool    before   = false;
    while (!atomic_load(input->stop) && !atomic_load(&input->ended)) {
        struct dig_error error = { "" };
        if (input->ops->open(input, &error) == DIG_OK) {
            if (before) {
                atomic_fetch_add(&input->reconnects, 1);
            }
            before = true;
            dig_input_log(input, NULL);
            const long long frames = atomic_load(&input->frames);
            atomic_store(&input->connected, true);
            read_on(input, &error);
            atomic_store(&input->connected, false);
            if (input->ops->close != NULL) {
                input->ops->close(input);
            }

            // A source that opens but never says a word is no better than one that does not open.
            if (atomic_load(&input->frames) > frames) {
                pause_ns = FIRST_PAUSE;
            }
        }
        if (error.text[0] != '\0') {
            dig_input_log(input, &error);
            dig_input_pause(input, pause_ns);
            pause_ns = 2 * pause_ns < LONGEST_PAUSE ? 2 * pause_ns : LONGEST_PAUSE;
        }
    }
}

void dig_input_destroy(struct dig_input *const input)
{
    if (input != NULL && input->ops != NULL) {
        if (input->ops->finish != NULL) {
            input->ops->finish(input);
        }
        free(input->source);
        input->ops = NULL;
    }
}
